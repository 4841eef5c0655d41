"""Tangential law of a contact over its nominal pressure: friction and the stiffnesses of its three descriptions."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.friction_table import FrictionLaw


@dataclass(frozen=True)
class TangentialLaw:
    """Friction and tangential stiffness at rising pressures, all arrays (p,) in SI.

    ``stiffness`` Pa/m at rest and ``exponent`` belong to the evolution rule, ``elastic_stiffness`` Pa/m to the elastic
    stick (Allgaier et al. 1999, section 4).
    """

    pressure: np.ndarray
    friction: np.ndarray
    stiffness: np.ndarray
    elastic_stiffness: np.ndarray
    exponent: np.ndarray

    def at(self, pressure):
        """The law at one or more pressures within its range (interpolated in logarithms); ConfigError beyond it."""
        wanted, known = np.atleast_1d(np.asarray(pressure, float)), self.pressure
        if not len(known):
            raise ConfigError("tangential law", "one in the model", "none", "give friction and stiffness as settings")
        outside = wanted[(wanted < known[0]) | (wanted > known[-1])]
        if len(outside):
            raise ConfigError("tangential law: pressure", f"{known[0]:.3g} to {known[-1]:.3g} Pa",
                              f"{outside[0]:.3g} Pa",
                              "change the load, the area of the contact, or the range of interface_law")
        read = [np.exp(np.interp(np.log(wanted), np.log(known), np.log(values))) for values in
                (self.friction, self.stiffness, self.elastic_stiffness, self.exponent)]
        return TangentialLaw(wanted, *read)

    def friction_law(self):
        """FrictionLaw over pressure alone, constant outside the range; ConfigError for a model without a law."""
        if not len(self.pressure):
            raise ConfigError("friction", "a coefficient in the settings, or a model with a tangential law", "neither",
                              "add it, such as friction: 0.3")
        return FrictionLaw(self.pressure, [0.0], [0.0], np.reshape(self.friction, (-1, 1, 1)))


def tangential_law(product):
    """TangentialLaw of a product with the fields shear_*, such as ReducedModel."""
    return TangentialLaw(product.shear_pressure, product.shear_friction, product.shear_stiffness,
                         product.shear_elastic_stiffness, product.shear_exponent)

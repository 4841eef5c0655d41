"""Friction laws times a factor along one axis, as tables: what effects of friction on speed or pressure have in common.

A table is read linearly, so a factor is as exact as its samples are close. Where the factor is 1 everywhere the law
stays as it is, so that no interpolation rounds what has not changed.
"""

from dataclasses import replace

import numpy as np

from pipeline.physics.friction.friction_table import FrictionLaw


def times(friction, axis, samples, factor):
    """The Friction with its law times ``factor(values)`` along ``axis``, sampled at ``samples`` and its own values."""
    law = friction.law
    coordinates = getattr(law, axis)
    values = np.union1d(coordinates, samples)
    grown = factor(values)
    if np.all(grown == 1):
        return friction
    axes = {name: getattr(law, name) for name in ("pressure", "speed", "distance")}
    axes[axis] = values
    grid = np.meshgrid(*axes.values(), indexing="ij")
    table = law.evaluate(*grid)[0]
    along = [1, 1, 1]
    along[list(axes).index(axis)] = -1
    return replace(friction, law=FrictionLaw(**axes, friction=table * grown.reshape(along)))

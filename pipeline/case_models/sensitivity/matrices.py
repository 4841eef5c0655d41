"""Matrices of a reduced brake about its steady sliding, as functions of its products and of what is varied in them."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.scatter import family
from pipeline.physics.modal.quadratic_eigenproblem import polished
from pipeline.physics.modal.root_derivatives import with_vectors
from pipeline.physics.stability.draws.scatter import Factors
from pipeline.physics.stability.draws.whole_roots import about_sliding


@dataclass(frozen=True)
class Case:
    """A product ReducedModel at one operating point, and what is varied beside it.

    ``state``: row of its preload; ``speed`` rad/s; ``load``: factor on the input force; ``factors``: as of a draw.
    """

    model: object
    state: int
    speed: float
    load: float = 1.0
    factors: Factors = Factors()


def varied(case, friction_map, points, friction=None):
    """Family of a Case; ``points``: settings of its stability as of ``stability_settings``; ``friction``: a law of
    pressure and speed in place of that of the map or the settings."""
    made = family(case.model, case.state, friction_map, points)
    if friction is not None:
        made = replace(made, friction=friction)
    made = replace(made, input_force=case.load * made.input_force)
    return made.at_speed(case.speed).varied(case.factors)


def matrices(case, friction_map, points):
    """(M, C, K) each (n, n) of a Case about its own steady sliding, loss factors as imaginary stiffness."""
    made = varied(case, friction_map, points)
    return matrices_about(made, *about_sliding(made)[:2])


def matrices_about(made, about, friction):
    """(M, C, K) of a Family ``made`` whose model is linearised ``about`` a sliding state with a FrictionState."""
    mass, damping, stiffness = about.linearised(friction, made.friction_damping, made.gyroscopic, made.centrifugal)
    return mass, damping, stiffness + 1j * made.imaginary_stiffness()


def mean_friction(case, friction_map, points):
    """Friction coefficient of a Case, mean over the contacts weighted by their force."""
    about, friction, _ = about_sliding(varied(case, friction_map, points))
    force = about.contacts.preload
    return float(force @ np.broadcast_to(friction.coefficient, force.shape) / force.sum())


def polished_root(given, root):
    """RootWithVectors of the matrices ``given`` nearest a ``root``, which is near one of theirs."""
    mass, damping, stiffness = given
    start = np.linalg.solve(root**2 * mass + root * damping + stiffness, np.ones(len(mass)))
    return with_vectors(given, *polished(*given, root, start))

"""Derivatives of the growing modes of a brake to its declared values, and the scatter of these values."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.case_models.sensitivity.root_changes import followed_roots

#: values are changed by this many references to either side
STEP = 1e-3
#: values without a derivative -> why
LEFT_OUT = {
    "structure.*.{radii, thicknesses, angles}": "they move the mesh: name them in sensitivities.differences",
    "structure.pad.lining_{young, shear}_*": "one factor on all moduli of the linings, structure.pad.lining_young,"
                                             " stands for them; name one in sensitivities.differences",
    "structure.*.poisson": "the matrices of the reduced model do not follow it: name it in sensitivities.differences",
    "surface.*, micro_friction.*": "they act through friction and contact stiffness, whose derivatives are given",
    "structure.bracket.kind, structure.piston.kind": "a choice has no derivative"}


@dataclass(frozen=True)
class Derivatives:
    """Of r roots of a case to p values: ``parameters`` (p,), without what changes them, ``roots`` (r,) 1/s with their
    ``shapes`` (n, r), ``changes`` (reach, r, p) complex 1/s per reference of the value."""

    parameters: tuple
    roots: np.ndarray
    shapes: np.ndarray
    changes: np.ndarray


def derivatives(case, roots, structure, friction, friction_map, points):
    """Derivatives of ``roots`` (r,) 1/s, each near one of a Case; the rest as of ``parameters``."""
    followed = followed_roots(case, roots, friction_map, points)
    values = tuple(parameters(case, structure, friction, points))
    changes = np.array([_changes(followed, value, friction_map, points) for value in values])
    shapes = np.array([mode.right for mode in followed.modes]).T
    return Derivatives(tuple(replace(value, changed=None) for value in values),
                       np.array([mode.root for mode in followed.modes]), shapes, changes.transpose(1, 2, 0))


def _changes(followed, value, friction_map, points):
    """(reach, r) change of each root per reference of a Parameter, by central differences of the system."""
    ends = [value.changed(followed.case, side * STEP) for side in (-1, 1)]
    return followed.changes(ends, friction_map, points) / (2 * STEP)


def scatter_of(value, probability):
    """(source, standard deviation) of a Parameter, in its unit, as a product Probability declares it; ('', None) where
    it does not."""
    kind, _, part = value.source.partition(":")
    for name, width in () if probability is None else zip(probability.source, probability.scatter, strict=True):
        declared, _, members = str(name).partition(":")
        if declared == kind and (not members or (part and (members in part or part in members))):
            return str(name), float(width) * (1.0 if kind.startswith("friction") else abs(value.value))
    return "", None

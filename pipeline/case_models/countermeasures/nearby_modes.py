"""Modes of a reduced brake near given roots, stable ones too, about steady sliding at one operating point.

The system is that of ``complex_modes`` at its operating points, the whole reduced model with loss factors as imaginary
stiffness, so that its unstable roots are those of that product.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.matrices.sliding_terms import sliding_at
from pipeline.physics.modal.nearest_modes import modes_near

#: modes sought about each target, and shift of the target beside a root, as a share of it
NEAREST, _BESIDE = 24, 1 + 1e-4
#: roots closer than this share of their size are one root
_SAME = 1e-6


@dataclass(frozen=True)
class Brake:
    """Products of a case, or of a variant of it: ComplexModes, ReducedModel, FrictionMap, Effects or None."""

    modes: object
    model: object
    friction_map: object
    effects: object = None


def points_of(model):
    """(positions (v, 3), name of the body (v,), recovery (v, 3, n)) of the points at which modes of a product
    ReducedModel are compared: its surface nodes or, without any, one for each coordinate, weighted by its mass."""
    names = np.array(list(map(str, model.body_name)))
    if len(model.visible_position):
        return model.visible_position, names[np.asarray(model.visible_body, int)], model.recovery
    size, recovery = len(model.mass), np.zeros((len(model.mass), 3, len(model.mass)))
    recovery[np.arange(size), 0, np.arange(size)] = np.sqrt(np.diag(model.mass))
    return np.outer(np.arange(size), (1.0, 0.0, 0.0)), names[np.asarray(model.coordinate_body, int)], recovery


def shapes_of(brake, operating, modes):
    """(u, v, 3) shapes of unstable ``modes`` (u,) of a Brake at an operating point, on its points."""
    if len(brake.model.visible_position) or not len(modes):
        return np.reshape(brake.modes.unstable_shape[modes], (len(modes), len(points_of(brake.model)[0]), 3))
    wanted = brake.modes.unstable_reduced[modes]
    roots, shapes = modes_about(brake, operating, wanted)
    return shapes[abs(roots - wanted[:, None]).argmin(axis=1)]


def system_of(brake, operating):
    """((M, C, K) each (n, n), Settling or None) of a Brake about steady sliding at an operating point, an index."""
    state = sliding_at(brake.modes, brake.model, brake.friction_map, brake.effects, operating)
    (mass, damping, stiffness), more = state.linearised, state.hysteretic
    if more is not None:
        damping, stiffness = damping + more[0], stiffness + more[1]
    return (mass, damping, stiffness), state.beside


def among(root, roots, within=_SAME):
    """Whether one of ``roots`` (r,) lies within this share of the size of a ``root`` from it."""
    return bool((abs(roots - root) <= within * abs(root)).any())


def modes_about(brake, operating, targets):
    """(roots (h,) 1/s, shapes (h, v, 3) on the surface) of the modes of a Brake near any of the ``targets`` (t,)."""
    matrices, beside = system_of(brake, operating)
    recovery = points_of(brake.model)[2]
    roots, shapes = np.empty(0, complex), []
    for target in targets:
        if among(target, roots):
            continue
        near, vectors = modes_near(*matrices, target * _BESIDE, NEAREST, beside)
        for root, vector in zip(near, vectors.T, strict=True):
            if root.imag > 0 and not among(root, roots):
                roots = np.append(roots, root)
                shapes.append(recovery @ vector[:recovery.shape[2]].astype(np.complex64))
    return roots, np.reshape(shapes, (len(roots), *recovery.shape[:2]))

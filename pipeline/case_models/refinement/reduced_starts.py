"""Modes of a reduced model that grow or nearly do, from which those of finer models are sought."""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.steady_sliding import mapped_friction, posed
from pipeline.contract import ConvergenceError
from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.modal.quadratic_eigenproblem import DenseFactors, polished
from pipeline.physics.sliding.model import at_state
from pipeline.physics.stability.growth_balance import Losses

#: modes that decay by no more than this, in 1/s and as a share of their angular frequency, may grow in a finer model
NEARLY, NEARLY_SHARE = 50.0, 2.5e-3
#: margin of the roots that are looked at, whose losses are viscous; inverse iterations for the shape of each, and roots
#: that are sought about one which these do not lead to
_MARGIN, _INVERSE, _ABOUT = 1.25, 3, 4
#: the target of a search lies beside the root that it is about
_BESIDE = 1 + 1e-5
#: relative error of a root
_ROOT = 1e-9
#: roots closer than this share of their size are one
_SAME = 1e-6


@dataclass(frozen=True)
class Starts:
    """Modes at one operating point: ``root`` (g,) 1/s by frequency, ``motion`` (3, c, g) of the contacts normal, along
    and across sliding; these contacts lie at ``position`` (c, 3) m on the bodies ``body`` (c,), with ``closure`` (c,)
    m; ``law``: closures (k,) m and pressures (k,) Pa; ``friction``: function of pressure and speed."""

    root: np.ndarray
    motion: np.ndarray
    position: np.ndarray
    body: np.ndarray
    closure: np.ndarray
    law: tuple
    friction: object


def reduced_starts(model, friction_map, spectrum, state, speed, settings):
    """Starts in a product ReducedModel without effects, at a row ``state`` of its preload table and a ``speed``, rad/s.

    ``spectrum`` (r,) 1/s: all its roots there, about; ``settings``: the section ``complex_modes``. Loss factors are
    hysteretic.
    """
    case, (friction, plain) = (posed(model, state, speed, settings.damping_speed),
                               mapped_friction(friction_map, settings.sliding_distance))
    load = model.pressure[state] * model.input_area
    steady = case.slide(case.response(settings.centrifugal), load, friction, plain, settings)
    about = steady.about(case.bench.model)
    matrices = list(about.linearised(steady.acting(settings.friction_slopes), settings.friction_damping,
                                     settings.gyroscopic, settings.centrifugal))
    change = Losses.of(at_state(model, state)).change(case.base.model)
    if change is not None:
        matrices[1:] = (matrix + more for matrix, more in zip(matrices[1:], change, strict=True))
    root, shape = _near(matrices, spectrum, 2 * np.pi * settings.frequency_max)
    motion = [rows @ shape for rows in (model.contact_normal, model.contact_tangent, model.contact_lateral)]
    return Starts(root, np.array(motion), model.contact_position, model.contact_body, steady.contact.closure,
                  (model.law_closure, model.law_pressure), plain)


def nearly_growing(roots, margin=1.0):
    """True where a root (1/s) grows, or may do so in a finer model."""
    least = np.minimum(NEARLY, NEARLY_SHARE * abs(roots))
    return (roots.imag > 0) & (roots.real > -margin * least)


def _near(matrices, spectrum, limit):
    """(roots (g,), shapes (n, g)) that nearly grow, of those about each root of the ``spectrum`` that may."""
    root, shape = np.empty(0, complex), np.empty((len(matrices[0]), 0), complex)
    for target in spectrum[nearly_growing(spectrum, _MARGIN) & (abs(spectrum) < limit)]:
        found, vectors = _about(matrices, target, root)
        new = nearly_growing(found) & (abs(found) < limit) & ~_known(found, root)
        root, shape = np.append(root, found[new]), np.column_stack((shape, vectors[:, new]))
    order = np.argsort(root.imag, kind="stable")
    return root[order], shape[:, order]


def _about(matrices, target, known):
    """(roots, shapes) near a ``target``: that nearest to it or, if it is ``known`` or not to be had, several."""
    mass, damping, stiffness = matrices
    factors, vector = DenseFactors(np.complex64), np.random.default_rng(1).standard_normal(len(mass)).astype(complex)
    factors.renew((_BESIDE * target) ** 2 * mass + _BESIDE * target * damping + stiffness)
    for _ in range(_INVERSE):
        vector = factors.solve(vector)
        vector = vector / np.linalg.norm(vector)
    try:
        root, vector = polished(*matrices, target, vector, factors=factors, accuracy=_ROOT)
        if not _known(np.array([root]), known).any():
            return np.array([root]), vector[:, None]
    except ConvergenceError:
        pass
    return modes_near(*matrices, _BESIDE * target, _ABOUT)


def _known(roots, known):
    """True (r,) for ``roots`` (r,) among those ``known`` (k,)."""
    return (abs(roots[:, None] - known) <= _SAME * abs(roots[:, None])).any(axis=1)

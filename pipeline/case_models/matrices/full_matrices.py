"""Modes of a case that grow, or nearly do, on the finite-element matrices behind its reduced model."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from pipeline.contract import ConvergenceError
from pipeline.physics.numerics.sparse_solver import Successive
from pipeline.physics.sliding.shared_operator import SharedOperator, SlidingPoint
from pipeline.physics.sliding.unreduced_equilibrium import Solutions
from pipeline.physics.stability.constrained_modes import is_hard
from pipeline.physics.stability.full_roots import Guess, families, full_roots

#: tasks of the fan-out at most, each of several families
_PARTS = 8
#: roots of one operating point that differ by less than this share are the same
_SAME = 1e-6


@dataclass(frozen=True)
class Mode:
    """A root (1/s) of the reduced model at one operating point and its pressure, by numbers, and its motion (n,)."""

    operating: int
    state: int
    root: complex
    motion: np.ndarray


@dataclass(frozen=True)
class FullMode:
    """The root (1/s) on the full matrices, its residual, terms of its growth rate, parts (c,) of the contacts in it
    and shares (b,) of the bodies."""

    root: complex
    residual: float
    terms: dict
    contacts: np.ndarray
    shares: np.ndarray


def has_full_matrices(structure, posed, settings, context):
    """Whether a product Structure, or None, has all that the reduced model of a case has; what it lacks is told.

    ``posed``: a Posed of the case; ``settings``: the section ``complex_modes``.
    """
    if structure is None or settings.residual_tolerance is None or is_hard(posed.base.model):
        return False
    lacking = lacking_terms(structure, posed, settings)
    if lacking:
        context.remark(f"the full finite-element matrices are without {' and '.join(lacking)}: unstable roots are those"
                       " of the reduced model")
    return not lacking


def lacking_terms(structure, posed, settings):
    """[what] the full matrices of a product Structure lack of the reduced model of a case; arguments as of
    ``has_full_matrices``."""
    bodies = [structure.body(str(name)) for name in structure.body_name]
    loses = any(part.any() for part in (structure.joint_loss_factor, structure.fluid_loss_factor,
                                        *(body.loss_factor for body in bodies)))
    reasons = {"effects of the case": bool(posed.terms),
               "damping ratios of bodies": any(body.damping_ratio > 0 for body in bodies),
               "linings that stiffen with pressure": bool(getattr(structure, "lining_exponent", 0)),
               "viscous equivalents of loss factors": loses and not settings.hysteretic}
    return [reason for reason, holds in reasons.items() if holds]


def slid_on_elements(full_model, solver, law, settings, states):
    """[(sparse SlidingModel of the finite elements, their Steady)] of ``states``, each (Posed, ClosureResponse, input
    force (i,) N) of the reduced model.

    ``full_model()``: that model in any state; ``law``, ``settings``: as of ``Posed.slide``.
    """
    full, solve = full_model(), Solutions(solver)
    return [case.slide_on_elements(full, case.slide(response, load, *law, settings), load, law[1], settings, solve)
            for case, response, load in states]


def full_modes(about, models, modes, describe, settings, context):
    """A FullMode for each Mode that oscillates, None for others.

    ``about``: the sparse SlidingModel of the finite elements and its Steady at each operating point, ``models``: the
    reduced SlidingModel about steady sliding there; ``describe(model, sliding, roots, vectors)``: (terms, contacts,
    shares) of each root, as ``balances``.
    """
    solved = [None] * len(modes)
    oscillating = np.array([k for k, mode in enumerate(modes) if mode.root.imag > 0], int)
    if not len(oscillating):
        return solved
    groups = families(*(np.array([getattr(modes[k], name) for k in oscillating]) for name in ("root", "state")))
    tasks = [[(*about[m.operating], m.root,
               np.concatenate([rows @ m.motion for rows in _rows(models[m.operating])]))
              for m in (modes[k] for k in oscillating[group])] for group in groups]
    parts = [slice(k, None, _PARTS) for k in range(min(_PARTS, len(tasks)))]
    results = context.map(partial(_families, describe, settings, context.solver), [tasks[part] for part in parts],
                          "full finite-element matrices")
    for part, families_of in zip(parts, results, strict=True):
        for group, found in zip(groups[part], families_of, strict=True):
            for k, mode in zip(oscillating[group], found, strict=True):
                solved[k] = mode
    _refuse_same(modes, solved)
    return solved


def _rows(model):
    """Rows of the contacts of a SlidingModel in all three directions."""
    return model.contacts.normal, model.contacts.tangent, model.contacts.lateral


def _refuse_same(modes, solved):
    """ConvergenceError where two modes of one operating point led to the same root of the full matrices."""
    operating = np.array([mode.operating for mode, s in zip(modes, solved, strict=True) if s is not None])
    every_root = np.array([s.root for s in solved if s is not None])
    for number in np.unique(operating):
        roots = every_root[operating == number]
        apart = abs(roots[:, None] - roots) + np.diag(np.full(len(roots), np.inf))
        if (apart < _SAME * abs(roots)).any():
            raise ConvergenceError("complex modes: full finite-element matrices", "a root for each mode",
                                   f"one near {roots[apart.min(axis=0).argmin()]:.6g} 1/s for two of them",
                                   "set complex_modes.residual_tolerance: null")


def _families(describe, settings, solver, tasks):
    """[A FullMode for each operating point] of some families of roots of one brake."""
    operator = SharedOperator.of(tasks[0][0][0], settings.gyroscopic, settings.centrifugal)
    find = partial(_family, describe, settings, operator, Successive(solver))
    return [find(task) for task in tasks]


def _family(describe, settings, operator, factors, task):
    """A FullMode for each operating point of a family of roots."""
    guesses = [Guess(root, motion, SlidingPoint.of(model, sliding.acting(settings.friction_slopes),
                                                   settings.friction_damping)) for model, sliding, root, motion in task]
    solved, found = full_roots(guesses, operator, factors, settings.residual_tolerance), []
    for (model, sliding, *_), mode in zip(task, solved, strict=True):
        (terms,), (contacts,), (shares,) = describe(model, sliding, np.array([mode.root]), mode.vector[:, None])
        found.append(FullMode(mode.root, mode.residual, terms, contacts, shares))
    return found

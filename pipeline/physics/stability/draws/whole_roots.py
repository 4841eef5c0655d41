"""Growing roots of one draw of a Family in the whole reduced model, without the bases that its many draws share."""

from dataclasses import replace

import numpy as np

from pipeline.physics.modal.quadratic_eigenproblem import polished, quadratic_modes
from pipeline.physics.sliding.equilibrium import closure_response, given_state, model_about, steady_sliding
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.structural_damping import equivalent_damping
from pipeline.physics.stability.draws.draw_system import about
from pipeline.physics.stability.draws.sampled_sliding import whole_sliding
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.physics.stability.linearisation import maxwell_branches, with_slopes
from pipeline.physics.stability.refinement import moved_roots
from pipeline.physics.system.forms import Block, spread
from pipeline.physics.system.terms import Kind, Owner, Term, What

#: growth rates above this negative share of the frequency are solved for in the whole model
_NEARLY = 5e-4
#: growth rate in 1/s above which a root that only one of basis and whole model has counts as missed
_MISSED = 10.0


def whole_roots(family, factors, speed, below, smallest=1e-3):
    """Roots (r,) 1/s of a draw at ``speed`` rad/s, those that grow or nearly do, by falling growth rate.

    Its steady sliding, a basis of its own for a first estimate (corrections down to ``smallest``), then the roots with
    loss factors as imaginary stiffness. ``below`` Hz limits the modes. Errors as of these steps.
    """
    varied = family.at_speed(speed).varied(family.filled(factors))
    model, friction, beside = about_sliding(varied)
    loss = varied.imaginary_stiffness()
    mass, _, stiffness = model.frictionless(gyroscopic=False, centrifugal=False)
    viscous = replace(model, damping=model.damping + equivalent_damping(loss, stiffness, mass))
    branches, springs, _ = maxwell_branches(model)
    others = spread(branches, springs, branches) if len(springs) else None
    basis = friction_basis(viscous, below, varied.friction_damping, smallest, centrifugal=varied.centrifugal,
                           others=others).shape
    modes = quadratic_modes(*viscous.projected(basis).linearised(
        friction, varied.friction_damping, varied.gyroscopic, varied.centrifugal),
        beside=beside and beside.projected(basis.T, basis))
    matrices = system_about(varied, model, friction, beside).matrices()
    near = (modes.value.imag > abs(modes.value.real)) & (modes.value.real > -_NEARLY * abs(modes.value))
    near &= abs(modes.value) < 2 * np.pi * below
    root = np.array([polished(*matrices, s, basis @ x, beside)[0]
                     for s, x in zip(modes.value[near], modes.right[:, near].T, strict=True)])
    return root[np.argsort(-root.real, kind="stable")]


def beside_whole(case, factors, speed, below):
    """(roots (u,) of a Sampled, the same in the whole model, number that only one has) of the unstable modes of a draw.

    ``below`` Hz limits the modes; those within 1 % of it may lie on either side.
    """
    whole = whole_roots(case.family, factors, speed, below)
    unstable = whole[whole.real > 0]
    moved = moved_roots(unstable, case.roots(factors, speed), _MISSED)
    there = np.isfinite(moved.root)
    edge = abs(moved.added) < 2 * np.pi * below * 0.99
    return moved.root[there], unstable[there], np.sum(~there & (unstable.real > _MISSED)) + edge.sum()


def accuracy(compared):
    """{checked_root, whole_root (u,) 1/s, checked_draws, missed} of all draws, of each what ``beside_whole`` told."""
    roots, same = (np.concatenate([np.empty(0, complex), *(each[k] for each in compared)]) for k in range(2))
    return {"checked_root": roots, "whole_root": same, "checked_draws": len(compared),
            "missed": sum(int(missed) for *_, missed in compared)}


def about_sliding(varied):
    """(SlidingModel about steady sliding, FrictionState of its linearisation, what settles beside it or None)."""
    if varied.added is None:
        sliding = sliding_state(varied)
        return (model_about(varied.model, sliding.contact, varied.damping_speed),
                linearising(varied, sliding.friction), None)
    contact = whole_sliding(varied).slide(NOMINAL, varied.model.speed)
    model, friction, beside = about(varied, varied.model, NOMINAL, contact)
    return with_slopes(model, contact.slopes), friction, beside


def system_about(varied, model, friction, beside):
    """System of a Family whose ``model`` is linearised about a sliding state; arguments as of ``about_sliding``."""
    system = model.system(friction, varied.friction_damping, varied.gyroscopic, varied.centrifugal)
    loss = Term.sliding(What.HYSTERETIC_LOSS, Kind.LOSS, Block(varied.imaginary_stiffness()), Owner.BODY)
    return replace(system.and_([loss]), beside=beside)


def sliding_state(varied):
    """SlidingState of a Family in its whole model."""
    if not varied.has_law:
        return given_state(varied.model, varied.friction)
    response = closure_response(varied.model, varied.centrifugal)
    return steady_sliding(varied.model, response, varied.input_force, varied.law_closure, varied.law_pressure,
                          varied.friction)


def linearising(varied, friction):
    """FrictionState that a Family is linearised with, in a sliding state with ``friction``."""
    return friction if varied.friction_slopes else FrictionState(friction.coefficient)

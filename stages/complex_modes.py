"""Complex modes of the sliding system over friction, and at its operating points.

Friction redistributes the contact forces, so the system is linearised about steady sliding with that friction. The
friction coefficient comes from the friction map or, in chains without one, from the settings or the tangential law of
the model. Contacts without a normal law keep the status of the preload; if they have no stiffness either, they are
rigid and remain closed.
An eigenvalue s = sigma + i omega with sigma > 0 is a squeal candidate: the mode is unstable, but its final amplitude is
unknown.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.friction_paths import over_friction
from pipeline.case_models.matrices.full_matrices import has_full_matrices, slid_on_elements
from pipeline.case_models.operating_modes import balances, growing, in_full, path_fields_of, unstable_fields
from pipeline.case_models.operating_points import DECAY_SPEED
from pipeline.case_models.steady_sliding import (
    Posed,
    Steady,
    branch_stiffness,
    posed,
    refuse_twice,
    sliding_friction,
)
from pipeline.case_models.unstable_roots import in_whole_model, nearly
from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage, stored
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.quadratic_eigenproblem import (
    by_frequency,
    follow_roots,
    quadratic_roots,
    upper_half,
    vectors_of,
)
from pipeline.physics.sliding.equilibrium import ClosureResponse
from pipeline.physics.sliding.model import SlidingModel, at_state
from pipeline.physics.stability.constrained_modes import allowed_motions, hard_sliding, is_hard
from pipeline.physics.stability.friction_basis import FrictionBasis, friction_basis
from pipeline.physics.stability.growth_balance import Losses
from pipeline.products import ComplexModes, Effects, FrictionMap, ReducedModel, Structure
from pipeline.systems.fem_bodies import full_model

#: friction values of one task of the fan-out
_CHUNK = 7


class Settings(Section):
    """Friction sweep, operating points and the terms of the linearised system."""

    speeds: Quantities("rad/s") = option(
        ("8.5 rad/s", "10.25 rad/s", "12 rad/s"),
        "speeds of the drive at the operating points, a belt being a drum of radius 1 m; the sweep runs at their mean")
    friction: float | None = option(
        None, "coefficient of friction at high slip speed, where the chain has no friction map; none = that of the"
        " model", ge=0)
    friction_at_rest: float | None = option(None, "coefficient as the slip speed goes to zero; none = the same", ge=0)
    decay_speed: Quantity("m/s", gt=0) = option(
        DECAY_SPEED, "slip speed over which friction falls from one to the other")
    friction_max: float = option(0.8, "last friction coefficient of the sweep, which starts at 0", gt=0)
    friction_steps: int = option(41, "points of the sweep, both ends included", ge=2)
    frequency_max: Quantity("Hz", gt=0) = option("20 kHz", "real modes below it span the motion; under hard contacts"
                                                 " all do")
    smallest_correction: float = option(
        1e-4, "corrections for friction and damping below this share of the modal amplitude are left out", ge=0)
    sliding_distance: Quantity("m", ge=0) = option("10 mm", "sliding distance at which the friction map is read")
    friction_slopes: bool = option(True, "friction that changes with pressure and slip speed, at the operating points")
    friction_damping: bool = option(True, "friction that turns with the slip velocity damps sideways motion")
    damping_speed: Quantity("m/s", gt=0) = option(
        "1 m/s", "closing speed that doubles the contact pressure: damping of the normal contact, as in multibody")
    hysteretic: bool = option(
        True, "loss factors as imaginary stiffness, in roots that grow or nearly do at the operating points; false: the"
        " viscous damping equivalent to them, as in the sweep and in motions over time")
    gyroscopic: bool = option(True, "gyroscopic terms of the disc")
    centrifugal: bool = option(True, "centrifugal terms of the disc")
    residual_tolerance: float | None = option(
        1e-6, "largest residual of a mode, over its stiffness forces, on the full finite-element matrices of a brake,"
        " where roots that grow or nearly do are solved for; none = in the reduced model alone", gt=0)
    followed: int = option(
        12, "unstable modes, strongest first and each frequency once, that are followed from the friction of their"
        " operating point down to none", ge=0)
    squeal_from: Quantity("Hz", ge=0) = option(
        "1 kHz", "unstable modes from it on are squeal, lower ones groan or moan (SAE J2521: squeal is above 900 Hz)")
    neutral: float = option(1e-6, "growth below this share of abs(s) counts as neither growth nor decay", ge=0)


def _check(sections):
    """Refuse friction that is given twice or not at all, and speeds of both signs, before anything is computed."""
    settings = sections["complex_modes"]
    given = settings.friction is not None
    if settings.friction_at_rest is not None and not given:
        raise ConfigError("complex_modes.friction_at_rest", "friction beside it, or neither", "none",
                          "for friction that falls from that of a map or law, state effects.falling_friction")
    if min(settings.speeds) < 0 < max(settings.speeds):
        raise ConfigError("complex_modes.speeds", "speeds of one sign, at whose mean the sweep runs",
                          f"{min(settings.speeds):g} to {max(settings.speeds):g} rad/s", "make a case of each"
                          " direction")
    if "structure" in sections:
        _refuse_above_bases(settings.frequency_max, {
            "structure.frequency_max": sections["structure"].frequency_max,
            "reduced_model.fixed_below": sections["reduced_model"].fixed_below})
    mapped = "friction_map" in sections
    if given and mapped or not (given or mapped or "interface_law" in sections):
        raise ConfigError("complex_modes.friction", "friction from one source",
                          "a friction map in the chain as well" if given else "neither this nor a friction map or law",
                          "leave it out" if given else "add it, such as friction: 0.4")


def _refuse_above_bases(sought, limits):
    """ConfigError for modes ``sought`` up to a frequency that the bases of the bodies do not reach."""
    for name, reached in limits.items():
        if reached < sought:
            raise ConfigError("complex_modes.frequency_max", f"at most {reached:g} Hz, where {name} ends the modes of"
                              " the bodies", f"{sought:g} Hz", f"raise {name}, to half as high again as is sought")


@dataclass(frozen=True)
class _State:
    """One pressure: the model without friction, at the speed of the sweep, projected on its basis unless it is hard.

    ``still``: how it stands without friction; ``posed``: what its sliding states are found with.
    """

    model: SlidingModel
    response: ClosureResponse | None
    input_force: np.ndarray
    basis: FrictionBasis
    still: Steady
    posed: Posed


@dataclass(frozen=True)
class _Outcome:
    """One operating point: its sliding state, its roots, and the motion (n, g) of those that grow or nearly do."""

    speed: float
    sliding: Steady
    basis: FrictionBasis
    root: np.ndarray
    near: np.ndarray        # (g,) roots that grow or nearly do
    motion: np.ndarray
    terms: tuple            # of these: {term: part of the growth rate}
    contacts: np.ndarray    # (g, c) parts of the contacts in it
    shares: np.ndarray      # (g, b) of the bodies in their kinetic energy
    reduced: np.ndarray     # (g,) the same roots in the reduced model
    residual: np.ndarray    # (g,) on the full finite-element matrices, -1 without these

    @property
    def mean_friction(self):
        """Friction coefficient, mean over the contacts weighted by their force; 0 where nothing presses."""
        force, coefficient = self.sliding.contact.force, self.sliding.friction.coefficient
        return float(force @ coefficient / force.sum()) if force.any() else 0.0


@stage(check=_check)
def complex_modes(model: ReducedModel, friction_map: FrictionMap | None, effects: Effects | None,
                  structure: Structure | None, settings: Settings, context: Context) -> ComplexModes:
    """Compute complex modes over friction and at the operating points.

    Effects of the case are linearised about the sliding state; in the friction sweep they add to each coefficient.

    Method:
    All complex modes were computed at {friction_steps} friction coefficients from 0 to {friction_max} and at the
    operating points, each about its own steady sliding state, for each pressure in a basis of the real modes below
    {frequency_max} and their corrections for friction and what it changes in the contacts; at the operating points,
    roots that grow or nearly do were then solved for in the whole reduced model, with loss factors as imaginary
    stiffness (hysteretic: {hysteretic}), and then in the full finite-element matrices, about the steady sliding of the
    elements themselves, where a brake has these (largest residual: {residual_tolerance}). A closing speed of
    {damping_speed} doubles the contact pressure (contact damping). A mode is unstable if its growth rate exceeds
    {neutral} times its angular frequency. Up to {followed} unstable modes were followed in the reduced model from the
    friction of their operating point down to none, at its contact forces, by the modal assurance criterion.
    """
    terms, loads = _told(physics_terms(effects), context), model.pressure[:, None] * model.input_area
    models = [(posed(model, k, np.mean(settings.speeds), settings.damping_speed, terms, conditions(effects)), load)
              for k, load in enumerate(loads)]
    refuse_twice(models[0][0].bench, settings.friction_damping)
    states = context.map(partial(_state, settings), models, "real modes")
    friction = np.linspace(0.0, settings.friction_max, settings.friction_steps)
    law, number = sliding_friction(friction_map, model, settings), len(settings.speeds)
    full = has_full_matrices(structure, models[0][0], settings, context)
    slide = partial(slid_on_elements, partial(full_model, structure, context.solver), context.solver, law, settings)
    points = [m.at_speed(speed) for m, _ in models for speed in settings.speeds]
    losses = [Losses.of(at_state(model, k // number)) for k in range(len(points))]
    tasks = [(case, states[k // number], lost) for k, (case, lost) in enumerate(zip(points, losses, strict=True))]
    about, roots, outcomes = _solved(states, tasks, friction, slide if full else None, law, settings, context)
    if full:
        outcomes = in_full(about, points, outcomes, model.contact_body, settings, context)
    outcomes = [growing(o, settings) for o in outcomes]
    branches = min(max(len(s.basis.frequency) for s in states), *(s.model.size for s in states))
    return ComplexModes(
        settings=stored(settings), squeal_from=settings.squeal_from,
        pressure=model.pressure, friction=friction, root=[r[:, :branches] for r in roots],
        real_frequency=[_lowest_frequencies(s, branches, settings.centrifugal) for s in states],
        operating_pressure=np.repeat(model.pressure, len(settings.speeds)),
        operating_speed=[o.speed for o in outcomes], operating_friction=[o.mean_friction for o in outcomes],
        operating_force=[o.sliding.contact.force for o in outcomes],
        operating_open=[np.sum(o.sliding.contact.force == 0) for o in outcomes],
        operating_root=[_lowest(o.root, branches) for o in outcomes],
        **unstable_fields(outcomes, model, models[0][0].bench.model.body_name),
        **path_fields_of(partial(_over, settings), tasks, outcomes, model, settings, context),
        corrections=max(each.basis.corrections for each in [*states, *outcomes]))


def _told(terms, context):
    """The terms, those told that leave complex modes alone."""
    for term in terms:
        if not term.effect.small:
            context.log(f"{term.effect.name} at {term.location} does not enter linearised models: complex modes"
                        " unchanged")
    return terms


def _state(settings, task):
    """The model about its state without friction, on a basis that serves all states of the sweep and those of the
    operating points: that of half the friction of the sweep, with what its ends change in the contacts."""
    case, input_force = task
    response, seeking, model = case.response(settings.centrifugal), case.seeking, case.bench.model
    still, middle, last = (seeking.slide(response, input_force, constant(mu), mu, settings)
                           for mu in (0.0, settings.friction_max / 2, settings.friction_max))
    basis = _basis(middle.about(model), settings, [end.contact.stiffness - middle.contact.stiffness
                                                   for end in (still, last)])
    bare = replace(model, contacts=still.about(model).contacts)
    bare = bare if is_hard(bare) else bare.projected(basis.shape)
    return _State(bare, response, input_force, basis, still, seeking if case.moved else case.within(bare))


def _basis(model, settings, changes):
    if is_hard(model):
        shape = allowed_motions(model)
        frequency = _frequencies(np.diag(hard_sliding(model, 0.0, shape, friction_damping=False).stiffness))
        return FrictionBasis(shape, frequency[frequency < settings.frequency_max], 0)
    return friction_basis(model, settings.frequency_max, settings.friction_damping, settings.smallest_correction,
                          changes, settings.centrifugal, branch_stiffness(model), adjoint=1.0)


def _solved(states, tasks, friction, slide, law, settings, context):
    """(The answer of ``slide`` to all operating points, None without it; roots (friction, n) of every state, followed
    over friction from the lowest without friction upwards; an _Outcome of each operating point), all side by side."""
    chunks = np.array_split(friction, -(-len(friction) // _CHUNK))
    points = [(s.posed.at_speed(speed), s.response, s.input_force) for s in states for speed in settings.speeds]
    long = [] if slide is None else [partial(slide, points)]
    sweep = [partial(_roots_over_friction, settings, (s, c)) for s in states for c in chunks]
    operating = [partial(_operate, settings, law, task) for task in tasks]
    about, swept, outcomes = context.side_by_side(long, sweep, operating, label="friction sweep, operating points")
    roots = [np.vstack(swept[k:k + len(chunks)]) for k in range(0, len(swept), len(chunks))]
    return (*about, None)[0], [follow_roots(r[:, np.argsort(abs(r[0]), kind="stable")]) for r in roots], outcomes


def _roots_over_friction(settings, task):
    """One root of each conjugate pair at each friction coefficient, (friction, n), about its own sliding state."""
    state, friction = task
    roots = []
    for mu in friction:
        sliding = state.posed.slide(state.response, state.input_force, constant(mu), mu, settings)
        matrices, beside = _linearised(sliding.about(state.model), sliding, state.basis, settings)
        every_root = quadratic_roots(*matrices, beside)
        roots.append(every_root[upper_half(every_root, len(matrices[0]))])
    return np.array(roots)


def _operate(settings, law, task):
    """Sliding state with friction of the law, and the modes about it on the basis of its pressure."""
    case, state, losses = task
    sliding = case.seeking.slide(case.response(settings.centrifugal), state.input_force, *law, settings)
    model = sliding.about(case.bench.model)
    hard = is_hard(model)
    basis = _basis(model, settings, 0.0) if hard else state.basis
    about = model if hard else sliding.about(state.model.at_speed(model.speed))
    matrices, beside = _linearised(about, sliding, basis, settings, settings.friction_slopes)
    root = quadratic_roots(*matrices, beside)
    near = np.flatnonzero(nearly(root, settings) & (root.imag >= 0))
    shape = basis.shape @ vectors_of(*matrices, root[near], root, beside)
    hysteretic = _hysteretic(case, model, losses, settings)
    root[near], shape = in_whole_model(model, sliding, root[near], shape, settings, hysteretic)
    still_near = nearly(root[near], settings)
    near, shape = root[near[still_near]], shape[:, still_near]
    losses = losses.enlarged(model.size)
    viscous = losses.viscous_motion(case.base.model, shape) if hysteretic is None and len(near) else None
    return _Outcome(model.speed, sliding, basis, root[upper_half(root, len(matrices[0]))], near, shape,
                    *balances(model, sliding, near, shape, losses, viscous, settings), near, np.full(len(near), -1.0))


def _over(settings, task, outcome):
    """OverFriction of an operating point with all modes of its ``outcome``."""
    case, _, losses = task
    model = outcome.sliding.about(case.bench.model)
    return over_friction(partial(_linearised, settings=settings, slopes=settings.friction_slopes), model,
                         outcome.sliding, outcome.basis, outcome.motion, _hysteretic(case, model, losses, settings))


def _hysteretic(case, model, losses, settings):
    """What makes loss factors hysteretic in a SlidingModel, see ``Losses.change``; None where they are not to be."""
    return losses.enlarged(model.size).change(case.base.model) if settings.hysteretic and not is_hard(model) else None


def _linearised(model, sliding, basis, settings, slopes=True):
    """((M, C, K), Settling) about steady sliding: of a model on its basis, or of motions that hard contacts allow."""
    friction, beside = sliding.acting(slopes), sliding.beside(model, slopes)
    if is_hard(model):
        allowed = hard_sliding(model, friction, basis.shape, settings.friction_damping)
        beside = beside and beside.projected(allowed.left, allowed.basis)
        return (np.eye(len(allowed.stiffness)), allowed.damping, allowed.stiffness), beside
    return model.linearised(friction, friction_damping=settings.friction_damping, gyroscopic=settings.gyroscopic,
                            centrifugal=settings.centrifugal), beside


def _lowest(roots, count):
    """The ``count`` smallest."""
    return roots[by_frequency(roots.real + 1j * abs(roots))[:count]]


def _lowest_frequencies(state, count, centrifugal):
    """The ``count`` lowest frequencies (Hz) of the closed system without friction, damping and gyroscopic terms."""
    if is_hard(state.model):
        return state.basis.frequency[:count]
    mass, _, stiffness = state.still.about(state.model).frictionless(gyroscopic=False, centrifugal=centrifugal)
    return _frequencies(scipy.linalg.eigvalsh(stiffness, mass)[:count])


def _frequencies(squared):
    return np.sqrt(np.maximum(squared, 0.0)) / (2 * np.pi)

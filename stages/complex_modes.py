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
from pipeline.case_models.steady_sliding import Posed, Steady, branch_stiffness, posed, refuse_twice
from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage, stored
from pipeline.physics.friction.dry_friction import Friction, constant, falling
from pipeline.physics.friction.friction_table import FrictionLaw, refuse_beyond
from pipeline.physics.friction.tangential_law import tangential_law
from pipeline.physics.modal.disc_modes import describe
from pipeline.physics.modal.quadratic_eigenproblem import (
    by_frequency,
    follow_roots,
    polished,
    quadratic_modes,
    quadratic_roots,
    upper_half,
)
from pipeline.physics.sliding.equilibrium import ClosureResponse, closure_response, falling_with_speed, from_map
from pipeline.physics.sliding.model import SlidingModel, loss_stiffness
from pipeline.physics.stability.constrained_modes import allowed_motions, hard_sliding, is_hard
from pipeline.physics.stability.friction_basis import FrictionBasis, friction_basis
from pipeline.physics.stability.growth_balance import body_shares, growth_terms
from pipeline.physics.time_stepping.simulate import Table
from pipeline.products import ComplexModes, Effects, FrictionMap, ReducedModel

DISC = "disc"
#: friction values of one task of the fan-out
_CHUNK = 7
#: growth rates above this negative share of the frequency are computed in the whole model, not on the basis alone
_NEARLY = 5e-4


class Settings(Section):
    """Friction sweep, operating points and the terms of the linearised system."""

    speeds: Quantities("rad/s") = option(
        ("8.5 rad/s", "10.25 rad/s", "12 rad/s"),
        "speeds of the drive at the operating points, a belt being a drum of radius 1 m; the sweep runs at their mean")
    friction: float | None = option(
        None, "coefficient of friction at high slip speed, where the chain has no friction map; none = that of the"
        " model", ge=0)
    friction_at_rest: float | None = option(None, "coefficient as the slip speed goes to zero; none = the same", ge=0)
    decay_speed: Quantity("m/s", gt=0) = option("10 mm/s", "slip speed over which friction falls from one to the other")
    friction_max: float = option(0.8, "last friction coefficient of the sweep, which starts at 0", gt=0)
    friction_steps: int = option(41, "points of the sweep, both ends included", ge=2)
    frequency_max: Quantity("Hz", gt=0) = option("20 kHz", "real modes below it span the motion; under hard contacts"
                                                 " all do")
    smallest_correction: float = option(
        1e-5, "corrections for friction and damping below this share of the modal amplitude are left out", ge=0)
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
    mapped = "friction_map" in sections
    if given and mapped or not (given or mapped or "interface_law" in sections):
        raise ConfigError("complex_modes.friction", "friction from one source",
                          "a friction map in the chain as well" if given else "neither this nor a friction map or law",
                          "leave it out" if given else "add it, such as friction: 0.4")


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
    """One operating point: its sliding state, its roots, and the motion (n, g) of the growing ones."""

    speed: float
    sliding: Steady
    root: np.ndarray
    growing: np.ndarray
    motion: np.ndarray
    corrections: int
    terms: tuple            # of the growing ones: {term: part of the growth rate}
    shares: np.ndarray      # (g, b) of the bodies in their kinetic energy

    @property
    def mean_friction(self):
        """Friction coefficient, mean over the contacts weighted by their force; 0 where nothing presses."""
        force, coefficient = self.sliding.contact.force, self.sliding.friction.coefficient
        return float(force @ coefficient / force.sum()) if force.any() else 0.0


@dataclass(frozen=True)
class _Losses:
    """Of a product ReducedModel: body of each contact (c,), imaginary stiffness (n, n) and damping (n, n) of bodies."""

    contact_body: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray

    def change(self, model):
        """(damping, stiffness) that make loss factors hysteretic in a SlidingModel with their viscous equivalent; None
        without loss factors."""
        return (self.damping - model.damping, 1j * self.stiffness) if self.stiffness.any() else None


@stage(check=_check)
def complex_modes(model: ReducedModel, friction_map: FrictionMap | None, effects: Effects | None, settings: Settings,
                  context: Context) -> ComplexModes:
    """Compute complex modes over friction and at the operating points.

    Effects of the case are linearised about the sliding state; in the friction sweep they add to each coefficient.

    Method:
    All complex modes were computed at {friction_steps} friction coefficients from 0 to {friction_max} and at the
    operating points, each about its own steady sliding state, in a basis of the real modes below
    {frequency_max} and their friction corrections; at the operating points, roots that grow or nearly do were then
    solved for in the whole reduced model, with loss factors as imaginary stiffness (hysteretic: {hysteretic}). A
    closing speed of {damping_speed} doubles the contact pressure (contact damping). A mode is unstable if its growth
    rate exceeds {neutral} times its angular frequency.
    """
    terms, loads = _told(physics_terms(effects), context), model.pressure[:, None] * model.input_area
    models = [(posed(model, k, np.mean(settings.speeds), settings.damping_speed, terms, conditions(effects)), load)
              for k, load in enumerate(loads)]
    refuse_twice(models[0][0].bench, settings.friction_damping)
    states = context.map(partial(_state, settings), models, "real modes")
    friction = np.linspace(0.0, settings.friction_max, settings.friction_steps)
    roots = _sweep(states, friction, settings, context)
    law = _friction_law(friction_map, model, settings)
    points = [(m.at_speed(speed), load) for m, load in models for speed in settings.speeds]
    losses = _Losses(model.contact_body, loss_stiffness(model), model.damping)
    outcomes = context.map(partial(_operate, settings, law, losses), points, "operating points")
    branches = min(max(len(s.basis.frequency) for s in states), *(s.model.size for s in states))
    return ComplexModes(
        settings=stored(settings), pressure=model.pressure, friction=friction, root=[r[:, :branches] for r in roots],
        real_frequency=[_lowest_frequencies(s, branches, settings.centrifugal) for s in states],
        operating_pressure=np.repeat(model.pressure, len(settings.speeds)),
        operating_speed=[o.speed for o in outcomes], operating_friction=[o.mean_friction for o in outcomes],
        operating_force=[o.sliding.contact.force for o in outcomes],
        operating_open=[np.sum(o.sliding.contact.force == 0) for o in outcomes],
        operating_root=[_lowest(o.root, branches) for o in outcomes], **_unstable(outcomes, model),
        corrections=max([s.basis.corrections for s in states] + [o.corrections for o in outcomes]))


def _told(terms, context):
    """The terms, those told that leave complex modes alone."""
    for term in terms:
        if not term.effect.small:
            context.log(f"{term.effect.name} at {term.location} does not enter linearised models: complex modes"
                        " unchanged")
    return terms


def _state(settings, task):
    """The model about its state without friction, on a basis that serves all states of the sweep."""
    case, input_force = task
    response, seeking = _response(case, settings), case.condensed() if case.moved else case
    still = seeking.slide(response, input_force, constant(0.0), 0.0, settings)
    about = still.about(case.bench.model)
    basis = _basis(about, settings, contact_stiffness=still.contact.stiffness.max(initial=0.0))
    bare = replace(case.bench.model, contacts=about.contacts)
    bare = bare if is_hard(about) else bare.projected(basis.shape)
    return _State(bare, response, input_force, basis, still, seeking if case.moved else case.within(bare))


def _response(case, settings):
    """ClosureResponse where the law of the model is what a sliding state is found with, else None."""
    tabled = isinstance(case.base.law, Table) and not case.moved
    return closure_response(case.bench.model, settings.centrifugal) if tabled else None


def _friction_law(friction_map, model, settings):
    """(Friction, the same over pressure and speed): of the map; without one, of the settings or the model."""
    if friction_map is not None:
        refuse_beyond(settings.sliding_distance, friction_map.distance[-1], "complex_modes.sliding_distance")
        law = FrictionLaw(friction_map.pressure, friction_map.speed, friction_map.distance, friction_map.friction)
        return Friction(law, distance=settings.sliding_distance), partial(from_map, law, settings.sliding_distance)
    if settings.friction is None:
        law = tangential_law(model).friction_law()
        return Friction(law), partial(from_map, law, 0.0)
    decay_speed, last = settings.decay_speed, settings.friction
    at_rest = last if settings.friction_at_rest is None else settings.friction_at_rest
    law = falling(at_rest, last, decay_speed)
    return law, partial(falling_with_speed, last, at_rest, decay_speed)


def _basis(model, settings, contact_stiffness=0.0):
    if is_hard(model):
        shape = allowed_motions(model)
        frequency = _frequencies(np.diag(hard_sliding(model, 0.0, shape, friction_damping=False).stiffness))
        return FrictionBasis(shape, frequency[frequency < settings.frequency_max], 0)
    return friction_basis(model, settings.frequency_max, settings.friction_damping, settings.smallest_correction,
                          contact_stiffness, settings.centrifugal, branch_stiffness(model))


def _sweep(states, friction, settings, context):
    """Roots (friction, n) of every state, followed over friction from the lowest without friction upwards."""
    chunks = np.array_split(friction, -(-len(friction) // _CHUNK))
    results = context.map(partial(_roots_over_friction, settings), [(s, c) for s in states for c in chunks],
                          "friction sweep")
    roots = [np.vstack(results[k:k + len(chunks)]) for k in range(0, len(results), len(chunks))]
    return [follow_roots(r[:, np.argsort(abs(r[0]), kind="stable")]) for r in roots]


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


def _operate(settings, law, losses, task):
    """Sliding state with friction of the law, and the modes about it on a basis of its own."""
    case, input_force = task
    response, seeking = _response(case, settings), case.condensed() if case.moved else case
    sliding = seeking.slide(response, input_force, *law, settings)
    model = sliding.about(case.bench.model)
    basis = _basis(model, settings)
    about = model if is_hard(model) else model.projected(basis.shape)
    matrices, beside = _linearised(about, sliding, basis, settings, settings.friction_slopes)
    modes = quadratic_modes(*matrices, beside=beside)
    hysteretic = losses.change(case.base.model) if settings.hysteretic else None
    root, shape = _whole(model, sliding, modes.value, basis.shape @ modes.right, settings, hysteretic)
    grows = (root.real > settings.neutral * abs(root)) & (root.imag >= 0)
    grows &= abs(root) < 2 * np.pi * settings.frequency_max
    return _Outcome(model.speed, sliding, root[upper_half(root, len(matrices[0]))], root[grows], shape[:, grows],
                    basis.corrections, *_balances(model, sliding, root[grows], shape[:, grows],
                                                  losses.contact_body, settings))


def _balances(model, sliding, roots, shapes, contact_body, settings):
    """(terms of the growth rate of each root, shares (g, b) of the bodies)."""
    friction = sliding.acting(settings.friction_slopes)
    terms = tuple(growth_terms(model, friction, root, shape, contact_body, settings.friction_damping)
                  for root, shape in zip(roots, shapes.T, strict=True))
    shares = [body_shares(model, shape) for shape in shapes.T]
    return terms, np.reshape(shares, (len(roots), len(model.body_name)))


def _whole(model, sliding, roots, shapes, settings, hysteretic=None):
    """Roots and shapes (n, g), those that grow, or nearly do, as they are in the whole reduced model.

    ``hysteretic``: what to add to its damping and its stiffness (imaginary), as of ``_Losses.change``, or None.
    """
    near = (roots.imag > 0) & (abs(roots) < 2 * np.pi * settings.frequency_max)
    near &= roots.real > -_NEARLY * abs(roots)
    if is_hard(model) or not near.any():
        return roots, shapes
    friction, beside = sliding.acting(settings.friction_slopes), sliding.beside(model, settings.friction_slopes)
    matrices = model.linearised(friction, settings.friction_damping, settings.gyroscopic, settings.centrifugal)
    if hysteretic is not None:
        matrices = matrices[0], matrices[1] + hysteretic[0], matrices[2] + hysteretic[1]
    roots, shapes = roots.copy(), shapes.copy()
    for k in np.flatnonzero(near):
        conjugate = np.argmin(abs(roots - roots[k].conj()))
        roots[k], better = polished(*matrices, roots[k], shapes[:, k], beside)
        shapes[:, k] = better / np.sqrt(abs(better.conj() @ matrices[0] @ better))
        roots[conjugate], shapes[:, conjugate] = roots[k].conj(), shapes[:, k].conj()
    return roots, shapes


def _linearised(model, sliding, basis, settings, slopes=True):
    """((M, C, K), Settling) about steady sliding: of a model on its basis, or of motions that hard contacts allow."""
    friction, beside = sliding.acting(slopes), sliding.beside(model, slopes)
    if is_hard(model):
        allowed = hard_sliding(model, friction, basis.shape, settings.friction_damping)
        beside = beside and beside.projected(allowed.left, allowed.basis)
        return (np.eye(len(allowed.stiffness)), allowed.damping, allowed.stiffness), beside
    return model.linearised(friction, friction_damping=settings.friction_damping, gyroscopic=settings.gyroscopic,
                            centrifugal=settings.centrifugal), beside


def _unstable(outcomes, model):
    """Growing modes below the frequency limit, strongest first: shapes on the surface, what moves, what feeds them."""
    recovery, names = model.recovery, list(model.body_name)
    unstable = [(number, *mode) for number, o in enumerate(outcomes)
                for mode in zip(o.growing, o.motion.T, o.terms, o.shares, strict=True)]
    unstable.sort(key=lambda f: -f[1].real)
    shapes = [_normalised(recovery @ f[2][:recovery.shape[2]].astype(np.complex64)) for f in unstable]
    shapes = np.array(shapes).reshape(len(unstable), *recovery.shape[:2])
    terms = list(unstable[0][3]) if unstable else []
    return {"unstable_operating": [f[0] for f in unstable], "unstable_root": [f[1] for f in unstable],
            "unstable_shape": shapes, "unstable_diameters": _diameters(model, shapes), "body_name": names,
            "unstable_share": np.reshape([f[4] for f in unstable], (len(unstable), len(names))), "growth_term": terms,
            "unstable_growth": np.reshape([list(f[3].values()) for f in unstable], (len(unstable), len(terms)))}


def _diameters(model, shapes):
    """Nodal diameters (g,) of the disc in the ``shapes`` (g, v, 3) on the surface; -1 without a disc."""
    names = list(model.body_name)
    on_disc = model.visible_body == (names.index(DISC) if DISC in names else -1)
    if not on_disc.any() or not len(shapes):
        return np.full(len(shapes), -1)
    return describe(model.visible_position[on_disc], shapes[:, on_disc].reshape(len(shapes), -1).T)[0]


def _normalised(shape):
    """The shape with its largest component 1, which also fixes its phase."""
    if not shape.size:
        return shape
    return shape / shape.ravel()[abs(shape).argmax()]


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

"""Stage beam_geometry: search for the dimensions of the beam-on-beam system, which the paper does not give."""

from functools import partial
from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.contract import BrakechainError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.numerics.stretch_moves import stretch_samples
from pipeline.physics.signals.bursts import bursts, harmonic_lines
from pipeline.physics.signals.spectra import power_spectrum
from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel
from pipeline.physics.stability.constrained_modes import growth, hard_sliding
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import Hard, simulate
from pipeline.products import BeamGeometry
from pipeline.systems.beam_geometry import (
    GEOMETRY,
    LOWER,
    MOTION,
    NAMES,
    UPPER,
    described,
    linear,
    modes_of,
    motion_cost,
)
from pipeline.systems.beam_on_beam import build

#: coordinates of a geometry with rigid supports
_RIGID = 6
#: a geometry whose linear cost exceeds this is not stepped in time; one that is not stepped costs more than any that is
_WORTH, _NOT_STEPPED = 25.0, 500.0
#: band of the low mode, Hz, and the width in which roots are sought about 400 and 2800 Hz
_LOW_BAND, _WIDTH = (250.0, 650.0), 0.15


class Settings(Section):
    """Length of each part of the search."""

    seed: int = option(1, "seed of every part", ge=0)
    tilts: Quantities("rad") = option(("-5 deg", "5 deg"), "senses of the tilt that the rigid search tries")
    rigid_generations: int = option(60, "generations of the search with rigid supports, linear facts alone", ge=1)
    generations: int = option(120, "generations of the search with supports that yield, linear facts alone", ge=1)
    population: int = option(6, "members of a population per parameter, in both", ge=1)
    joint_population: int = option(12, "members of the joint search", ge=5)
    joint_generations: int = option(40, "generations of the joint search, linear facts and motion", ge=1)
    walkers: int = option(28, "walkers that sample what the linear facts leave open", ge=24)
    sweeps: int = option(60, "sweeps of the walkers; the first half is dropped", ge=2)
    friction: float = option(0.2, "coefficient of friction of the motion", gt=0)
    speed: Quantity("m/s") = option("-2 mm/s", "speed of the track's support along x")
    step: Quantity("s", gt=0) = option("2 us", "time step of the motion")
    duration: Quantity("s", gt=0) = option("0.4 s", "length of the motion; its first quarter is not judged")
    highest_frequency: Quantity("Hz", gt=0) = option("60 kHz", "modes above it are left out of the motion")
    motion_seeds: tuple[int, ...] = option((1, 2), "seeds of the start velocity; costs are means", min_length=1)
    damping_factors: tuple[float, ...] = option((0.0, 0.1, 0.3, 1.0), "factors on the damping per mass of the geometry"
                                                " found, to see when the low mode is heard", min_length=1)
    start: tuple[float, ...] | None = option(None, "a known geometry (13 parameters) that joins the joint search")


@stage
def beam_geometry(settings: Settings, context: Context) -> BeamGeometry:
    """Search for one geometry that reproduces coalescences, modes and motion, and quantify its uncertainty.

    Method:
    Differential evolution fitted the linear facts, first with rigid supports ({rigid_generations} generations), then
    with elastic supports ({generations}). The best geometry started a joint search over geometry, width and damping
    ({joint_generations} generations of {joint_population}) whose cost adds that of the motion over {duration}, mean
    over the seeds {motion_seeds}. {sweeps} sweeps of {walkers} walkers sampled the uncertainty that the linear facts
    leave.
    """
    rigid = [_linear_search(settings, _RIGID, tilt, settings.rigid_generations) for tilt in settings.tilts]
    yielding = _linear_search(settings, GEOMETRY, settings.tilts[0], settings.generations)
    context.log(f"linear costs: rigid {', '.join(f'{r.fun:.3g}' for r in rigid)}; yielding {yielding.fun:.3g}")
    joint = _joint_search(settings, yielding.x)
    sample = _sampled(settings, joint.x[:GEOMETRY])
    runs = [_motion(settings, joint.x, seed) for seed in settings.motion_seeds]
    result = linear(joint.x)
    return BeamGeometry(
        parameter=NAMES, best=joint.x, linear_cost=result.cost, cost=joint.fun,
        rigid_tilt=settings.tilts, rigid_cost=[r.fun for r in rigid], rigid_best=[r.x for r in rigid],
        rigid_parameter=NAMES[:_RIGID], yielding_cost=yielding.fun, samples=sample, sampled_parameter=NAMES[:GEOMETRY],
        lower_bound=LOWER[:GEOMETRY], upper_bound=UPPER[:GEOMETRY],
        onset_frequency=result.found.onset_frequency, onset_friction=result.found.onset_friction,
        closed_frequency=result.found.frictionless, quantity_name=list(MOTION),
        lower=np.maximum([band[0] for band in MOTION.values()], -1e9),
        upper=np.minimum([band[1] for band in MOTION.values()], 1e9),
        motion=[[run[name] for name in MOTION] for run in runs],
        evaluations=joint.nfev + yielding.nfev + sum(r.nfev for r in rigid),
        **_over_damping(settings, joint.x))


def _linear_search(settings, size, tilt, generations):
    return scipy.optimize.differential_evolution(
        lambda vector: linear(vector, tilt).cost, list(zip(LOWER[:size], UPPER[:size], strict=True)), init="sobol",
        popsize=settings.population, maxiter=generations, seed=settings.seed, polish=False, tol=1e-6,
        mutation=(0.4, 0.9), recombination=0.8)


def _joint_search(settings, geometry):
    """Optimum of an evolution that begins about the linear one, and at the known geometry where there is one."""
    random = np.random.default_rng(settings.seed)
    start = np.concatenate((geometry, (LOWER + UPPER)[GEOMETRY:] / 2))
    centres = [start] + ([np.array(settings.start)] if settings.start is not None else [])
    spread = (UPPER - LOWER) * np.r_[np.full(GEOMETRY, 0.004), 0.15, 0.15, 0.15]
    population = np.array([centres[k % len(centres)] + spread * random.standard_normal(len(LOWER)) * (k >= len(centres))
                           for k in range(settings.joint_population)])
    return scipy.optimize.differential_evolution(
        partial(_cost, settings), list(zip(LOWER, UPPER, strict=True)), init=np.clip(population, LOWER, UPPER),
        strategy="currenttobest1bin", mutation=(0.3, 0.9), recombination=0.9, maxiter=settings.joint_generations,
        seed=settings.seed, polish=False, tol=0)


def _cost(settings, vector):
    """Linear cost and the mean cost of the motions; a motion that fails costs as much as none."""
    cost = linear(vector).cost
    if cost > _WORTH:
        return _NOT_STEPPED + cost
    try:
        return cost + float(np.mean([motion_cost(_motion(settings, vector, seed)) for seed in settings.motion_seeds]))
    except BrakechainError:
        return 2 * _NOT_STEPPED


def _sampled(settings, best):
    """Geometries that the linear facts allow: density exp(-cost / 2) within the bounds."""
    random = np.random.default_rng(settings.seed)
    lower, upper = LOWER[:GEOMETRY], UPPER[:GEOMETRY]
    spread = 0.003 * (upper - lower) * random.standard_normal((settings.walkers, GEOMETRY))
    kept = stretch_samples(lambda vector: -linear(vector).cost / 2, np.clip(best + spread, lower, upper), lower, upper,
                           settings.sweeps, settings.seed)
    return kept[len(kept) // 2:]


def _model(settings, vector, damping_factor=1.0):
    """SlidingModel of a geometry in the modes of its Timoshenko beams."""
    description = described(vector)
    modes, sensor, load = modes_of(build(description, "timoshenko"))
    kept = modes.squared < (2 * np.pi * settings.highest_frequency) ** 2
    squared, size = modes.squared[kept], int(kept.sum())
    normal, tangent, sensor, load = (row[kept][None] for row in (modes.normal, modes.tangent, sensor, load))
    none, unit = np.zeros((size, size)), np.ones(1)
    force = description.contact.force * unit
    contacts = Contacts(normal, tangent, 0 * normal, np.zeros((1, 3)), unit, unit, force, 0 * unit,
                        0 * unit)
    drag = damping_factor * description.material.mass_damping + description.material.stiffness_damping * squared
    return SlidingModel(("beams",), np.zeros(size, int), np.eye(size), np.diag(drag), none, np.diag(squared), none,
                        Joints((), np.zeros((0, size)), np.zeros(0), np.zeros(0)), contacts, ("weight",), load, ("B",),
                        sensor, settings.speed), description.contact.force


def _motion(settings, vector, seed, damping_factor=1.0):
    """What MOTION judges, of one motion."""
    model, force = _model(settings, vector, damping_factor)
    start = steady_start(model, Hard(), constant(settings.friction), [force])
    kick = 1e-4 * np.random.default_rng(seed).standard_normal(model.size)
    every = max(1, round(10e-6 / settings.step))
    motion = simulate(model, Hard(), constant(settings.friction), step=settings.step, duration=settings.duration,
                      inputs=[force], record_every=every, start=start.kicked(kick))
    late = motion.time >= settings.duration / 4
    velocity, interval = motion.velocity[0, late], settings.step * every
    fundamental, _, height = harmonic_lines(velocity, interval, 20.0, 50.0, 3)
    frequency, density = power_spectrum(velocity, 1 / interval, 20.0)
    low = density[(frequency >= _LOW_BAND[0]) & (frequency <= _LOW_BAND[1])].max()
    share = [np.mean(motion.status[0, late] == kind) for kind in range(3)]
    return {"fundamental": fundamental, "peak_force": motion.normal_force[0, late].max(),
            "peak_slip": abs(motion.slip[0, late]).max(), "share_open": share[0], "share_stick": share[1],
            "share_slip": share[2], "second_height": height[1], "third_height": height[2],
            "low_level": 10 * np.log10(max(low, 1e-300) / density.max()),
            "vibrating_share": bursts(velocity, interval, 2e-3, 0.3).share}


def _over_damping(settings, vector):
    """Growth of the two unstable modes, and what is heard, over the damping per mass."""
    rows = []
    for factor in settings.damping_factors:
        model, _ = _model(settings, vector, factor)
        sliding = hard_sliding(model, settings.friction, friction_damping=False)
        motion = SimpleNamespace(**_motion(settings, vector, settings.motion_seeds[0], factor))
        rows.append((factor * np.exp(vector[GEOMETRY + 1]), growth(sliding, 400.0, _WIDTH),
                     growth(sliding, 2800.0, _WIDTH), motion.low_level, motion.fundamental, motion.vibrating_share))
    names = ("damping", "low_growth", "middle_growth", "damping_low_level", "damping_fundamental", "damping_vibrating")
    return {name: np.maximum(column, -1e9) for name, column in zip(names, zip(*rows, strict=True), strict=True)}

"""Kernels of the brake's own analyses, on the products of the default case where it has been run.

Without them, and in the tests, they run on a brake of a few elements; the unit of the work states the size.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from pipeline.case_models.operating_points import StabilitySettings, middle_speed
from pipeline.case_models.scatter import DEFAULT, Source, draw_values, factors_of, family, friction_errors
from pipeline.case_models.steady_sliding import mapped_friction, posed
from pipeline.contract import store
from pipeline.contract.settings import fill
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.equilibrium import closure_response
from pipeline.physics.sliding_motion import exudyn_motion
from pipeline.physics.sliding_motion.motion import sliding_motion
from pipeline.physics.sliding_motion.sliding_modes import sliding_modes
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.products import ComplexModes, FrictionMap, ReducedModel
from stages.complex_modes import Settings as ModesSettings
from stages.complex_modes import complex_modes
from stages.limit_cycle import Settings as CycleSettings
from stages.reduced_model import Settings as ModelSettings
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure

DEFAULT_RUN = Path(__file__).parents[2] / "data" / "runs" / "disc_brake"
#: as in configs/disc_brake.yaml: contacts of a patch and step of the motion, s
PATCH, STEP = 6, 2e-6
#: rad that the highest mode turns in a step of exudyn's explicit rule, which is stable up to 2.8
_TURN = 2.0


def brake(small):
    """(ReducedModel, FrictionMap, ComplexModes) of the default case, or of a brake of a few elements."""
    files = {cls: DEFAULT_RUN / f"{cls.name}.h5" for cls in (ReducedModel, FrictionMap, ComplexModes)}
    if not small and all(file.exists() for file in files.values()):
        return tuple(store.read(cls, file) for cls, file in files.items())
    model, law = reduced_model(small_structure(), settings=ModelSettings(fixed_below="20 kHz")), small_friction_map(0.6)
    return model, law, complex_modes(model, law, settings=ModesSettings(friction_steps=2, frequency_max="8 kHz"))


def at_highest_load(model, modes):
    """(Posed at the highest pressure and the middle speed, input force (i,) N, section complex_modes)."""
    settings, state = StabilitySettings.of(modes), int(np.argmax(model.pressure))
    case = posed(model, state, middle_speed(settings.speeds), settings.damping_speed)
    return case, model.pressure[state] * model.input_area, settings


def _moving(small, grown):
    """(SlidingMotion at the highest load, Run of ``grown`` s from half the reach of its growing modes, unit)."""
    model, law, modes = brake(small)
    case, load, linear = at_highest_load(model, modes)
    friction, plain = mapped_friction(law, linear.sliding_distance)
    steady = case.slide(closure_response(case.bench.model, linear.centrifugal), load, friction, plain, linear)
    about, settings = steady.about(case.bench.model), CycleSettings()
    whole = sliding_modes(about, steady.acting(linear.friction_slopes), linear.frequency_max,
                          settings.smallest_correction, friction_damping=linear.friction_damping)
    system = sliding_motion(about, steady.contact.closure, friction, case.bench.law,
                            whole.damped_above(linear.frequency_max, settings.damping_above), model.contact_body,
                            (PATCH, settings.patches), settings.stick_speed)
    start = np.zeros(len(system.modes.root), complex)
    growing = system.modes.growing()
    start[growing] = 0.5 * system.reach[growing]
    unit = f"steps of 2 us, {len(system.patches.load)} patches, {len(start)} modes"
    return system, system.run(start, STEP, grown, round(grown / STEP)), unit


def limit_cycle_steps(duration=3e-3, grown=30e-3, small=False):
    """limit cycle in steps of 2 us (goal 2,500: 0.3 s in 60)"""
    system, before, unit = _moving(small, grown)
    return lambda: system.run(before.end, STEP, duration).state, round(duration / STEP), unit


def limit_cycle_exudyn(duration=2e-5, grown=30e-3, small=False):
    """the same motion in exudyn, explicit steps"""
    system, before, unit = _moving(small, grown)
    step = STEP / np.ceil(STEP * abs(system.modes.root).max() / _TURN)
    return lambda: exudyn_motion.run(system, before.state[-1], step, duration).state, round(duration / STEP), unit


def friction_sweep(points=2, small=False):
    """friction sweep, all modes (goal 10: 50 points in 5 s)"""
    model, _, modes = brake(small)
    case, load, settings = at_highest_load(model, modes)
    whole, response = case.bench.model, closure_response(case.bench.model, settings.centrifugal)
    still = case.slide(response, load, constant(0.0), 0.0, settings)
    about = still.about(whole)
    basis = friction_basis(about, settings.frequency_max, settings.friction_damping, settings.smallest_correction,
                           still.contact.stiffness.max(), settings.centrifugal)
    bare = replace(whole, contacts=about.contacts).projected(basis.shape)
    case = case.within(bare)

    def call():
        roots = []
        for mu in np.linspace(0, settings.friction_max, points + 1)[1:]:
            sliding = case.slide(response, load, constant(mu), mu, settings)
            roots.append(quadratic_roots(*sliding.about(bare).linearised(
                sliding.acting(), settings.friction_damping, settings.gyroscopic, settings.centrifugal)))
        return np.array(roots)

    return call, points, f"points, {len(model.contact_area)} contacts, {bare.size} coordinates"


def draws_of_probability(draws=4, small=False):
    """draws at one point (goal 7.5: 500 at 9 in 5 min, 2 cores)"""
    model, law, modes = brake(small)
    points, random = StabilitySettings.of(modes), np.random.default_rng(11)
    sources = [s for s in (fill(Source, given, "source") for given in DEFAULT) if _there(s, model)]
    errors = friction_errors(law, points.sliding_distance)
    drawn = [factors_of(sources, row, model) for row in draw_values(sources, errors, draws + 2, random)]
    speed = middle_speed(points.speeds)
    case = sampled(family(model, int(np.argmax(model.pressure)), law, points), [speed], points.frequency_max, drawn[:2])
    return (lambda: np.concatenate([case.roots(factors, speed) for factors in drawn[2:]]), draws,
            f"draws, {len(model.contact_area)} contacts, {len(model.mass)} coordinates")


def _there(source, model):
    """Whether a brake has the joints, or the linings, that a Source of scatter means."""
    joints = source.part is None or any(source.part in str(name) for name in model.joint_name)
    return joints and (source.kind != "lining_stiffness" or len(model.lining_coordinate) > 0)


#: kernel -> arguments of its smallest size
SMALLEST = {limit_cycle_steps: {"duration": 1e-4, "grown": 1e-4, "small": True},
            limit_cycle_exudyn: {"duration": 1e-5, "grown": 1e-4, "small": True}, friction_sweep: {"small": True},
            draws_of_probability: {"small": True}}
PAIRS = ((limit_cycle_steps, limit_cycle_exudyn),)

"""The kernels that 'make bench' times. Each function makes its data and returns (call, amount of work, its unit)."""

import numpy as np

from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.case_models.virtual_rig import built
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import question
from pipeline.diagnosis.settings import Settings as DiagnosisSettings
from pipeline.inference.procedure import diagnose
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import revolve
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.modal_superposition import fixed_points, modal_response
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.pads import exudyn_model, newmark
from pipeline.physics.pads.pad_system import static_start
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.rough.generator import plateau_pad, turned_disc
from pipeline.physics.rough.layered_solid import graded_depth, layered_compliance
from pipeline.physics.rough.normal_contact import solve_normal_contact
from pipeline.physics.rupture.history import run
from pipeline.physics.rupture.plate_grid import largest_step, plate
from pipeline.physics.rupture.plate_step import plain_step, rims
from pipeline.physics.time_stepping.simulate import Hard, simulate
from pipeline.physics.virtual_rig.response import Run as BenchRun
from pipeline.physics.virtual_rig.response import respond
from stages.lock_in import Settings as LockInSettings
from stages.lock_in import lock_in
from stages.pin_on_disc import Settings as PinSettings
from stages.pin_on_disc import pin_on_disc
from stages.reduced_model import Settings as ModelSettings
from stages.reduced_model import reduced_model
from tests.diagnosis import small_rig
from tests.physics import small_ruptures
from tests.physics.lumps import random_structure
from tests.physics.small_pads import random_assembly
from tests.stages.small_pin import CONTEXT as PIN_CONTEXT
from tests.stages.small_pin import small_law

_IRON = isotropic(120e9, 0.27)


def compliance():
    """surface compliance of a graded block, 128 x 128"""
    depth = graded_depth(1e-3 / 128, 1e-3, 1.5)
    return lambda: layered_compliance((128, 128), (1e-3 / 128,) * 2, depth, 110e9, 0.26), 128**2, "nodes"


def contact():
    """normal contact of two rough surfaces, 128 x 128"""
    depth = graded_depth(1e-3 / 128, 1e-3, 1.5)
    pair = layered_compliance((128, 128), (1e-3 / 128,) * 2, depth, 0.235e9, 0.25)
    shape = {"roughness_wavelength": 250e-6, "hurst": 0.8}
    disc = turned_disc(128, 1e-3, 62.5e-6, seed=1, rms_height=3.5e-6, feed=250e-6, marks_share=0.9, outbreak_share=0.03,
                       outbreak_size=80e-6, outbreak_depth=3.0, **shape)
    pad = plateau_pad(128, 1e-3, 62.5e-6, seed=2, rms_height=3.8e-6, plateau_share=0.25, plateau_size=250e-6,
                      plateau_height=1.0, plateau_roughness=6.0, edge_width=0.2, **shape)
    return lambda: solve_normal_contact(-pad - disc, pair.normal, 2e6, tolerance=1e-4), 128**2, "nodes"


def _ring(sectors):
    mesh = revolve(np.linspace(0.0662, 0.1567, 6), np.linspace(0, 2 * np.pi, sectors + 1), np.linspace(0, 0.00687, 2))
    return mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), np.array([7200.0]), _IRON[None]


def assembly():
    """stiffness and mass of a hex20 ring"""
    ring = _ring(72)
    return lambda: assemble(*ring), 3 * len(ring[0]), "DOF"


def modes():
    """30 modes of a hex20 ring by shift-invert Lanczos"""
    stiffness, mass = assemble(*_ring(48))
    return lambda: lowest_modes(stiffness, mass, available()[0], count=30), 30, "modes"


def roots():
    """all roots of a reduced quadratic problem, 200 coordinates"""
    random = np.random.default_rng(1)
    noise = random.standard_normal((200, 200))
    stiffness = np.diag(np.linspace(1e6, 1e10, 200)) + 1e5 * noise
    return lambda: quadratic_roots(np.eye(200), np.eye(200), stiffness), 1, "problems"


def superposition():
    """modal superposition, 100 modes x 50,000 steps x 8 forces"""
    random = np.random.default_rng(2)
    angular = 2 * np.pi * np.linspace(200, 20e3, 100)
    forces = random.standard_normal((50_000, 8))
    force_points, sensor_points = (fixed_points(random.standard_normal((n, 100))) for n in (8, 2))
    return (lambda: modal_response(angular, 0.004 * angular, 1e-5, forces, force_points, sensor_points), 5_000_000,
            "mode-steps")


def _transient(modes, highest, step, duration):
    model = random_structure(modes, highest)
    return (lambda: simulate(model, Hard(), constant(0.3), step=step, duration=duration, inputs=[20.0],
                             record_every=10), round(duration / step), "steps")


def transient_pin():
    """transient, 65 modes, hard contact, 0.5 s at 1 us"""
    return _transient(65, 40e3, 1e-6, 0.5)


def transient_beam():
    """transient, 100 modes, hard contact, 1 s at 2 us"""
    return _transient(100, 60e3, 2e-6, 1.0)


def lock_in_map():
    """lock-in map, 20 points of the full mesh: 17 lengths, 3 more"""
    system = pin_on_disc(small_law(), PinSettings(), context=PIN_CONTEXT)
    model = reduced_model(system, ModelSettings(fixed_below="15 kHz", residual_below="200 kHz"), context=PIN_CONTEXT)
    settings = LockInSettings(cases=[], lengths=17, loads=["1.5 kg"], speeds=["2.4 rpm"], tilts=["4 deg"])
    return lambda: lock_in(system, model, settings, context=PIN_CONTEXT), 20, "points"


def bench_run():
    """a recorded run of a mass with a hardening spring, 1200 samples, 2 steps each"""
    whole = with_effects(built(small_rig.model(), small_rig.laid_out()), small_rig.effects(small_rig.HIDDEN))
    shaken = {"shaker": small_rig.force(9.0, 1)}
    one = BenchRun("run", (small_rig.SAMPLES - 1) / small_rig.RATE, small_rig.RATE, shaken)
    return lambda: respond(whole, one), 2 * (small_rig.SAMPLES - 1), "steps"


def diagnosis_of_a_rig():
    """diagnosis of a lumped rig, 25 hypotheses, 3 runs and one held out"""
    given, laid_out = small_rig.recording(small_rig.HIDDEN, levels=(1.0, 2.0, 4.0, 3.0)), small_rig.laid_out()
    settings = fill(DiagnosisSettings, {
        "parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.2}},
        "held_out": ["level_4"], "noise": {"std": {"x": f"{small_rig.NOISE} m"}}}, "diagnosis")
    asked = question(built(small_rig.model(), laid_out), recorded(given, laid_out), settings)
    chosen = asked.candidates[:25]
    return lambda: diagnose(asked.problem, asked.budget, chosen), len(chosen), "hypotheses"


def _stepping(integrate, steps=5000):
    """Steps of 5 us of a reduced model of 40 coordinates on 36 contact patches, as many as the default case has."""
    system = random_assembly(size=40, count=36)
    modal, basis = preloaded_modes(system, static_start(system))
    start, scale = np.zeros(basis.shape[1]), np.linalg.norm(basis.T @ system.load)
    return lambda: integrate(modal, start, 5e-6, steps, scale=scale), steps, "steps"


def exudyn_steps():
    """pads on patches in exudyn, compiled force function"""
    return _stepping(exudyn_model.integrate)


def newmark_steps():
    """pads on patches by Newmark's rule in numba, same model"""
    return _stepping(newmark.integrate)


def rupture_steps():
    """rupture of two plates, 20 x 5 mm each at 25 um, 2.02 us"""
    lower, upper = small_ruptures.plates(2.5e-5, length=20e-3, height=5e-3)
    law, _ = small_ruptures.interface(lower, upper)
    steps = run(lower, upper, law, 2.02e-6).record.time.size
    updates = steps * (lower.rows * lower.columns + upper.rows * upper.columns)
    return lambda: run(lower, upper, law, 2.02e-6), updates, "node-updates"


def rupture_slices():
    """the step of one plate by numpy slices, same mesh"""
    grid = plate(small_ruptures.SOFT, 20e-3, 5e-3, 2.5e-5, 0.1, [(0, 0)] * 4)
    step, state = 0.9 * largest_step(grid), np.zeros((2, 2, grid.rows, grid.columns))
    rim = rims(grid, step)
    return lambda: plain_step(grid, rim, state[0], state[1], step), grid.rows * grid.columns, "node-updates"


KERNELS = (compliance, contact, assembly, modes, roots, superposition, exudyn_steps, newmark_steps, transient_pin,
           transient_beam, lock_in_map, rupture_steps, rupture_slices,
           bench_run, diagnosis_of_a_rig)
#: (kernel, kernel) pairs whose rates compare: the same work done in two ways
PAIRS = ((newmark_steps, exudyn_steps), (rupture_steps, rupture_slices))

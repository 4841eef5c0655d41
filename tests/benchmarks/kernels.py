"""The kernels that 'make bench' times.

Each function makes its data, of the size that its arguments say, and returns (call, amount of work, its unit).
"""

import numpy as np

from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.case_models.virtual_rig import built
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings as DiagnosisSettings
from pipeline.inference.procedure import diagnose
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import revolve
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.modal_superposition import Points, fixed_points, modal_response
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.pads import exudyn_model, newmark
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import static_start
from pipeline.physics.rough.contact.normal_contact import solve_normal_contact
from pipeline.physics.rough.generator import plateau_pad, self_affine, turned_disc
from pipeline.physics.rough.layered_solid import graded_depth, half_space_compliance, layered_compliance
from pipeline.physics.rupture.history import run
from pipeline.physics.rupture.plate_grid import largest_step, plate
from pipeline.physics.rupture.plate_step import plain_step, rims, step_plate
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.stability.draws.draw_system import BodyLosses
from pipeline.physics.stability.draws.sampled_roots import Sampled
from pipeline.physics.stability.draws.sampled_sliding import GivenSliding
from pipeline.physics.stability.draws.scatter import Factors, Family
from pipeline.physics.time_stepping.simulate import Hard, simulate
from pipeline.physics.virtual_rig.response import Run as RigRun
from pipeline.physics.virtual_rig.response import respond
from stages.lock_in import Settings as LockInSettings
from stages.lock_in import lock_in
from stages.pin_on_disc import Settings as PinSettings
from stages.pin_on_disc import pin_on_disc
from stages.reduced_model import Settings as ModelSettings
from stages.reduced_model import reduced_model
from tests.benchmarks import brake_kernels
from tests.diagnosis import small_rig
from tests.physics import small_ruptures
from tests.physics.lumps import random_structure
from tests.physics.small_pads import random_assembly
from tests.stages.small_pin import CONTEXT as PIN_CONTEXT
from tests.stages.small_pin import small_law, small_system

YOUNG, POISSON, DENSITY = 120e9, 0.27, 7200.0
_IRON = isotropic(YOUNG, POISSON)
#: modulus and Poisson's ratio of the half-space, its mean pressure, and the error that Tamaas stops at
HALF_SPACE, HALF_SPACE_PRESSURE, TAMAAS_TOLERANCE, _GAP_TOLERANCE = (1.0, 0.3), 0.02, 1e-12, 1e-5
#: Hz at which the modes of the ring are sought
SHIFT = 300.0
#: rigid motions of a free body, whose frequencies are rounding
RIGID = 6
SUPERPOSITION_STEP = 1e-5


def compliance(nodes=128):
    """surface compliance of a graded block, 128 x 128"""
    depth = graded_depth(1e-3 / nodes, 1e-3, 1.5)
    return lambda: layered_compliance((nodes, nodes), (1e-3 / nodes,) * 2, depth, 110e9, 0.26).normal, nodes**2, "nodes"


def contact(nodes=128):
    """normal contact of two rough surfaces, 128 x 128"""
    depth = graded_depth(1e-3 / nodes, 1e-3, 1.5)
    pair = layered_compliance((nodes, nodes), (1e-3 / nodes,) * 2, depth, 0.235e9, 0.25)
    shape = {"roughness_wavelength": 250e-6, "hurst": 0.8}
    disc = turned_disc(nodes, 1e-3, 62.5e-6, seed=1, rms_height=3.5e-6, feed=250e-6, marks_share=0.9,
                       outbreak_share=0.03, outbreak_size=80e-6, outbreak_depth=3.0, **shape)
    pad = plateau_pad(nodes, 1e-3, 62.5e-6, seed=2, rms_height=3.8e-6, plateau_share=0.25, plateau_size=250e-6,
                      plateau_height=1.0, plateau_roughness=6.0, edge_width=0.2, **shape)
    return (lambda: solve_normal_contact(-pad - disc, pair.normal, 2e6, tolerance=1e-4).pressure, nodes**2,
            "nodes")


def rough_surface(nodes):
    """Self-affine heights (nodes, nodes) on the unit square, whose shortest wave has 8 nodes."""
    return 0.01 * self_affine(np.random.default_rng(4), nodes, 1.0, 8 / nodes, 1 / 2, 0.8)


def half_space_contact(nodes=256):
    """normal contact on a half-space, 256 x 256"""
    rough = rough_surface(nodes)
    normal = half_space_compliance(rough.shape, (1 / nodes,) * 2, *HALF_SPACE).normal
    return (lambda: solve_normal_contact(-rough, normal, HALF_SPACE_PRESSURE, tolerance=_GAP_TOLERANCE).pressure,
            nodes**2, "nodes")


def ring_mesh(sectors, kind="hexahedron20"):
    """Mesh of a brake ring, 5 elements across its width, one through its thickness."""
    return revolve(np.linspace(0.0662, 0.1567, 6), np.linspace(0, 2 * np.pi, sectors + 1), np.linspace(0, 0.00687, 2),
                   kind=kind)


def ring_matrices(sectors, kind="hexahedron20"):
    """(stiffness, mass) of the ring, CSR."""
    mesh = ring_mesh(sectors, kind)
    return assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), np.array([DENSITY]),
                    _IRON[None])


def assembly(sectors=72):
    """stiffness and mass of a hex20 ring"""
    return lambda: ring_matrices(sectors), 3 * len(ring_mesh(sectors).node), "DOF"


def assembly_full(sectors=36):
    """stiffness and mass of a hex27 ring, fully integrated"""
    return (lambda: ring_matrices(sectors, "hexahedron27"), 3 * len(ring_mesh(sectors, "hexahedron27").node), "DOF")


def modes(sectors=48, count=30):
    """30 modes of a hex20 ring by shift-invert Lanczos"""
    stiffness, mass = ring_matrices(sectors)
    solver = available()[0]
    return lambda: lowest_modes(stiffness, mass, solver, count=count, shift=SHIFT)[0][RIGID:], count, "modes"


def quadratic_problem(size):
    """(mass, damping, stiffness) with an unsymmetric part."""
    noise = np.random.default_rng(1).standard_normal((size, size))
    return np.eye(size), np.eye(size), np.diag(np.linspace(1e6, 1e10, size)) + 1e5 * noise


def roots(size=200):
    """all roots of a reduced quadratic problem, 200 coordinates"""
    problem = quadratic_problem(size)
    return lambda: quadratic_roots(*problem), 1, "problems"


def scattered_family(size, contacts):
    """Family of so many coordinates up to 200 kHz, half of them below 20 kHz, rubbed at random rows."""
    random = np.random.default_rng(6)
    frequency = np.concatenate((np.linspace(200, 20e3, size - size // 2), np.geomspace(21e3, 200e3, size // 2)))
    squared, none = np.diag((2 * np.pi * frequency) ** 2), np.zeros((size, size))
    normal, tangent, lateral = random.standard_normal((3, contacts, size)) * frequency / 20e3
    ones = np.ones(contacts)
    points = Contacts(normal, tangent, lateral, np.zeros((contacts, 3)), 1e-5 * ones, ones, 10 * ones,
                      1e7 / contacts * ones, 0 * ones)
    model = SlidingModel(("brake",), np.zeros(size, int), np.eye(size), none, none, squared, none,
                         Joints(("joint",), random.standard_normal((1, size)), np.full(1, 1e5), np.zeros(1)), points,
                         (), np.empty((0, size)), (), np.empty((0, size)), 10.0)
    return Family(model, lambda p, v: FrictionState(0.5 + 0 * p, 0 * p, 0 * p), np.empty(0), 10.0, 0.01 * squared,
                  np.full(1, 0.05))


def scattered_roots(size=390, contacts=1296):
    """unstable roots of one draw at one point, 390 coordinates"""
    family = scattered_family(size, contacts)
    losses = BodyLosses(family.loss, None, None, family.loss[None])
    case = Sampled(GivenSliding(family), np.eye(size), family.model, losses, 20e3)
    draw = Factors(joint_stiffness=1.2, contact_stiffness=0.9, friction=0.02)
    return lambda: case.roots(draw, 10.0), 1, "draws"


def superposition_data(steps, count):
    """(angular frequency, damping, forces (steps, 8) from nothing, participation of 8 forces and of 2 sensors)."""
    random = np.random.default_rng(2)
    angular = 2 * np.pi * np.linspace(200, 20e3, count)
    forces = random.standard_normal((steps, 8))
    forces[0] = 0.0
    return angular, 0.004 * angular, forces, *(random.standard_normal((n, count)) for n in (8, 2))


def superposition(steps=50_000, count=100):
    """modal superposition, 100 modes x 50,000 steps x 8 forces"""
    angular, damping, forces, *rows = superposition_data(steps, count)
    points = [fixed_points(r) for r in rows]
    return (lambda: modal_response(angular, damping, SUPERPOSITION_STEP, forces, *points), steps * count,
            "mode-steps")


def travelling_superposition(steps=20_000, count=300):
    """the same, 300 modes x 20,000 steps x 36 travelling forces"""
    random = np.random.default_rng(2)
    angular = 2 * np.pi * np.linspace(200, 20e3, count)
    points = [Points(random.standard_normal((n, 360, count)), np.arange(n), random.uniform(0, 6, n)) for n in (36, 2)]
    forces = random.standard_normal((steps, 36))
    return (lambda: modal_response(angular, 0.004 * angular, SUPERPOSITION_STEP, forces, *points, turning=10.0),
            steps * count, "mode-steps")


def _transient(modes, highest, step, duration):
    model = random_structure(modes, highest)
    return (lambda: simulate(model, Hard(), constant(0.3), step=step, duration=duration, inputs=[20.0],
                             record_every=10).displacement, round(duration / step), "steps")


def transient_pin(duration=0.5):
    """transient, 65 modes, hard contact, 0.5 s at 1 us"""
    return _transient(65, 40e3, 1e-6, duration)


def transient_beam(duration=1.0):
    """transient, 100 modes, hard contact, 1 s at 2 us"""
    return _transient(100, 60e3, 2e-6, duration)


def lock_in_map(lengths=17, coarse=False):
    """lock-in map, 20 points of the full mesh: 17 lengths, 3 more"""
    less = {}
    if coarse:
        system, model = small_system()
        less = {"fixed_below": "6 kHz", "residual_below": "100 kHz", "duration": "0.1 s"}
    else:
        system = pin_on_disc(small_law(), PinSettings(), context=PIN_CONTEXT)
        model = reduced_model(system, ModelSettings(fixed_below="15 kHz", residual_below="200 kHz"),
                              context=PIN_CONTEXT)
    settings = LockInSettings(cases=[], lengths=lengths, loads=["1.5 kg"], speeds=["2.4 rpm"], tilts=["4 deg"], **less)
    return (lambda: lock_in(system, model, effects=None, settings=settings, context=PIN_CONTEXT).base, lengths + 3,
            "points")


def rig_run():
    """run of a mass with a hardening spring, 1200 samples"""
    rig = with_effects(built(small_rig.model(), small_rig.laid_out()), small_rig.effects(small_rig.HIDDEN))
    shaken = {"shaker": small_rig.force(9.0, 1)}
    run = RigRun("run", (small_rig.SAMPLES - 1) / small_rig.RATE, small_rig.RATE, shaken)
    return lambda: respond(rig, run)["x"], 2 * (small_rig.SAMPLES - 1), "steps"


def diagnosis_of_a_rig(hypotheses=25):
    """diagnosis of a lumped rig, 25 hypotheses, 3 runs and one held out"""
    recording, laid_out = small_rig.recording(small_rig.HIDDEN, levels=(1.0, 2.0, 4.0, 3.0)), small_rig.laid_out()
    settings = fill(DiagnosisSettings, {
        "parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.2}},
        "held_out": ["level_4"], "noise": {"std": {"x": f"{small_rig.NOISE} m"}}}, "diagnosis")
    asked = forced_problem(built(small_rig.model(), laid_out), recorded(recording, laid_out), settings)
    chosen = asked.candidates[:hypotheses]
    return lambda: diagnose(asked.problem, asked.budget, chosen), len(chosen), "hypotheses"


def _stepping(integrate, steps):
    """Steps of 5 us of a reduced model of 40 coordinates on 36 contact patches, as many as the default case has."""
    system = random_assembly(size=40, count=36)
    modal, basis = preloaded_modes(system, static_start(system))
    start, scale = np.zeros(basis.shape[1]), np.linalg.norm(basis.T @ system.load)
    return lambda: integrate(modal, start, 5e-6, steps, scale=scale)[1], steps, "steps"


def exudyn_steps(steps=5000):
    """pads on patches in exudyn, compiled force function"""
    return _stepping(exudyn_model.integrate, steps)


def newmark_steps(steps=5000):
    """pads on patches by Newmark's rule in numba, same model"""
    return _stepping(newmark.integrate, steps)


def rupture_steps(spacing=2.5e-5, duration=2.02e-6):
    """rupture of two plates, 20 x 5 mm each at 25 um, 2.02 us"""
    lower, upper = small_ruptures.plates(spacing, length=20e-3, height=5e-3)
    law, _ = small_ruptures.interface(lower, upper)
    steps = run(lower, upper, law, duration).record.time.size
    updates = steps * (lower.rows * lower.columns + upper.rows * upper.columns)
    return lambda: run(lower, upper, law, duration).motion.slip, updates, "node-updates"


def _one_plate(spacing):
    grid = plate(small_ruptures.SOFT, 20e-3, 5e-3, spacing, 0.1, [(0, 0)] * 4)
    step, state = 0.9 * largest_step(grid), np.zeros((2, 2, grid.rows, grid.columns))
    return grid, rims(grid, step), state, step


def plate_steps(spacing=2.5e-5):
    """10 steps of one plate, 20 x 5 mm at 25 um"""
    grid, rim, state, step = _one_plate(spacing)
    window = np.empty((3, 2, grid.columns))

    def call():
        for _ in range(10):
            step_plate(grid, rim, state[0], state[1], step, window)
        return state

    return call, 10 * grid.rows * grid.columns, "node-updates"


def rupture_slices(spacing=2.5e-5):
    """the step of one plate by numpy slices, same mesh"""
    grid, rim, state, step = _one_plate(spacing)

    def call():
        plain_step(grid, rim, state[0], state[1], step)
        return state

    return call, grid.rows * grid.columns, "node-updates"


#: kernel -> arguments of its smallest size, which the tests run
SMALLEST = {
    compliance: {"nodes": 8}, contact: {"nodes": 32}, half_space_contact: {"nodes": 32}, assembly: {"sectors": 8},
    assembly_full: {"sectors": 8}, modes: {"sectors": 16, "count": 8}, roots: {"size": 10},
    scattered_roots: {"size": 12, "contacts": 6},
    superposition: {"steps": 50, "count": 6}, travelling_superposition: {"steps": 50, "count": 6},
    exudyn_steps: {"steps": 20}, newmark_steps: {"steps": 20}, transient_pin: {"duration": 1e-4},
    transient_beam: {"duration": 1e-4}, lock_in_map: {"lengths": 1, "coarse": True},
    rupture_steps: {"spacing": 5e-4, "duration": 1e-6}, plate_steps: {"spacing": 5e-4},
    rupture_slices: {"spacing": 5e-4}, rig_run: {}, diagnosis_of_a_rig: {"hypotheses": 1}, **brake_kernels.SMALLEST}
KERNELS = tuple(SMALLEST)
#: (kernel, kernel) pairs whose rates compare: the same work done in two ways
PAIRS = ((newmark_steps, exudyn_steps), (plate_steps, rupture_slices), *brake_kernels.PAIRS)

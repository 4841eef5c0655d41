"""Transient motion with contact and friction against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.closed_form.cattaneo_mindlin import loop_loss, tangential_load
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.signals.oscillation import dominant_frequency, growth_rate
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import (
    Forward,
    Hard,
    History,
    Lagrange,
    Penalty,
    Start,
    Table,
    imposed,
    simulate,
)
from tests.physics.lumps import ball, belt, lumps, random_structure

GRAVITY = 9.81
OPEN, STICK, SLIP = 0, 1, 2


def at(displacement, velocity=None):
    displacement = np.asarray(displacement, float)
    return Start(displacement, np.zeros_like(displacement) if velocity is None else np.asarray(velocity, float))


def order(errors):
    """Orders between runs of halved step."""
    return np.log2(np.divide(errors[:-1], errors[1:]))


@pytest.mark.exact
@pytest.mark.parametrize("restitution", [1.0, 0.8, 0.5])
def test_bouncing_ball(restitution):
    """Impacts at t1 (1 + 2 e + 2 e^2 + ...), each bounce e^2 as high as the one before."""
    height, step, first = 0.2, 1e-5, np.sqrt(2 * 0.2 / GRAVITY)
    motion = simulate(ball(), Hard(restitution), step=step, duration=0.9, inputs=[-GRAVITY], start=at([height]))
    hits = motion.time[np.flatnonzero(motion.normal_force[0])]
    times = first * (1 + 2 * np.cumsum([0, restitution, restitution**2]))
    times = times[times < 0.9]
    np.testing.assert_allclose(hits[:len(times)], times, atol=4 * step)
    flight = motion.displacement[0, (motion.time > times[0]) & (motion.time < times[1])]
    assert flight.max() == pytest.approx(restitution**2 * height, rel=1e-3)


@pytest.mark.exact
def test_inelastic_ball_stays_and_presses_with_its_weight():
    motion = simulate(ball(), Hard(), step=1e-4, duration=0.5, inputs=[-GRAVITY], start=at([0.2]))
    rest = motion.time > 0.21
    np.testing.assert_allclose(motion.normal_force[0, rest], GRAVITY, rtol=1e-9)
    assert np.ptp(motion.displacement[0, rest]) < 1e-12 and np.all(motion.status[0, rest] != OPEN)
    assert motion.status_share[0, OPEN] == pytest.approx(np.sqrt(0.4 / GRAVITY) / 0.5, abs=1e-3)


@pytest.mark.exact
def test_forward_increments_bring_a_ball_to_rest_on_the_ground():
    """Never below it; the impulses are those of the fall and of the weight; all energy but that of the rest is lost."""
    motion = simulate(ball(), Forward(), step=1e-4, duration=0.5, inputs=[-GRAVITY], start=at([0.2]))
    rest = motion.time > 0.21
    assert motion.gap.min() > -1e-12 and np.ptp(motion.displacement[0, rest]) < 1e-12
    np.testing.assert_allclose(motion.normal_force[0, rest], GRAVITY, rtol=1e-9)
    assert motion.normal_force[0].sum() * 1e-4 == pytest.approx(GRAVITY * 0.5, rel=1e-3)
    assert motion.normal_work[-1] == pytest.approx(-0.2 * GRAVITY, rel=1e-6) and motion.imbalance < 1e-9


@pytest.mark.exact
def test_ball_on_a_spring_bounces_within_its_contact_time():
    """Penalty: half a period pi sqrt(m / k) in contact; N peaks at v sqrt(k m)."""
    motion = simulate(ball(2.0), Penalty(8e4), step=1e-5, duration=0.05, start=at([1e-3], [-1.0]))
    closed = motion.time[motion.normal_force[0] > 0]
    assert np.ptp(closed) == pytest.approx(np.pi * np.sqrt(2.0 / 8e4), rel=2e-3)
    assert motion.normal_force.max() == pytest.approx(np.sqrt(8e4 * 2.0), rel=1e-3)
    assert motion.velocity[0, -1] == pytest.approx(1.0, rel=1e-6)


@pytest.mark.exact
def test_hunt_crossley_contact_returns_less_velocity():
    """m v dv = -k c (1 + v / v0) dc with closing speed v: (v - v0 ln(1 + v / v0)) v0 is equal at both ends."""
    law = Table(np.array([0.0, 1e-2]), np.array([0.0, 8e2]), damping_speed=2.0)      # k = 8e4 N/m on 1 m^2
    motion = simulate(ball(2.0), law, step=5e-6, duration=0.04, start=at([0.0], [-1.0]))
    before, after = 1.0, -motion.velocity[0, -1]
    assert after < -0.5
    assert after - 2 * np.log(1 + after / 2) == pytest.approx(before - 2 * np.log(1 + before / 2), rel=1e-4)


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(1e6, 200.0), Lagrange(0.6), Forward()])
def test_stick_slip_oscillator(law):
    """Static over kinetic friction: period and amplitude of sticking and sliding in closed form."""
    static, kinetic, load, stiffness, speed, angular = 0.45, 0.3, 10.0, 100.0, 0.1, 10.0
    step = 1e-4 if isinstance(law, Hard | Lagrange | Forward) else 5e-5
    motion = simulate(belt(stiffness, speed=speed), law, constant(kinetic, static_factor=static / kinetic), step=step,
                      duration=12.0, inputs=[0.0, -load], start=at([0.0, -load / 1e6 * isinstance(law, Penalty)]))
    drop = (static - kinetic) * load / stiffness
    sliding = 2 / angular * (np.pi - np.arctan(drop * angular / speed))
    begins = motion.time[np.flatnonzero(np.diff((motion.status[0] == SLIP).astype(int)) == 1)]
    assert np.diff(begins[1:]) == pytest.approx(sliding + 2 * drop / speed, rel=1e-3)
    largest = kinetic * load / stiffness + np.hypot(drop, speed / angular)
    assert motion.displacement[0].max() == pytest.approx(largest, rel=1e-4)
    assert motion.imbalance < 0.005


@pytest.mark.exact
def test_constant_friction_leaves_the_cycle_that_just_sticks():
    """Mass on belt, constant mu: larger motions decay to the velocity amplitude of the belt and stay there."""
    motion = simulate(belt(), Hard(), constant(0.3), step=1e-4, duration=30.0, inputs=[0.0, -10.0],
                      start=at([0.03 + 0.06, 0.0]))
    late = motion.displacement[0, motion.time > 20.0]
    assert (late.max() - late.min()) / 2 == pytest.approx(0.1 / 10.0, rel=2e-3)


@pytest.mark.exact
def test_limit_cycle_of_a_cubic_characteristic():
    """mu = s - 3/2 D u + 1/2 D u^3, u = slip / w: by averaging, the velocity amplitude V without sticking obeys
    V^2 = 4 (w^2 - v^2 - 2 c w^3 / (3 N D)); Thomsen & Fidlin, Int. J. Non-Linear Mech. 38 (2003) 389."""
    static, drop, width, speed, load, damping = 0.4, 0.05, 0.5, 0.45, 0.4, 0.0004
    slip = np.linspace(0, 1.2, 2401)
    mu = static - drop * (1.5 * slip / width - 0.5 * (slip / width) ** 3)
    amplitude = 2 * np.sqrt(width**2 - speed**2 - 2 * damping * width**3 / (3 * load * drop))
    for begin in (0.8, 1.2):
        motion = simulate(belt(100.0, damping, speed), Hard(), tabulated(slip, mu), step=2e-3, duration=700.0,
                          inputs=[0.0, -load], record_every=7, start=at([begin * amplitude / 10, 0.0]))
        late = motion.velocity[0, motion.time > 600]
        assert np.sqrt(2) * late.std() == pytest.approx(amplitude, rel=0.005)
        assert motion.status_share[0, STICK] < 1e-4


@pytest.mark.exact
@pytest.mark.parametrize("friction", [constant(0.2), constant(0.2, description="elastic", stiffness=1e5),
                                      constant(0.2, description="evolution", stiffness=1e5)])
def test_free_vibration_with_friction_decays_linearly(friction):
    """Each full cycle takes 4 mu N / k off the amplitude, whatever the description of sticking."""
    motion = simulate(belt(100.0, speed=0.0), Hard(), friction, step=2e-5, duration=3.0, inputs=[0.0, -1.0],
                      record_every=5, start=at([0.0301, 0.0]))
    x = motion.displacement[0]
    peaks = x[1:-1][(x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:]) & (x[1:-1] > 2.1e-3)]
    np.testing.assert_allclose(peaks[:3], 0.0301 - 0.008 * np.arange(1, 4), atol=5e-5)
    assert motion.sliding_loss[-1] + motion.stored[-1] == pytest.approx(motion.stored[0], rel=2e-3)


def flutter_model(k11, k22, k12, k_contact):
    """Two modes of unit mass, coupled by k12, on a belt that runs backwards."""
    rows = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
    return lumps([1.0, 1.0], rows, [k11 - k12, k22 - k12 - k_contact, k12], normal=[[0.0, 1.0]], tangent=[[1.0, 0.0]],
                 speed=-5.0)


@pytest.mark.exact
@pytest.mark.parametrize("share", [0.9, 1.1, 1.5])
def test_two_mode_flutter(share):
    """Below the threshold of the closed form nothing grows; above it the motion grows and turns as the root says."""
    stiffness = 1.1e6, 1.2e6, 1e5, 4e5
    model, mu = flutter_model(*stiffness), share * onset_friction(*stiffness)
    load = np.array([0.0, -1000.0])
    matrix = model.supported()[2] + 4e5 * np.outer(model.contacts.normal[0], model.contacts.normal[0])
    matrix = matrix - 4e5 * mu * np.outer(model.contacts.tangent[0], model.contacts.normal[0])
    rest = np.linalg.solve(matrix, load)
    root = max(roots_over_friction(*stiffness, mu), key=lambda s: (round(s.real, 6), s.imag))
    duration = 0.3 if share < 1 else 6 / root.real
    motion = simulate(model, Penalty(4e5), constant(mu), step=1e-5, duration=duration, inputs=load,
                      start=at(rest + [1e-7, 1e-7]))
    swing = motion.displacement[0] - rest[0]
    if share < 1:
        assert abs(swing[len(swing) // 2:]).max() < 1.2 * abs(swing[:len(swing) // 2]).max()
        return
    half = swing[len(swing) // 3:]
    assert growth_rate(half, 1e-5, root.imag / (2 * np.pi))[0] == pytest.approx(root.real, rel=0.02)
    assert dominant_frequency(half, 1e-5) == pytest.approx(root.imag / (2 * np.pi), rel=0.01)


@pytest.mark.exact
def test_legs_share_the_load_as_statics_says():
    """A block pulled over two legs: N = (m g -+ 2 mu m g h / b) / 2, by the moment of friction below its centre."""
    mass, half, height, mu = 2.0, 0.1, 0.05, 0.3
    inertia = 0.01
    model = lumps([mass, mass, inertia], [[1.0, 0, 0]], [1e4], [200.0],
                  normal=[[0, 1, half], [0, 1, -half]], tangent=[[1, 0, height]] * 2, speed=0.5)
    motion = simulate(model, Hard(), constant(mu), step=1e-5, duration=0.4, record_every=10,
                      inputs=[0.0, -mass * GRAVITY, 0.0])
    moment = mu * mass * GRAVITY * height / (2 * half)
    late = motion.time > 0.35
    np.testing.assert_allclose(motion.normal_force[:, late].mean(axis=1),
                               mass * GRAVITY / 2 + np.array([-moment, moment]), rtol=1e-3)
    np.testing.assert_allclose(motion.friction_force[:, late], mu * motion.normal_force[:, late], rtol=1e-9)


@pytest.mark.exact
def test_parallel_contacts_make_the_loop_of_cattaneo_and_mindlin():
    """Elastic-stick springs that let go one after the other, as the annuli of a Hertz contact do."""
    sliding, limit, mu, count, amplitude, period = 2e-6, 5.0, 0.5, 40, 1.6e-6, 1.0
    edge = sliding * np.linspace(0, 1, count + 1)
    share = -np.diff(1.5 * limit / sliding * np.sqrt(1 - edge / sliding))       # stiffness lost in each interval
    lets_go = (edge[1:] + edge[:-1]) / 2
    model = lumps(np.ones(count + 1), normal=np.eye(count + 1)[1:], tangent=[np.eye(count + 1)[0]] * count,
                  joints=[np.eye(count + 1)[0]], stiffness=[1e15])              # what is slid on does not give way
    model = replace(model, mass=np.diag(np.r_[1e9, np.ones(count)]))
    time = np.linspace(0, 1.25 * period, 20001)
    pull = History(amplitude * 2 * np.pi / period * np.cos(2 * np.pi * time / period), time[1])
    motion = simulate(model, Hard(), constant(mu, description="elastic", stiffness=share), step=5e-4 * period,
                      duration=1.25 * period, drive=pull, inputs=np.r_[0.0, -share * lets_go / mu])
    moved, force = amplitude * np.sin(2 * np.pi * motion.time / period), motion.friction_force.sum(axis=0)
    first = motion.time <= period / 4
    np.testing.assert_allclose(force[first], tangential_load(moved[first], sliding, limit), atol=0.003 * limit)
    cycle = (motion.time >= period / 4 - 1e-9) & (motion.time <= 1.25 * period + 1e-9)
    lost = np.diff(motion.sliding_loss[cycle][[0, -1]])[0]
    assert lost == pytest.approx(loop_loss(amplitude, sliding, limit), rel=0.01)
    back = cycle & (motion.time < 0.75 * period)
    unloading = (tangential_load(amplitude, sliding, limit)
                 - 2 * tangential_load((amplitude - moved[back]) / 2, sliding, limit))
    np.testing.assert_allclose(force[back], unloading, atol=0.006 * limit)


@pytest.mark.exact
@pytest.mark.parametrize("law, damper", [(Hard(), 0.0), (Hard(0.5), 3.0), (Penalty(2e6, 20.0), 0.0), (Forward(), 3.0),
                                         (Table(np.array([0, 1e-6, 1e-4]), np.array([0, 1.0, 300.0]), 0.5), 3.0)])
@pytest.mark.parametrize("description", ["rigid", "elastic", "evolution"])
def test_energy_is_balanced(law, damper, description):
    """Stored energy against work of inputs and contacts and loss, within 0.5 %, through contact, sticking, opening."""
    model = random_structure(12, 4e3, contacts=3).at_speed(0.002)
    pull = History(np.array([[30.0], [-20.0]] * 5), 0.006)
    joints = model.joints
    model = replace(model, joints=replace(joints, name=(*joints.name, "coupling"),
                                          rows=np.vstack((joints.rows, np.ones(12))),
                                          stiffness=np.append(joints.stiffness, 0.0),
                                          damping=np.append(joints.damping, damper)))
    motion = simulate(model, law, constant(0.5, static_factor=1.3, description=description, stiffness=3e5), step=1e-6,
                      duration=0.05, inputs=pull, record_every=10)
    assert motion.imbalance < 0.005
    assert motion.sliding_loss[-1] > 0 and motion.damping_loss[-1] > 0
    assert np.all(motion.status_share.max(axis=0) > 0)


@pytest.mark.exact
def test_linear_motion_is_exact_at_any_step():
    """No contact, a force that is linear between samples: the same motion whatever the step."""
    model = lumps([1.0, 2.0], [[1, 0], [1, -1]], [4e4, 9e4], [3.0, 5.0])
    force = History(np.array([[0.0, 0.0], [5.0, -1.0], [-3.0, 2.0], [0.0, 0.0]]), 0.01)
    coarse, fine = (simulate(model, Hard(), step=step, duration=0.1, inputs=force, record_every=every)
                    for step, every in ((5e-3, 1), (1e-5, 500)))
    np.testing.assert_allclose(coarse.displacement, fine.displacement, rtol=1e-9, atol=1e-16)
    assert abs(coarse.displacement).max() > 1e-5


@pytest.mark.exact
def test_free_mode_under_a_trapezoidal_step():
    """What a step of 4e-5 s does to 2250 Hz: the trapezoidal rule shows 2193 Hz, the exact step 2250 Hz."""
    model = lumps([1.0], [[1.0]], [(2 * np.pi * 2250) ** 2])
    shown = [dominant_frequency(simulate(model, law, step=4e-5, duration=0.2, start=at([1e-6])).displacement[0], 4e-5)
             for law in (Hard(), Lagrange())]
    assert shown == pytest.approx([2250, 2193], abs=1)


@pytest.mark.exact
@pytest.mark.parametrize("description, mu", [("rigid", 0.3), ("elastic", 0.6)])
def test_compliant_contact_under_newmarks_rule_is_the_trapezoidal_map(description, mu):
    """Sliding that stays: y_n = ((1 - h A / 2)^-1 (1 + h A / 2))^n y_0 about steady sliding, at any length of step."""
    model = lumps([1.0, 2.0], [[1, 0], [1, 1]], [4e4, 2e4], normal=[[0, 1.0]], tangent=[[1.0, 0]], speed=3.0)
    law, friction = Penalty(3e5, 2.0, gamma=0.5), constant(mu, description=description, stiffness=1e9)
    start, step, count = steady_start(model, law, friction, [0.0, -100.0]), 4e-3, 40
    kick = np.array([0.01, 0.0])         # along sliding: the forces at time 0 are those of steady sliding
    motion = simulate(model, law, friction, step=step, duration=count * step, inputs=[0.0, -100.0],
                      start=start.kicked(kick))
    assert set(motion.status[0, 1:]) == {SLIP}
    contacts = replace(model.contacts, preload=np.array([100.0]), stiffness=np.array([3e5]), damping=np.array([2.0]))
    mass, drag, stiffness = replace(model, contacts=contacts).linearised(mu, friction_damping=False)
    rate = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, drag)]])
    once = np.linalg.solve(np.eye(4) - step / 2 * rate, np.eye(4) + step / 2 * rate)
    state = np.linalg.matrix_power(once, count) @ np.r_[0, 0, kick]
    assert motion.end.displacement - start.displacement == pytest.approx(state[:2], rel=1e-6, abs=1e-9)
    assert motion.end.velocity == pytest.approx(state[2:], rel=1e-6, abs=1e-7)


@pytest.mark.exact
@pytest.mark.parametrize("law", [Penalty(3e4, 2.0), Table(np.array([0, 1e-2]), np.array([0, 300.0]), 1.0)])
def test_order_without_events_is_two(law):
    """A contact that stays closed and slides."""
    model = lumps([1.0, 1.0], [[1, 0], [1, 1]], [4e4, 2e4], [1.0, 2.0], [[0, 1.0]], [[1.0, 0]], speed=3.0)
    ends = [simulate(model, law, constant(0.3), step=0.05 / n, duration=0.05, inputs=[0.0, -100.0],
                     start=at([0.0, -3e-3])).end.displacement for n in (50, 100, 200, 3200)]
    errors = [np.linalg.norm(e - ends[-1]) for e in ends[:-1]]
    np.testing.assert_allclose(order(errors), 2, atol=0.15)


def worst(error, steps):
    """Largest error over twelve numbers of steps: events fall anywhere within a step."""
    return max(abs(error(n)) for n in range(steps, steps + 12))


@pytest.mark.exact
def test_order_with_impacts_is_one():
    """Hard contacts act from the first step that would close the gap on: their instant is known to one step."""
    first = np.sqrt(2 * 0.2 / GRAVITY)
    exact = 0.8 * GRAVITY * first * (0.5 - first) - GRAVITY / 2 * (0.5 - first) ** 2

    def error(steps):
        motion = simulate(ball(), Hard(0.8), step=0.5 / steps, duration=0.5, inputs=[-GRAVITY], start=at([0.2]),
                          record_every=steps)
        return motion.end.displacement[0] - exact

    errors = [worst(error, n) for n in (100, 400, 1600)]
    np.testing.assert_allclose(order(errors) / 2, 1, atol=0.2)


@pytest.mark.exact
@pytest.mark.parametrize("static_factor, description, expected", [(1.0, "rigid", 2), (1.0, "elastic", 2),
                                                                  (1.5, "rigid", 1)])
def test_order_with_sticking_and_sliding(static_factor, description, expected):
    """Two where friction is continuous, one where it drops as the contact breaks loose."""
    friction = constant(0.3, static_factor=static_factor, description=description, stiffness=3e3)

    def end(steps):
        return simulate(belt(), Hard(), friction, step=2.0 / steps, duration=2.0, inputs=[0.0, -10.0],
                        start=at([0.06, 0.0]), record_every=steps).end.displacement[0]

    fine = end(200_000)
    errors = [worst(lambda n: end(n) - fine, n) for n in (500, 2000, 8000)]
    np.testing.assert_allclose(order(errors) / 2, expected, atol=0.2)


def test_drive_that_reverses_turns_friction_round():
    pull = History(np.array([0.2, -0.2]), 1.0)
    motion = simulate(belt(), Hard(), constant(0.3), step=1e-3, duration=1.0, drive=pull, inputs=[0.0, -1.0])
    sliding = (motion.status[0] == SLIP) & (motion.time > 0)
    np.testing.assert_allclose(motion.friction_force[0, sliding], 0.3 * np.sign(motion.slip[0, sliding]), rtol=1e-9)
    assert {-1.0, 1.0} <= set(np.sign(motion.slip[0, sliding]))


@pytest.mark.exact
def test_imposed_displacement_is_a_force_along_its_joint():
    """A mass on a spring whose far end jumps by 1 mm: x = 1 mm (1 - cos w t)."""
    model = imposed(lumps([2.0], [[1.0]], [800.0]), "joint_0")
    motion = simulate(model, Hard(), step=0.01, duration=1.0, inputs=[0.0, 1e-3])
    np.testing.assert_allclose(motion.displacement[0], 1e-3 * (1 - np.cos(20 * motion.time)), atol=1e-15)


@pytest.mark.exact
def test_hard_contact_is_the_limit_of_stiff_ones_and_of_multipliers():
    """Mean load and motion along sliding agree between five ways to keep a sliding mass on its belt."""
    model, load = belt(4e4, 40.0, 0.5), [0.0, -20.0]
    stiff = Table(np.array([0.0, 1e-3]), np.array([0.0, 1e6]), 1e-3)
    laws = Hard(), Penalty(1e9, 3e4), stiff, Lagrange(0.6), Forward()
    runs = [simulate(model, law, constant(0.3), step=1e-5, duration=0.3, inputs=load) for law in laws]
    for run in runs[1:]:
        np.testing.assert_allclose(run.displacement[0], runs[0].displacement[0], atol=3e-7)
    assert runs[0].displacement[0, -1] == pytest.approx(0.3 * 20 / 4e4, rel=0.01)


def test_a_run_goes_on_where_another_ended():
    model, law, friction = random_structure(8, 2e3), Penalty(1e6, 10.0), constant(0.4)
    whole = simulate(model, law, friction, step=1e-6, duration=4e-3, inputs=[20.0])
    half = simulate(model, law, friction, step=1e-6, duration=2e-3, inputs=[20.0])
    rest = simulate(model, law, friction, step=1e-6, duration=2e-3, inputs=[20.0], start=half.end)
    np.testing.assert_allclose(rest.displacement[:, -1], whole.displacement[:, -1], rtol=1e-9)


def test_fewer_records_show_the_same_motion():
    model = random_structure(8, 2e3)
    every, some = (simulate(model, Hard(), constant(0.4), step=1e-5, duration=0.01, inputs=[20.0], record_every=n)
                   for n in (1, 10))
    np.testing.assert_array_equal(every.velocity[:, ::10], some.velocity)
    np.testing.assert_allclose(every.normal_force[0, 1:].reshape(-1, 10).mean(axis=1), some.normal_force[0, 1:])
    np.testing.assert_array_equal(every.status_share, some.status_share)


def run(model=None, law=None, friction=None, **options):
    options = {"step": 1e-5, "duration": 1e-3, "inputs": [0.0, -1.0], **options}
    return simulate(belt() if model is None else model, law or Hard(), friction or constant(0.3), **options)


@pytest.mark.parametrize("options, said", [
    ({"step": 0.5, "duration": 5.0}, "highest mode"), ({"law": Penalty(1e12)}, "shorten the step, soften"),
    ({"law": Penalty(0.0)}, "contact stiffness"), ({"law": Hard(1.5)}, "restitution"),
    ({"law": Lagrange(0.3)}, "gamma"),
    ({"law": Table(np.array([0.1, 1.0]), np.array([0.0, 1.0]))}, "rise from 0"), ({"inputs": [1.0]}, "one force"),
    ({"law": Table(np.array([0, 1e-9]), np.array([0, 1e3]))}, "8 steps in a period of the contact"),
    ({"friction": constant(0.3, description="elastic", stiffness=1e12)}, "stiffness of contact 0"),
    ({"duration": 0.0}, "positive step"), ({"drive": np.nan}, "finite samples")])
def test_what_cannot_be_computed_is_refused(options, said):
    with pytest.raises(ConfigError, match=said):
        run(**options)


def test_modes_without_the_motion_of_a_contact_are_refused():
    model = lumps([1.0, 1.0], np.eye(2), [100.0, 1e8], normal=[[0.0, 1.0]], tangent=[[1.0, 0.0]], speed=0.1)
    with pytest.raises(ConfigError, match="normal force moves"):
        run(model, system=modal_system(model, highest=10.0))


def test_unknown_joint_is_refused():
    with pytest.raises(ConfigError, match="joint_0"):
        imposed(belt(), "sprung")


def test_motion_without_bound_is_not_returned():
    """A negative spring: the run stops with the time, not with infinities."""
    model = lumps([1.0], [[1.0]], [-1e10])
    with pytest.raises(ConvergenceError, match=r"t = .*finite motion"):
        simulate(model, Hard(), step=1e-5, duration=0.1, inputs=[1.0], record_every=10)


def joined(force, speed=0.1):
    """The mass of ``belt`` alone, its normal force given once and for all."""
    model = lumps([1.0], [[1.0]], [100.0], [0.5], [[0.0]], [[1.0]], speed)
    return replace(model, contacts=replace(model.contacts, preload=np.array([force])))


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(1e4), Table(np.array([0.0, 1.0]), np.array([0.0, 1e4])), Lagrange()])
def test_a_friction_joint_moves_as_a_mass_pressed_by_that_force(law):
    """Whatever the law of the other contacts: N never changes. The twin is pressed by 5 N onto a belt that is hard."""
    friction = tabulated([0.0, 0.05, 0.5], [0.6, 0.4, 0.3])
    joint = simulate(joined(5.0), law, friction, step=1e-4, duration=4.0)
    hard = law if isinstance(law, Lagrange) else Hard()
    twin = simulate(belt(damping=0.5), hard, friction, step=1e-4, duration=4.0, inputs=[0.0, -5.0])
    np.testing.assert_array_equal(joint.normal_force[0, 1:], 5.0)
    assert 0.02 < joint.status_share[0, STICK] < 0.98 and joint.imbalance < 2e-3
    np.testing.assert_allclose(joint.displacement[0], twin.displacement[0], atol=2e-4 * np.ptp(twin.displacement[0]))


@pytest.mark.exact
def test_steady_sliding_of_a_friction_joint():
    start = steady_start(joined(5.0), Hard(), constant(0.4), [0.0])
    assert start.displacement[0] == pytest.approx(0.4 * 5.0 / 100.0) and start.normal[0] == 5.0
    assert start.friction[0] == pytest.approx(2.0)

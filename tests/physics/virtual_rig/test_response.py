"""What sensors write of a motion, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import Element, Polynomial
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Start
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Bench, Responder, Run, respond
from pipeline.physics.virtual_rig.sensor import (
    ACCELERATION,
    DISPLACEMENT,
    ELEMENT_FORCE,
    FRICTION_FORCE,
    INPUT_FORCE,
    JOINT_FORCE,
    NORMAL_FORCE,
    VELOCITY,
    Sensor,
    measurand,
)
from tests.physics.lumps import belt, lumps

STEP = 1e-4


def sprung(*channels, step=STEP):
    """1 kg on 100 N/m and 0.4 N s/m."""
    return Bench(lumps([1.0], [[1.0]], [100.0], [0.4]), Hard(), constant(0.0), step, channels)


def seen(quantity, source="sensor_0", **options):
    return Sensor("seen", measurand(quantity, "quantity"), source, **options)


def swing(rate=100.0, amplitude=0.01):
    return Run("swing", 2.0, rate, start=Start(np.array([amplitude]), np.zeros(1)))


def free_decay(time, amplitude=0.01):
    """x, x', x'' of the sprung mass let go."""
    root = -0.2 + 1j * np.sqrt(100 - 0.04)
    swinging = amplitude * (1 + 1j * root.real / root.imag) * np.exp(root * time)
    return [np.real(root**k * swinging) for k in range(3)]


@pytest.mark.exact
@pytest.mark.parametrize("k, quantity", [(0, "displacement"), (1, "velocity"), (2, "acceleration")])
def test_motions_at_the_rate_of_the_run(k, quantity):
    run = swing()
    shown_ = respond(sprung(seen(quantity)), run)["seen"]
    exact = free_decay(run.time)[k]
    assert len(shown_) == 201
    np.testing.assert_allclose(shown_, exact, atol=2e-5 * abs(exact).max())


@pytest.mark.exact
def test_what_is_measured_at_long_steps_is_interpolated_to_fourth_order():
    """The linear part of a motion is exact at any step: what stays is that of the cubics between the steps."""
    errors = []
    for halvings in (-5, -4):       # a fourth and a seventh of a sample, 25 and 44 a period
        found = Responder(sprung(seen("displacement"), step=1e-3), halvings=halvings).measured(swing(10.0))
        (values, _), = found.parts
        assert found.step <= 1e-3 and len(values) == round(2 / found.step) + 1
        errors.append(abs(values - free_decay(found.step * np.arange(len(values)))[0]).max() / 0.01)
    assert errors[1] < 2e-4 and errors[0] == pytest.approx((7 / 4)**4 * errors[1], rel=0.1)


@pytest.mark.exact
def test_joint_force_and_input_at_any_rate():
    run = replace(swing(333.0), inputs={"input_0": 3.0})
    found = respond(sprung(Sensor("force", JOINT_FORCE, "joint_0"), Sensor("in", INPUT_FORCE, "input_0"),
                           Sensor("a", ACCELERATION, "sensor_0")), run)
    np.testing.assert_allclose(found["a"], found["in"] - found["force"], atol=2e-5)
    np.testing.assert_array_equal(found["in"], 3.0)


@pytest.mark.exact
def test_contact_forces_are_not_late_by_half_a_step():
    """A mass pressed by a ramp onto a penalty contact, 10 steps a sample: N is that of the closure at the instant."""
    time = np.linspace(0, 0.5, 51)
    bench = Bench(belt(speed=5.0), Penalty(1e4, 50.0), constant(0.3), 1e-3,
                  (Sensor("n", NORMAL_FORCE, "contact"), Sensor("t", FRICTION_FORCE, "contact"),
                   Sensor("y", DISPLACEMENT, "sensor_1"), Sensor("v", VELOCITY, "sensor_1")))
    run = Run("ramp", 0.5, 100.0, {"input_1": -100 * time}, start=Start(np.array([0, -1e-5]), np.zeros(2)))
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        found = respond(replace(bench, step=step), run)
        law = -1e4 * found["y"] - 50.0 * found["v"]
        errors.append(abs(found["n"][2:-1] - law[2:-1]).max())
        np.testing.assert_allclose(found["t"][2:], 0.3 * found["n"][2:], rtol=1e-6)
    assert errors[-1] < 1e-3 * 50 and errors[0] / errors[-1] > 10


def staircase_response(time, force, instants):
    """x, x' of the sprung mass at ``instants`` under steps of ``force``: each step adds that of a constant force."""
    shown = np.zeros((2, len(instants)))
    for begin, jump in zip(time, np.diff(force, prepend=0.0), strict=True):
        since = np.maximum(instants - begin, 0.0)
        x, v, _ = free_decay(since, -jump / 100)
        shown += np.where(instants >= begin, [jump / 100 + x, v], 0.0)
    return shown


@pytest.mark.exact
@pytest.mark.parametrize("step", [1.0, 1e-3])
def test_a_held_input_is_a_staircase(step):
    """15 samples a period of the force, whatever the step."""
    run = Run("held", 6.0, 23.87, held=("input_0",))
    run = replace(run, duration=(run.samples - 1) / run.sample_rate)
    force = 2 * np.sin(2 * np.pi / 15 * np.arange(run.samples) + 0.4)
    bench = sprung(seen("displacement"), Sensor("v", VELOCITY, "sensor_0"), Sensor("in", INPUT_FORCE, "input_0"),
                   step=step)
    found = respond(bench, replace(run, inputs={"input_0": force}))
    x, v = staircase_response(run.time, force, run.time)
    np.testing.assert_allclose(found["seen"], x, rtol=0, atol=1e-11 * abs(x).max())
    np.testing.assert_allclose(found["v"], v, rtol=0, atol=1e-11 * abs(v).max())
    np.testing.assert_array_equal(found["in"], force)


def test_conditions_stand_in_for_inputs_and_drive():
    bench = Bench(belt(), Hard(), constant(0.3), 1e-3, (Sensor("x", DISPLACEMENT, "sensor_0"),
                                                        Sensor("t", FRICTION_FORCE, "contact")), settled=True)
    found = respond(bench, Run("pressed", 0.2, 100.0, conditions={"input_1": -10.0, "speed": -0.4}))
    np.testing.assert_allclose(found["x"], -0.3 * 10 / 100, rtol=1e-6)
    np.testing.assert_allclose(found["t"], -3.0, rtol=1e-9)


def test_force_of_an_element():
    bench = sprung(Sensor("f", ELEMENT_FORCE, "spring"), Sensor("x", DISPLACEMENT, "sensor_0"))
    bench = bench.with_elements(Element("spring", np.ones(1), Polynomial(cubic=1e5)))
    found = respond(bench, swing())
    np.testing.assert_allclose(found["f"], 1e5 * found["x"] ** 3, rtol=1e-9)


@pytest.mark.exact
def test_inputs_and_doublets_by_name():
    bench = Bench(lumps([1.0, 2.0], [[1, 0], [1, -1]], [100.0, 50.0], [3.0, 4.0]), Hard(), constant(0.0), STEP, (),
                  doublets={"pair": (0, 1)})
    row, stiffness, damping = bench.input("input_1")
    assert list(row) == [0, 1] and (stiffness, damping) == pytest.approx((50.0, 4.0), rel=1e-12)
    mass, stiffness, pair = bench.doublet("pair")
    assert (list(mass), pair) == ([1, 2], [0, 1]) and stiffness == pytest.approx([150.0, 50.0], rel=1e-12)
    with pytest.raises(ConfigError, match="pair"):
        bench.doublet("other")


@pytest.mark.exact
def test_rotation_is_that_of_the_run():
    """x'' + 2 n W y' + k x = 0 and so on: the blow of a run at W turns round at n W, whatever the model's speed."""
    model = replace(lumps([1.0, 1.0], np.eye(2), [100.0, 100.0], speed=9.0), gyroscopic=np.array([[0, 2.0], [-2.0, 0]]))
    bench = Bench(model, Hard(), constant(0.0), STEP, (seen("displacement"),))
    run = Run("turning", 1.0, 100.0, drive=0.7, start=Start(np.zeros(2), np.array([0.1, 0.0])))
    root = np.sqrt(100 + 0.7**2)
    exact = 0.1 * np.cos(0.7 * run.time) * np.sin(root * run.time) / root
    np.testing.assert_allclose(respond(bench, run)["seen"], exact, atol=1e-8)


@pytest.mark.exact
def test_a_recorded_ramp_turns_the_motion_by_its_own_course():
    """Against SciPy, simulated and in the equation of motion, which the first speed alone does not close."""
    gyro = np.array([[0, 2.0], [-2.0, 0]])
    bench = Bench(replace(lumps([1.0, 1.0], np.eye(2), [100.0, 100.0]), gyroscopic=gyro), Hard(), constant(0.0), 1e-3,
                  (seen("displacement"), Sensor("other", DISPLACEMENT, "sensor_1")))
    run = Run("ramp", 3.0, 100.0, start=Start(np.zeros(2), np.array([0.1, 0.0])))
    run = replace(run, drive=0.5 + 2 * run.time)
    truth = solve_ivp(lambda t, s: [*s[2:], *(-(0.5 + 2 * t) * gyro @ s[2:] - 100 * s[:2])], (0, 3), [0, 0, 0.1, 0],
                      "DOP853", run.time, rtol=1e-11, atol=1e-14).y
    found = respond(bench, run)
    both = np.array([found["seen"], found["other"]])
    assert abs(both - truth[:2]).max() < 1e-4 * abs(truth[:2]).max()
    measured = {"seen": truth[0], "other": truth[1]}
    left = equation_residual(bench, run, measured)[:, 2:-2]
    first = equation_residual(bench, replace(run, drive=0.5), measured)[:, 2:-2]
    assert abs(left).max() < 0.03 * abs(first).max(), "differences over samples 1/100 s apart"


@pytest.mark.parametrize("channel, said", [
    (seen("displacement", "nobody"), "sensor_0"), (seen("joint_force", "nobody"), "joint_0"),
    (seen("normal_force", "pads"), "contact group"), (seen("element_force"), "element"),
    (seen("input", "x"), "input_0")])
def test_unknown_sources_are_refused(channel, said):
    with pytest.raises(ConfigError, match=said):
        respond(sprung(channel), swing())


def test_impossible_channels_and_runs_are_refused():
    for make, said in ((lambda: seen("voltage"), "quantity"), (lambda: seen("displacement", delay=-1.0), "delay >= 0"),
                       (lambda: Run("none", 0.0, 10.0), "one interval")):
        with pytest.raises(ConfigError, match=said):
            make()
    with pytest.raises(ConfigError, match="201 samples"):
        respond(sprung(seen("displacement")), replace(swing(), inputs={"input_0": np.zeros(7)}))
    with pytest.raises(ConfigError, match="input_0"):
        respond(sprung(seen("displacement")), replace(swing(), inputs={"hammer": 1.0}))


def test_a_cut_run_is_the_begin_of_the_whole():
    whole = replace(swing(), inputs={"input_0": np.sin(np.arange(201))})
    found, cut = (respond(sprung(seen("displacement")), one)["seen"] for one in (whole, whole.until(40)))
    np.testing.assert_allclose(cut, found[:40], rtol=0, atol=1e-15)

"""Nonlinear elements in motion against closed forms, orders and the energy balance."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipk

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import (
    BoucWen,
    Dry,
    Element,
    Gap,
    Maxwell,
    Polynomial,
    Power,
    Sliders,
    Softening,
    Wave,
    Waviness,
    bears,
    iwan,
)
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import Hard, History, Penalty, Start, simulate
from tests.physics.lumps import belt, lumps, random_structure


def with_elements(model, *laws, row=None):
    row = np.eye(model.size)[0] if row is None else np.asarray(row, float)
    return replace(model, elements=tuple(Element(f"element_{k}", row, law) for k, law in enumerate(laws)))


def at(place, speed=0.0):
    return Start(np.atleast_1d(np.asarray(place, float)), np.atleast_1d(np.asarray(speed, float)))


def order(errors):
    return np.log2(np.divide(errors[:-1], errors[1:]))


def duffing_period(mass, stiffness, cubic, amplitude):
    """T = 4 K(m) / w, w^2 = (k + k3 A^2) / mass, m = k3 A^2 / (2 (k + k3 A^2)); Abramowitz & Stegun 16."""
    hard = stiffness + cubic * amplitude**2
    return 4 * ellipk(cubic * amplitude**2 / (2 * hard)) / np.sqrt(hard / mass)


@pytest.mark.exact
def test_duffing_period_and_order_two():
    """After one exact period the mass is back where it was let go."""
    mass, stiffness, cubic, amplitude = 2.0, 800.0, 4e6, 0.02
    period = duffing_period(mass, stiffness, cubic, amplitude)
    model = with_elements(lumps([mass], [[1.0]], [stiffness]), Polynomial(cubic=cubic))
    errors = []
    for steps in (200, 400, 800):
        end = simulate(model, Hard(), step=period / steps, duration=period, start=at(amplitude)).end
        errors.append(abs(end.velocity[0]))
    np.testing.assert_allclose(order(errors), 2, atol=0.1)
    assert errors[-1] < 2e-3 * amplitude * 2 * np.pi / period
    fine = simulate(model, Hard(), step=1e-5, duration=3 * period, start=at(amplitude))
    falls = np.flatnonzero((fine.displacement[0, :-1] > 0) & (fine.displacement[0, 1:] <= 0))
    before, after = fine.displacement[0, falls], fine.displacement[0, falls + 1]
    crossing = fine.time[falls] + 1e-5 * before / (before - after)
    np.testing.assert_allclose(np.diff(crossing), period, rtol=2e-6)


@pytest.mark.exact
@pytest.mark.parametrize("exponent", [2.0, 3.0])
def test_power_damping_of_a_free_mass(exponent):
    """m v' = -c |v|^(p - 1) v: v^(1 - p) = v0^(1 - p) + (p - 1) c t / m."""
    mass, drag, speed = 2.0, 3.0, 4.0
    model = with_elements(lumps([mass]), Power(drag, exponent))
    motions = [simulate(model, Hard(), step=0.5 / n, duration=0.5, start=at(0, speed)) for n in (50, 100, 200)]
    exact = (speed ** (1 - exponent) + (exponent - 1) * drag * motions[0].time / mass) ** (1 / (1 - exponent))
    errors = [abs(m.velocity[0, ::k] - exact).max() for m, k in zip(motions, (1, 2, 4), strict=True)]
    np.testing.assert_allclose(order(errors), 2, atol=0.1)
    assert errors[-1] < 1e-3 * speed


@pytest.mark.exact
def test_quadratic_damping_takes_the_same_share_off_each_turn():
    """Half a swing of m x'' + c x'|x'| + k x = 0: (1 + a A) exp(-a A) is equal at both ends, a = 2 c / m, A2 < 0."""
    mass, drag, amplitude = 1.0, 0.8, 0.4
    model = with_elements(lumps([mass], [[1.0]], [100.0]), Power(drag, 2.0))
    motion = simulate(model, Hard(), step=1e-4, duration=0.4, start=at(amplitude))
    other, a = -motion.displacement[0].min(), 2 * drag / mass
    assert (1 - a * other) * np.exp(a * other) == pytest.approx((1 + a * amplitude) * np.exp(-a * amplitude), rel=1e-5)
    assert other < 0.9 * amplitude


@pytest.mark.exact
def test_free_flight_through_backlash_and_time_in_the_stop():
    """A free mass between elastic stops: flight 2 g / v, half a period pi sqrt(m / k) in each stop."""
    mass, stop, gap, speed = 2.0, 8e4, 0.01, 1.0
    model = with_elements(lumps([mass]), Gap(stop=stop, lower=gap, upper=gap))
    motion = simulate(model, Hard(), step=1e-5, duration=0.2, start=at(0.0, speed))
    inside = abs(motion.displacement[0]) < gap
    np.testing.assert_allclose(abs(motion.velocity[0, inside]), speed, rtol=1e-4)
    turns = motion.time[np.flatnonzero(np.diff(inside.astype(int)))]
    np.testing.assert_allclose(np.diff(turns)[::2], np.pi * np.sqrt(mass / stop), atol=2e-5)
    np.testing.assert_allclose(np.diff(turns)[1::2], 2 * gap / speed, atol=2e-5)


@pytest.mark.exact
def test_backlash_in_a_joint_leaves_it_free_within_the_gap():
    model = with_elements(lumps([1.0], [[1.0]], [5e3]), Gap(inner=-5e3, lower=2e-3, upper=2e-3))
    motion = simulate(model, Hard(), step=1e-5, duration=0.1, start=at(0.0, 0.05))
    first = motion.time < 2e-3 / 0.05 - 1e-4
    np.testing.assert_allclose(motion.velocity[0, first], 0.05, rtol=1e-9)
    assert motion.displacement[0].max() == pytest.approx(2e-3 + 0.05 / np.sqrt(5e3), rel=1e-4)


@pytest.mark.exact
def test_dry_friction_stops_a_mass_after_its_way():
    """From v the mass slides m v^2 / (2 F), less in falling direction; the elastic way is F / k."""
    model = with_elements(lumps([2.0]), Dry(2e6, 4.0, 8.0))
    for speed, force in ((0.1, 4.0), (-0.1, 8.0)):
        motion = simulate(model, Hard(), step=2e-5, duration=0.2, start=at(0.0, speed))
        assert abs(motion.displacement[0]).max() == pytest.approx(0.1**2 / force, abs=2 * force / 2e6)
        assert abs(motion.velocity[0, -1]) < 0.05 * abs(speed)


@pytest.mark.exact
def test_runout_of_a_driven_spring_moves_as_its_transfer_function_says():
    """k + i c w over k - m w^2 + i c w, at an order of a drive that turns steadily."""
    mass, stiffness, damping, order_, speed = 1.0, 400.0, 8.0, 3.0, 5.0
    model = with_elements(lumps([mass], [[1.0]], [stiffness], [damping], speed=speed),
                          Wave(stiffness, damping, 1e-3, order_, phase=0.7))
    motion = simulate(model, Hard(), step=1e-3, duration=8.0)
    w, late = order_ * speed, motion.time > 5.0
    gain = (stiffness + 1j * damping * w) / (stiffness - mass * w**2 + 1j * damping * w)
    exact = np.real(gain * 1e-3 * np.exp(1j * (w * motion.time[late] - 0.7)))
    np.testing.assert_allclose(motion.displacement[0, late], exact, atol=1e-3 * abs(gain) * 1e-3)


@pytest.mark.exact
def test_an_order_follows_the_angle_of_a_drive_that_speeds_up():
    """A free mass under the force a cos(angle), angle = r t^2 / 2, order 1: its momentum is the integral."""
    time = np.linspace(0, 2.0, 20001)
    model = with_elements(lumps([3.0]), Wave(1.0, 0.0, 2.0, 1.0))
    motion = simulate(model, Hard(), step=1e-3, duration=2.0, drive=History(np.array([0.0, 12.0]), 2.0))
    force = 2.0 * np.cos(6.0 * time**2 / 2)
    momentum = np.concatenate(([0.0], np.cumsum((force[1:] + force[:-1]) / 2))) * time[1]
    np.testing.assert_allclose(3.0 * motion.velocity[0], momentum[::10], atol=2e-5)
    assert motion.end.angle == pytest.approx(12.0)


@pytest.mark.exact
def test_softening_lowers_the_frequency_with_time():
    """After many time constants a spring of 100 N/m that lost 19 swings at 9 rad/s."""
    model = with_elements(lumps([1.0], [[1.0]], [100.0]), Softening(19.0, 0.1))
    motion = simulate(model, Hard(), step=1e-3, duration=20.0, start=at(1e-3))
    late = motion.time > 5.0
    crossing = np.flatnonzero(np.diff(np.sign(motion.displacement[0, late])))
    assert np.mean(np.diff(crossing)) * 1e-3 == pytest.approx(np.pi / 9.0, rel=1e-3)


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(4e4, 40.0)])
def test_waviness_carries_a_pressed_mass_along(law):
    """The gap is waviness + x: a mass pressed with 20 N follows -a cos(3 angle), as m w^2 a stays below the load."""
    amplitude, w = 1e-4, 3 * 10.0
    model = lumps([1.0], normal=[[1.0]], tangent=[[0.0]], speed=10.0)
    model = replace(model, contacts=replace(model.contacts, waviness=(Waviness(0, amplitude, 3.0),)))
    rest = 20.0 / 4e4 if isinstance(law, Penalty) else 0.0
    motion = simulate(model, law, constant(0.0), step=1e-4, duration=1.0, inputs=[-20.0], start=at(-rest - amplitude))
    late = motion.time > 0.5
    exact = -amplitude * np.cos(w * motion.time) - rest
    if isinstance(law, Penalty):
        gain = (4e4 + 40j * w) / (4e4 - w**2 + 40j * w)
        exact = -rest - amplitude * np.real(gain * np.exp(1j * w * motion.time))
    np.testing.assert_allclose(motion.displacement[0, late], exact[late], atol=0.01 * amplitude)
    assert motion.imbalance < 0.01


MIXED = (Polynomial(0.0, 1e8, 1e13), Power(20.0, 2.0), iwan(2e6, 3.0, -0.3, elastic=True),
         Maxwell(np.array([2e6, 1e6]), np.array([1e-3, 1e-4])),
         Dry(4e6, 1.0, 2.0, 0.3, 0.01), BoucWen(0.0, 2e6, 1e-6, 1.5, 0.7), Gap(stop=4e6, lower=1e-6, upper=2e-6))


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(2e6, 20.0)])
def test_energy_is_balanced_with_all_elements_and_contacts(law):
    model = random_structure(12, 4e3, contacts=3).at_speed(0.002)
    random = np.random.default_rng(2)
    model = replace(model, elements=tuple(Element(type(e).__name__, random.standard_normal(12), e) for e in MIXED))
    motion = simulate(model, law, constant(0.5), step=1e-6, duration=0.03, record_every=10,
                      inputs=History(np.array([[30.0], [-20.0]] * 5), 0.006))
    assert motion.imbalance < 0.005
    assert abs(motion.element_work).max() > 0.01 * motion.stored.max()
    assert np.all(np.ptp(motion.element_force, axis=1) > 0)
    np.testing.assert_array_equal(motion.status_share.max(axis=0) > 0, True)


@pytest.mark.exact
@pytest.mark.parametrize("laws", [(Polynomial(0.0, 1e6, 1e10), Power(30.0, 2.0)), (BoucWen(0.0, 1e4, 1e-3, 2.0, 0.6),),
                                  (iwan(1e4, 20.0, -0.3, elastic=True),),
                                  (Maxwell(np.full(1, 1e4), np.full(1, 0.01)),)],
                         ids=("smooth", "bouc_wen", "iwan", "maxwell"))
def test_order_with_elements_and_a_closed_contact_is_two(laws):
    """Memory turns round anywhere within a step: the largest error of eight numbers of steps."""
    model = lumps([1.0, 1.0], [[1, 0], [1, 1]], [4e4, 2e4], [1.0, 2.0], [[0, 1.0]], [[1.0, 0]], speed=3.0)
    model = with_elements(model, *laws, row=[1.0, 0.5])

    def end(steps):
        return simulate(model, Penalty(3e4, 2.0), constant(0.3), step=0.05 / steps, duration=0.05,
                        inputs=[0.0, -100.0], start=at([0.0, -3e-3], [0.1, 0.0])).end.displacement

    fine = end(60_000)
    errors = [max(np.linalg.norm(end(n + k) - fine) for k in range(8)) for n in (200, 800, 3200)]
    np.testing.assert_allclose(order(errors) / 2, 2, atol=0.2)


NULL = (Polynomial(), Power(), iwan(0.0, 3.0, elastic=True), Dry(4e4), Dry(), BoucWen(), Gap(),
        Gap(inner=-5.0, lower=0.0, upper=0.0), Softening(), Wave(1e3, 1.0, 0.0, 2.0), Maxwell(np.zeros(2), np.ones(2)))


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(0.5), Penalty(2e6, 20.0)])
@pytest.mark.parametrize("description", ["rigid", "elastic"])
def test_null_elements_change_no_bit(law, description):
    model = random_structure(12, 4e3, contacts=3).at_speed(0.002)
    null = with_elements(model, *NULL, row=np.ones(12))
    flat = Waviness(1, 0.0, 2.0), Waviness(0, 0.0, 0.0, growth=1.0)
    null = replace(null, contacts=replace(null.contacts, waviness=flat))
    friction = constant(0.5, static_factor=1.3, description=description, stiffness=3e5)
    base, same = (simulate(m, law, friction, step=1e-6, duration=0.01, inputs=[30.0]) for m in (model, null))
    for name in ("displacement", "velocity", "gap", "normal_force", "friction_force", "stored", "normal_work"):
        np.testing.assert_array_equal(getattr(same, name), getattr(base, name))


def test_a_run_with_memory_goes_on_where_another_ended():
    model = with_elements(random_structure(8, 2e3).at_speed(2.0), iwan(1e6, 0.5, elastic=True),
                          Wave(1e4, 0, 1e-5, 40.0), Softening(1e5, 1e-3), Maxwell(np.full(1, 1e5), np.full(1, 1e-3)),
                          row=np.ones(8))
    model = replace(model, contacts=replace(model.contacts, wear=1e-2))
    options = {"step": 1e-6, "inputs": [20.0]}
    whole = simulate(model, Penalty(1e6, 10.0), constant(0.4), duration=4e-3, **options)
    half = simulate(model, Penalty(1e6, 10.0), constant(0.4), duration=2e-3, **options)
    rest = simulate(model, Penalty(1e6, 10.0), constant(0.4), duration=2e-3, start=half.end, **options)
    np.testing.assert_allclose(rest.displacement[:, -1], whole.displacement[:, -1], rtol=1e-9)
    np.testing.assert_allclose(rest.element_force[:, -1], whole.element_force[:, -1], rtol=1e-9)
    np.testing.assert_allclose(rest.end.worn, whole.end.worn, rtol=1e-9)
    assert np.all(half.end.worn > 0) and np.all(whole.end.worn > half.end.worn)


def test_elements_follow_their_model_into_other_coordinates():
    model = with_elements(belt(), Polynomial(cubic=1e5), row=[1.0, 2.0])
    turned = model.projected(np.array([[0.0, 1.0], [1.0, 0.0]]))
    np.testing.assert_array_equal(turned.elements[0].row, [2.0, 1.0])
    first, second = (simulate(m, Hard(), constant(0.3), step=1e-3, duration=0.5, inputs=[1.0, -10.0])
                     for m in (model, turned))
    np.testing.assert_allclose(second.displacement, first.displacement, atol=1e-12)


@pytest.mark.parametrize("law", [
    Power, Dry, BoucWen, Gap, Softening, Sliders, Polynomial, Maxwell])
def test_impossible_values_are_refused(law):
    wrong = {Power: {"exponent": 0.5}, Dry: {"stiffness": 1.0, "forward": -1.0}, BoucWen: {"size": 0.0},
             Gap: {"upper": -1e-3}, Softening: {"time": 0.0}, Polynomial: {"cubic": np.nan},
             Sliders: {"stiffness": np.ones(2), "limit": np.ones(3)},
             Maxwell: {"stiffness": -np.ones(1), "time": np.ones(1)}}[law]
    with pytest.raises(ConfigError, match=law.__name__):
        Element("bad", np.ones(1), law(**wrong))


def test_other_laws_and_impossible_joints_are_refused():
    with pytest.raises(ConfigError, match="Polynomial"):
        Element("bad", np.ones(1), "spring")
    with pytest.raises(ConfigError, match="force > 0"):
        iwan(1e6, 0.0)


def test_a_step_too_long_for_an_element_names_it():
    model = with_elements(lumps([1.0], [[1.0]], [100.0]), Polynomial(linear=1e9))
    with pytest.raises(ConfigError, match="element_0.*8 steps"):
        simulate(model, Hard(), step=1e-3, duration=0.1, start=at(1e-3))


@pytest.mark.exact
@pytest.mark.parametrize("law, force", [
    (Polynomial(0.0, 2e4, 1e8), lambda e: 2e4 * e**2 + 1e8 * e**3),
    (Gap(stop=500.0, lower=1e-3, upper=1e-3), lambda e: 500 * (e - 1e-3)),
    (Sliders(np.array([50.0, 80.0]), np.array([0.2, 5.0])), lambda e: 0.2 + 80 * e),
    (Dry(1e4, 2.0, 2.0), lambda e: 0.0), (Maxwell(np.array([1e3]), np.array([0.1])), lambda e: 0.0)])
def test_steady_sliding_with_elements_stands_still(law, force):
    """k x + F(x) = mu N, and a motion that starts there stays there."""
    model = with_elements(belt(), law)
    start = steady_start(model, Hard(), constant(0.3), [0.0, -10.0])
    x = start.displacement[0]
    assert 100 * x + force(x) == pytest.approx(3.0, rel=1e-9)
    motion = simulate(model, Hard(), constant(0.3), step=1e-3, duration=0.5, inputs=[0.0, -10.0], start=start)
    np.testing.assert_allclose(motion.displacement[0], x, rtol=1e-6)


@pytest.mark.exact
def test_steady_sliding_on_a_wavy_surface_starts_on_it():
    model = belt()
    model = replace(model, contacts=replace(model.contacts, waviness=(Waviness(0, 1e-4, 2.0, 0.5),)))
    start = steady_start(model, Hard(), constant(0.3), [0.0, -10.0])
    assert start.displacement[1] == pytest.approx(-1e-4 * np.cos(0.5))


@pytest.mark.parametrize("law, bearing", [
    (Polynomial(cubic=1.0), True), (Polynomial(), False), (Power(3.0), False), (Dry(1e3, 2.0, 2.0), False),
    (Gap(inner=-50.0, lower=1e-3, upper=1e-3), True), (Gap(inner=-50.0, lower=0.0, upper=0.0), False),
    (Maxwell([5.0], [1.0]), False), (Maxwell([5.0], [1.0], -2.0), True), (Softening(5.0, 1.0), False)])
def test_elements_that_bear_load_at_rest(law, bearing):
    assert bears(Element("one", np.ones(1), law)) is bearing

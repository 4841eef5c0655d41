"""Force laws of elements as functions of prescribed ways, against their closed forms."""

from itertools import pairwise

import numpy as np
import pytest

from pipeline.physics.time_stepping.contact_solver import SOLVED
from pipeline.physics.time_stepping.element_forces import (
    LOCAL_TOLERANCE,
    TOO_STIFF,
    ElementStep,
    element_force,
    laws_of,
    solve_elements,
    wave,
)
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
    element_kernel,
    iwan,
)

REST = (0.0, 0.0, 0.0)


def compiled(*laws, own=None):
    count = len(laws)
    own = np.zeros((2, count, count)) if own is None else np.asarray(own, float)
    return element_kernel(tuple(Element(f"law_{k}", np.ones(1), law) for k, law in enumerate(laws)), (),
                          rows=np.zeros((2 * count, 2, 1)), response=own, to_contacts=np.zeros((4, 0, count)),
                          to_elements=np.zeros((2, count, 2, 0)))


def element_step(pressed, force):
    """ElementStep of elements without memory, from rest at 0."""
    return ElementStep(np.array(pressed), pressed, np.zeros_like(pressed), np.zeros(0), np.zeros(0), force,
                       np.zeros_like(force), np.zeros_like(pressed))


def drawn(law, way, rate=None, instants=None):
    """Force at each elongation of ``way``, from rest at 0."""
    kernel, force, begin = compiled(law), [], 0.0
    memory, rate = np.zeros(kernel.first[-1]), np.zeros_like(way) if rate is None else rate
    for k, place in enumerate(way):
        after = memory.copy()
        instant = REST if instants is None else instants[k]
        force.append(element_force(kernel, 0, place, rate[k], begin, memory, after, instant)[0])
        begin, memory = place, after
    return np.array(force)


def to(*turning, points=2000):
    """A way that runs linearly from 0 over the ``turning`` points."""
    return np.concatenate([np.linspace(a, b, points)[1:] for a, b in pairwise((0.0, *turning))])


LAWS = [Polynomial(3.0, -4.0, 5.0), Power(3.0, 2.0), Power(2.0, 1.0), Power(2.0, 3.0),
        Sliders(np.array([5.0, 2.0]), np.array([0.1, 0.4]), -1.0), Dry(50.0, 0.3, 0.5, 0.4, 0.2),
        BoucWen(1.0, 4.0, 0.7, 1.5, 0.7), Gap(9.0, -2.0, 0.05, 0.02), Softening(3.0, 2.0),
        Wave(2.0, 0.1, 0.3, 2.0, 1.0), Maxwell(np.array([5.0, 2.0]), np.array([0.3, 4.0]), -1.0)]
NULLS = [Polynomial(), Power(), iwan(0.0, 5.0, elastic=True), Dry(1e3), BoucWen(), Gap(),
         Gap(inner=-5.0, lower=0.0, upper=0.0), Softening(), Wave(), Wave(2.0, 3.0, 0.0, 1.0),
         Maxwell(np.zeros(2), np.ones(2))]


@pytest.mark.exact
@pytest.mark.parametrize("law", NULLS, ids=str)
def test_null_values_give_no_force_at_all(law):
    way = np.sin(np.linspace(0, 9, 50))
    np.testing.assert_array_equal(drawn(law, way, 3 * way, [(t, t, 1.0) for t in range(50)]), 0.0)


@pytest.mark.exact
@pytest.mark.parametrize("law", LAWS, ids=str)
def test_slopes_are_the_derivatives_of_the_force(law):
    kernel, instant, h = compiled(law), (0.7, 0.3, 2.0), 1e-7
    memory = np.full(kernel.first[-1], 0.03)
    for place, rate in ((0.013, 0.4), (-0.07, -0.9), (0.4, 0.2)):
        def force(de, dv, place=place, rate=rate):
            return element_force(kernel, 0, place + de, rate + dv, 0.01, memory, memory.copy(), instant)

        _, slope, drag = force(0, 0)
        rough = isinstance(law, BoucWen)        # its slope is that of the exact way, not of Runge-Kutta steps
        assert slope == pytest.approx((force(h, 0)[0] - force(-h, 0)[0]) / (2 * h), rel=2e-3 if rough else 1e-6,
                                      abs=1e-6)
        if not isinstance(law, Dry):      # its limit is lagged over the speed, within the iteration of a step
            assert drag == pytest.approx((force(0, h)[0] - force(0, -h)[0]) / (2 * h), rel=1e-5, abs=1e-6)


@pytest.mark.exact
@pytest.mark.parametrize("exponent", [0.0, -0.4, -0.7])
def test_iwan_backbone_masing_rule_and_loop_area(exponent):
    """F = K (e - e^(x + 2) / ((x + 2) phi^(x + 1))); branches are it twice as large; loss 4 K (x + 1) A^(x + 3) /
    ((x + 2) (x + 3) phi^(x + 1)) (Segalman 2005)."""
    stiffness, slip, amplitude = 1e6, 20.0, 1.5e-5
    largest = (exponent + 2) / (exponent + 1) * slip / stiffness

    def backbone(e):
        return stiffness * (e - e ** (exponent + 2) / ((exponent + 2) * largest ** (exponent + 1)))

    way = to(amplitude, -amplitude, amplitude)
    force = drawn(iwan(stiffness, slip, exponent, count=200), way)
    first, down = np.split(np.arange(2 * 1999), 2)
    np.testing.assert_allclose(force[first], backbone(way[first]), atol=2e-4 * slip)
    masing = backbone(amplitude) - 2 * backbone((amplitude - way[down]) / 2)
    np.testing.assert_allclose(force[down], masing, atol=4e-4 * slip)
    loop = np.r_[first[-1], range(first[-1] + 1, len(way))]
    lost = np.trapezoid(force[loop], way[loop])
    exact = 4 * stiffness * (exponent + 1) * amplitude ** (exponent + 3) / (
        (exponent + 2) * (exponent + 3) * largest ** (exponent + 1))
    assert lost == pytest.approx(exact, rel=3e-3)
    assert drawn(iwan(stiffness, slip, exponent), to(2 * largest))[-1] == pytest.approx(slip, rel=1e-12)


@pytest.mark.exact
def test_bouc_wen_with_exponent_one_approaches_its_limit_exponentially():
    """dz = (1 - z / d) de; from there back with shape s: dz = (1 - (2 s - 1) z / d) de while z > 0."""
    size, shape = 0.1, 0.8
    out, back = np.linspace(0, 0.3, 300)[1:], np.linspace(0.3, 0.25, 200)[1:]
    force = drawn(BoucWen(0.0, 7.0, size, 1.0, shape), np.r_[out, back])
    np.testing.assert_allclose(force[:299], 7 * size * (1 - np.exp(-out / size)), rtol=1e-9)
    top, rate = size * (1 - np.exp(-3.0)), (2 * shape - 1) / size
    np.testing.assert_allclose(force[299:], 7 * (1 / rate + (top - 1 / rate) * np.exp(rate * (0.3 - back))), rtol=1e-8)


@pytest.mark.exact
def test_bouc_wen_reaches_its_limit_in_one_long_step():
    for exponent in (1.0, 2.0):
        assert drawn(BoucWen(0.0, 7.0, 0.1, exponent, 0.5), np.array([1e3]))[0] == pytest.approx(0.7, rel=1e-9)


def test_bouc_wen_takes_energy_in_every_closed_loop():
    for exponent in (1.0, 2.0, 4.0):
        way = to(0.3, -0.3, 0.3)
        force = drawn(BoucWen(0.0, 7.0, 0.1, exponent, 0.5), way)
        assert np.trapezoid(force[1998:], way[1998:]) > 0.1 * 4 * 0.3 * 0.7


@pytest.mark.exact
def test_dry_friction_of_both_directions_and_its_fall_with_speed():
    law, way = Dry(1e6, 3.0, 5.0, 0.5, 0.1), to(1.0, -1.0)
    rate = np.r_[np.full(1999, 0.1), np.full(1999, -0.3)]
    force = drawn(law, way, rate)
    assert force[1000] == pytest.approx(3 * (1 + 0.5 * np.exp(-1)), rel=1e-12)
    assert force[-1] == pytest.approx(-5 * (1 + 0.5 * np.exp(-3)), rel=1e-12)


@pytest.mark.exact
def test_gap_polynomial_power_and_softening():
    way = np.array([-0.3, -0.1, 0.0, 0.15, 0.5])
    np.testing.assert_allclose(drawn(Gap(stop=10.0, lower=0.2, upper=0.3), way), [-1.0, 0, 0, 0, 2.0], atol=1e-15)
    np.testing.assert_allclose(drawn(Gap(inner=-10.0, lower=0.2, upper=0.3), way), [2.0, 1.0, 0, -1.5, -3.0])
    np.testing.assert_allclose(drawn(Polynomial(2.0, 3.0, 4.0), way), 2 * way + 3 * way**2 + 4 * way**3)
    np.testing.assert_allclose(drawn(Power(2.0, 2.0), 0 * way, way), 2 * abs(way) * way)
    instants = [(t, 0.0, 0.0) for t in (0.0, 1.0, 2.0, 3.0, 9.0)]
    np.testing.assert_allclose(drawn(Softening(5.0, 2.0), way, None, instants),
                               -5 * (1 - np.exp(-np.array([0, 1, 2, 3, 9]) / 2)) * way, atol=1e-15)


@pytest.mark.exact
def test_maxwell_branches_stretch_and_relax():
    """Stretched evenly at v, then held: k tau v (1 - exp(-t / tau)), then its decay, in steps of any length."""
    law, rate = Maxwell(np.array([5.0, 2.0]), np.array([0.3, 4.0]), -1.0), 0.7
    time = np.array([0.0, 0.01, 0.5, 0.6, 2.0, 3.0, 3.1, 7.0])
    way = rate * np.minimum(time, 2.0)
    stretched = sum(k * t * rate * -np.expm1(-np.minimum(time, 2.0) / t) * np.exp(-np.maximum(time - 2.0, 0) / t)
                    for k, t in ((5.0, 0.3), (2.0, 4.0)))
    np.testing.assert_allclose(drawn(law, way, None, [(t, 0.0, 0.0) for t in time]), stretched - way, rtol=1e-12)


@pytest.mark.exact
def test_wave_of_an_order_and_its_rate():
    place, speed = wave(0.2, 3.0, 1.5, 0.4, (0.1, 0.7, 5.0))
    assert place == pytest.approx(0.2 * np.cos(2.1 + 0.3 * np.pi - 0.4))
    after = wave(0.2, 3.0, 1.5, 0.4, (0.1 + 1e-7, 0.7 + 5e-7, 5.0))[0]
    assert speed == pytest.approx((after - place) / 1e-7, rel=1e-5)


@pytest.mark.exact
def test_coupled_elements_are_solved_together():
    """Two springs in a row on one response: (1 - R K) F = K free."""
    own = -np.array([[[0.01, 0.004], [0.004, 0.02]], [[0, 0], [0, 0]]])
    kernel, force = compiled(Polynomial(3.0), Polynomial(5.0), own=own), np.zeros(2)
    free = np.array([[0.5, -0.2], [0.0, 0.0]])
    code, _ = solve_elements(laws_of(kernel), element_step(free, force), REST)
    stiffness = np.diag([3.0, 5.0])
    assert code == SOLVED
    exact = np.linalg.solve(np.eye(2) - stiffness @ own[0], stiffness @ free[0])
    np.testing.assert_allclose(force, exact, rtol=1e3 * LOCAL_TOLERANCE)


def test_forces_that_nearly_cancel_settle_within_their_rounding():
    """A joint of 320 N/m whose slip of 45 N takes away some 1e-6 of what its sliders and its spring carry."""
    kernel = compiled(iwan(320.0, 45.0, elastic=True), own=-np.array([[[3e-4]], [[0.0]]]))
    memory, begin, force = np.zeros(kernel.first[-1]), np.zeros((2, 1)), np.zeros(1)
    for place in 1e-3 * np.sin(np.arange(3000) / 40) + 1e-6 * np.random.default_rng(0).standard_normal(3000):
        free, after = np.array([[place], [0.0]]), memory.copy()
        step = ElementStep(free, free, begin, memory, after, force, np.zeros(1), np.zeros((2, 1)))
        assert solve_elements(laws_of(kernel), step, REST)[0] == SOLVED
        begin, memory = free + kernel.response[:, 0] * force, after


def test_an_element_too_stiff_for_the_step_is_told():
    kernel = compiled(Polynomial(3.0), own=-np.array([[[0.05]], [[0.0]]]))
    code, element = solve_elements(laws_of(kernel), element_step(np.ones((2, 1)), np.zeros(1)), REST)
    assert (code, element) == (TOO_STIFF, 0)

"""Order tracking on ramps whose orders are known."""

import numpy as np
import pytest

from pipeline.physics.signals.orders.order_tracking import (
    campbell,
    over_speed,
    shaft_of,
    shaft_of_pulses,
    smooth,
    track,
)
from pipeline.physics.signals.orders.outstanding_orders import strongest
from tests.physics.signals.orders.ramp import END, FIRST, LAST, RATE, SLOW, TURNS, T, order, ramp, tracked


@pytest.mark.exact
def test_the_angle_of_a_ramp_is_exact():
    turning = ramp()
    assert turning.turns[-1] == pytest.approx(15.0 * END, rel=1e-12) and turning.speed[0] == FIRST
    backwards = shaft_of(-SLOW, 20.0, 0.0)
    np.testing.assert_array_equal(backwards.turns, turning.turns)


@pytest.mark.exact
@pytest.mark.parametrize("number", [1.0, 2.0, 2.5, 7.06, 12.0, 18.9])
def test_an_order_of_a_ramp_has_its_amplitude_and_place(number):
    """Amplitude within 1 % in every block, order within a line, over a speed that falls to a fifth."""
    orders = tracked(order(number, 3.0))
    found = strongest(orders, 6)
    assert found.order[0] == pytest.approx(number, abs=0.02) and orders.order[1] == 1 / 8 and found.sure.all()
    np.testing.assert_allclose(found.amplitude[0], 3.0, rtol=0.01)
    assert orders.speed[-1] < orders.speed[0] / 4
    np.testing.assert_allclose(orders.speed, FIRST + (LAST - FIRST) * orders.time / END, rtol=5e-3)


def test_blocks_with_missing_samples_or_a_slow_shaft_are_left_out():
    gapped = order(2.0)
    gapped[(T > 4.0) & (T < 5.0)] = np.nan
    orders = tracked(gapped)
    half = 8 / 2 / (orders.speed / (2 * np.pi))
    assert not np.any((orders.time + half > 4.05) & (orders.time - half < 4.95))
    assert strongest(orders, 1).amplitude[0] == pytest.approx(np.ones(len(orders.time)), rel=0.01)
    fast = track(smooth(order(2.0), RATE, 0.0, 500.0), ramp(), 20.0, 8, 2 * np.pi * 15.0)
    assert fast.time.max() < END / 2
    assert track(smooth(order(2.0)[:800], RATE, 0.0, 500.0), ramp(), 20.0, 8, LAST) is None
    speed = SLOW.copy()
    speed[100:110] = np.nan
    assert shaft_of(speed, 20.0, 0.0).turns[-1] == pytest.approx(15.0 * END, rel=1e-9)


@pytest.mark.exact
def test_a_campbell_diagram_shows_orders_as_lines_through_its_origin():
    edges = np.linspace(LAST, FIRST, 21)
    frequency, amplitude, count = campbell(smooth(order(8.0, 2.0), RATE, 0.0, 500.0), ramp(), 500.0, 0.25, edges)
    middle = (edges[1:] + edges[:-1]) / 2
    used = count > 0
    peak = frequency[amplitude.argmax(axis=1)]
    np.testing.assert_allclose(peak[used], 8.0 * middle[used] / (2 * np.pi), atol=8.0 * np.diff(edges)[0] / 6.28)
    assert frequency[-1] <= 500.0 and frequency[1] == pytest.approx(4.0, rel=0.01)
    tone = campbell(smooth(np.cos(2 * np.pi * 120.0 * T), RATE, 0.0, 500.0), ramp(), 500.0, 0.25, edges)[1]
    np.testing.assert_allclose(tone.max(axis=1)[used], 1.0, rtol=0.01)


@pytest.mark.exact
def test_bins_hold_the_root_mean_square_and_nothing_is_nothing():
    level, count = over_speed(np.array([0.0, 1.0, 1.5, 4.0, 9.0]), np.array([3.0, 1.0, 7.0, 2.0, 5.0]),
                              np.array([1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_allclose(level, [5.0, 0.0, 2.0])
    assert count.tolist() == [2, 0, 1]


@pytest.mark.exact
def test_a_tacho_tells_the_angle_by_its_pulses():
    """Four pulses a revolution, smooth ones with noise: the second order comes back within 1 %."""
    noise = 0.02 * np.random.default_rng(1).standard_normal(len(T))
    tacho = 2.5 + 2.5 * np.tanh(4 * np.sin(2 * np.pi * 4 * TURNS)) + noise
    turning = shaft_of_pulses(tacho, RATE, 0.0, 4)
    np.testing.assert_allclose(turning.turns - turning.turns[0], np.interp(turning.time, T, TURNS) - np.interp(
        turning.time[0], T, TURNS), atol=2e-3)
    inside = slice(2, -2)
    expected = FIRST + (LAST - FIRST) * turning.time / END
    np.testing.assert_allclose(turning.speed[inside], expected[inside], rtol=0.01)
    orders = track(smooth(order(2.0, 3.0), RATE, 0.0, 500.0), turning, 20.0, 8, 0.9 * LAST)
    found = strongest(orders, 6)
    assert found.order[0] == pytest.approx(2.0, abs=0.01)
    np.testing.assert_allclose(found.amplitude[0], 3.0, rtol=0.01)
    assert shaft_of_pulses(np.ones(100), RATE, 0.0, 4) is None and shaft_of_pulses(tacho[:150], RATE, 0.0, 4) is None


def wheel(teeth, missing, lost=()):
    """A tacho of a wheel of ``teeth`` without the last ones, and without the pulses ``lost``, on the ramp."""
    passed = np.floor(teeth * TURNS).astype(int)
    there = (passed % teeth < teeth - missing) & ~np.isin(passed, lost)
    return 5.0 * (there & ((teeth * TURNS) % 1.0 < 0.5))


@pytest.mark.parametrize("teeth, missing, stated, told", [
    (12, 1, 12, "a wheel of 12 teeth of which 1 is missing: the gap is bridged"),
    (12, 2, 12, "a wheel of 12 teeth of which 2 are missing: the gap is bridged"),
    (12, 2, 10, "the gap is bridged, and a revolution has 12 pulses, not 10"),
    (4, 1, 3, "a wheel of 4 teeth of which 1 is missing: the gap is bridged, and a revolution has 4 pulses, not 3")])
def test_missing_teeth_are_bridged_and_told(teeth, missing, stated, told):
    turning = shaft_of_pulses(wheel(teeth, missing), RATE, 0.0, stated)
    assert turning.remark.endswith(told)
    expected = np.interp(turning.time, T, TURNS)
    np.testing.assert_allclose(turning.turns - turning.turns[0], expected - expected[0], atol=5e-3)
    speed = FIRST + (LAST - FIRST) * turning.time / END
    np.testing.assert_allclose(turning.speed[2:-2], speed[2:-2], rtol=0.08)


def test_pulses_that_were_lost_here_and_there_are_counted():
    turning = shaft_of_pulses(wheel(12, 0, (100, 407, 408)), RATE, 0.0, 12)
    assert turning.remark == "3 pulses are missing in 2 gaps, which are bridged"
    expected = np.interp(turning.time, T, TURNS)
    np.testing.assert_allclose(turning.turns - turning.turns[0], expected - expected[0], atol=5e-3)
    assert shaft_of_pulses(wheel(12, 0), RATE, 0.0, 12).remark == ""


def test_pulses_that_come_twice_and_gaps_that_no_wheel_has_are_told():
    assert "gaps come every 12 pulses" in shaft_of_pulses(wheel(12, 1), RATE, 0.0, 7).remark
    steady = shaft_of_pulses(np.insert(wheel(12, 0), np.flatnonzero(np.diff(wheel(12, 0)) > 0)[40] + 3, [0.0, 5.0]),
                             RATE, 0.0, 12)
    assert "come too soon after another" in steady.remark

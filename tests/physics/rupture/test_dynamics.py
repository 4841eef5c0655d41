"""The interface between two plates: waves through it, friction on it, unlike meshes, refusals."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import generalised_rayleigh_speed
from pipeline.physics.rupture.dynamics import OPEN, SLIP, STICK, advance, at_rest, opening, pairing, stable_step
from tests.physics.small_ruptures import SOFT, STIFF, interface, plates


def run(lower, upper, law, duration):
    motion, steps = at_rest(lower, upper, law), int(duration / (0.9 * stable_step(lower, upper))) + 1
    return advance(lower, upper, law, motion, duration / steps, steps), motion


def peak_place(x, values):
    """Place of the largest value, by the parabola through its neighbours."""
    top = int(values.argmax())
    low, high, after = values[top - 1:top + 2].astype(float)
    return x[top] + 0.5 * (low - after) / (low - 2 * high + after) * (x[1] - x[0])


@pytest.mark.exact
def test_below_the_limit_nothing_moves():
    lower, upper = plates()
    law, _ = interface(lower, upper, half_width=-1.0)
    record, motion = run(lower, upper, law, 2e-7)
    assert not record.slip_rate.any() and (record.state == STICK).all()
    assert max(np.abs(motion.lower).max(), np.abs(motion.upper).max()) == 0.0
    np.testing.assert_allclose(record.pressure, 1e6)


@pytest.mark.exact
def test_a_stuck_interface_is_one_body():
    """A pulse in two plates of one solid with friction beyond reach moves as in one plate of both heights."""
    from pipeline.physics.rupture.plate_grid import FIXED, FREE, plate
    from pipeline.physics.rupture.plate_step import rims, step_plate

    lower, upper = plates(length=2e-3, height=1e-3, solids=(SOFT, SOFT))
    law, _ = interface(lower, upper, friction=1e6, half_width=-1.0)
    whole = plate(SOFT, 2e-3, 2e-3, 5e-5, 0.1, [(FREE, FREE)] * 2 + [(FIXED, FIXED)] * 2)
    start = 1e-12 * np.random.default_rng(1).standard_normal((2, whole.rows, whole.columns))
    start[:, [0, -1]] = 0.0
    motion, step = at_rest(lower, upper, law), 0.9 * stable_step(lower, upper)
    motion.lower[0], motion.upper[0] = start[:, :lower.rows], start[:, lower.rows - 1:]
    displacement, velocity = start.copy(), np.zeros_like(start)
    advance(lower, upper, law, motion, step, 40)
    for _ in range(40):
        step_plate(whole, rims(whole, step), displacement, velocity, step, np.zeros((3, 2, whole.columns)))
    split = (displacement[:, :lower.rows], displacement[:, lower.rows - 1:])
    for part, expected in zip((motion.lower, motion.upper), split, strict=True):
        np.testing.assert_allclose(part[0], expected, atol=1e-12 * np.abs(displacement).max())


@pytest.mark.exact
def test_friction_and_contact_hold_at_every_step():
    lower, upper = plates()
    law, x = interface(lower, upper, ratio=0.97)
    record, motion = run(lower, upper, law, 8e-7)
    outside = np.abs(x - x[-1] / 2) > 6.3e-5
    limit = record.pressure[:, outside] * (1 + 1e-5)
    assert (record.pressure >= 0).all() and (np.abs(record.shear[:, outside]) <= limit).all()
    sliding = record.state == SLIP
    strength = record.pressure * np.sign(record.slip_rate)
    there = sliding & outside
    np.testing.assert_allclose(record.shear[there], strength[there], rtol=1e-5)
    assert not record.slip_rate[record.state == STICK].any() and sliding.any()
    assert np.abs(opening(law, motion)).max() < 1e-12 * np.abs(motion.slip).max()


@pytest.mark.exact
def test_frictionless_slip_carries_the_generalised_rayleigh_wave():
    """A disturbance of a frictionless interface travels at the speed of Weertman's equation, to 1 %."""
    lower, upper = plates(2.5e-5, length=16e-3, height=5e-3, damping=0.02)
    law, x = interface(lower, upper, ratio=0.0, friction=0.0)
    law = law._replace(shear=1e6 * np.exp(-(((x - 8e-3) / 2e-4) ** 2)))
    record, _ = run(lower, upper, law, 4e-6)
    times, right = np.searchsorted(record.time, (2e-6, 3.6e-6)), x > 8.5e-3
    places = [peak_place(x[right], record.slip_rate[t][right]) for t in times]
    speed = np.diff(places)[0] / np.diff(record.time[times])[0]
    assert speed == pytest.approx(generalised_rayleigh_speed(STIFF, SOFT), rel=0.01)


@pytest.mark.exact
def test_slip_weakening_lowers_the_strength_along_the_path():
    lower, upper = plates()
    law, x = interface(lower, upper, ratio=0.6, half_width=3e-4, dynamic=0.5, weakening=2e-8)
    record, motion = run(lower, upper, law, 8e-7)
    past = np.flatnonzero((motion.path > 4e-8) & (np.abs(x - x[-1] / 2) > 3.1e-4))
    assert past.size
    sliding = record.state[-1, past] == SLIP
    np.testing.assert_allclose(record.shear[-1, past][sliding], 0.5 * record.pressure[-1, past][sliding], rtol=1e-5)


@pytest.mark.exact
def test_the_memory_follows_a_step_of_pressure_exponentially():
    """ds/dt = (p - s) / T with p = 0: s = p0 exp(-t / T), first order in the step."""
    lower, upper = plates(length=1e-3, height=1e-3)
    law, _ = interface(lower, upper, ratio=0.0, memory_time=1e-7)
    law = law._replace(gap=np.full(law.gap.size, 1e-3))
    step = 0.9 * stable_step(lower, upper)
    motion = at_rest(lower, upper, law)
    record = advance(lower, upper, law, motion, step, 8)
    assert (record.state == OPEN).all()
    np.testing.assert_allclose(motion.memory, 1e6 * np.exp(-8 * step / 1e-7), rtol=8 * (step / 1e-7) ** 2)


def test_solids_pulled_apart_open_and_carry_nothing():
    lower, upper = plates()
    law, x = interface(lower, upper, half_width=-1.0)
    motion = at_rest(lower, upper, law)
    motion.upper[1, 1, 0] = 20.0       # m/s upwards
    record = advance(lower, upper, law, motion, 0.9 * stable_step(lower, upper), 5)
    assert (record.state == OPEN).all() and not record.pressure.any() and not record.shear.any()
    assert (opening(law, motion) > 0).all()


@pytest.mark.exact
def test_unlike_meshes_rupture_alike():
    """Node to segment: 4 : 5 nodes give the slip of matched meshes within 5 % of its largest."""
    matched, unlike = (plates(5e-5, lower, height=2e-3) for lower in (None, 4e-5))
    slips = []
    for lower, upper in (matched, unlike):
        law, x = interface(lower, upper, half_width=2e-4, memory_time=5e-8)
        assert law.slave_above is False or lower.spacing == upper.spacing
        slips.append(np.interp(np.linspace(3e-3, 5e-3, 41), x, run(lower, upper, law, 8e-7)[1].slip))
    np.testing.assert_allclose(slips[1], slips[0], atol=0.05 * slips[0].max())


def test_pairing_finds_segments_and_weights():
    lower, upper = plates(5e-5, 1e-4, length=1e-3, height=1e-3)
    master, weight, above, length = pairing(lower, upper)
    assert above and length.sum() == pytest.approx(1e-3)
    assert weight[:4].tolist() == pytest.approx([0, 0.5, 0, 0.5]) and master[:4].tolist() == [0, 0, 1, 1]
    assert master[-1] == lower.columns - 2 and weight[-1] == pytest.approx(1.0)


def test_a_step_beyond_the_stability_limit_is_refused():
    lower, upper = plates()
    law, _ = interface(lower, upper)
    with pytest.raises(ConfigError, match="time step: expected a step up to"):
        advance(lower, upper, law, at_rest(lower, upper, law), 1.01 * stable_step(lower, upper), 1)


@pytest.mark.exact
def test_turned_by_half_a_turn_the_rupture_is_the_same():
    """Solids exchanged: left and right exchange, slip keeps its sign.

    The pulse that runs with the softer solid's slip relieves its pressure (Weertman, J. Geophys. Res. 85 (1980) 1455).
    """
    slips, pressures = [], []
    for solids in ((SOFT, STIFF), (STIFF, SOFT)):
        lower, upper = plates(solids=solids)
        law, x = interface(lower, upper)
        record, motion = run(lower, upper, law, 1e-6)
        slips.append(motion.slip)
        tip = np.where(x > 4.4e-3, record.slip_rate[-1], 0.0).argmax()
        pressures.append(record.pressure[-1, tip])
    np.testing.assert_allclose(slips[0], slips[1][::-1], atol=1e-12 * slips[0].max())
    assert slips[0].max() > 0.0 and pressures[0] < 0.97e6 < pressures[1]


def test_the_same_run_gives_the_same_bits():
    lower, upper = plates()
    law, _ = interface(lower, upper)
    first, second = (run(lower, upper, law, 3e-7)[0] for _ in range(2))
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))

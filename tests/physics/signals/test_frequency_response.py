"""Frequency responses of a plate of three modes: blows, periodic and random forces, motions alone."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.frf_identification import identify
from pipeline.physics.signals.frequency_response import (
    from_blows,
    from_lasting_forces,
    from_motions,
    of_blows_alone,
)

RATE = 8192.0
FREQUENCY, DAMPING = np.array([310.0, 420.0, 900.0]), np.array([0.004, 0.01, 0.003])
SHAPE = np.array([[1.0, 0.4, -0.7], [0.5, 1.0, 0.6], [-0.3, 0.8, 1.0]])      # mode, point
NATURAL = 2 * np.pi * FREQUENCY
POLE = NATURAL * (-DAMPING + 1j * np.sqrt(1 - DAMPING**2))


def receptance(frequency, driven=(0,)):
    """(point, driven point, f), of unit modal masses."""
    omega = 2 * np.pi * frequency
    modal = 1 / (NATURAL[:, None] ** 2 - omega**2 + 2j * (DAMPING * NATURAL)[:, None] * omega)
    return np.einsum("mo,md,mf->odf", SHAPE, SHAPE[:, list(driven)], modal)


def moved(force, finer=1):
    """Displacements (3, m) under a ``force`` (m * finer,) at the first point, sampled ``finer`` times too fast."""
    time = np.arange(len(force)) / (RATE * finer)
    impulse = np.einsum("mo,mt->ot", SHAPE * SHAPE[:, :1], np.imag(np.exp(POLE[:, None] * time)) / POLE.imag[:, None])
    shown = scipy.signal.fftconvolve(impulse, force[None], axes=1)[:, :len(force)] / (RATE * finer)
    return shown[:, ::finer]


def blow(time, at, width=4e-4):
    return np.exp(-0.5 * ((time - at) / (width / 4)) ** 2)


def hammered(at, seconds, finer=16, extra=None):
    time = np.arange(int(seconds * RATE * finer)) / (RATE * finer)
    force = 100 * sum(blow(time, instant) * (1 + 0.2 * k) for k, instant in enumerate(at))
    force = force if extra is None else force + extra(time)
    return force[::finer], moved(force, finer)


@pytest.mark.exact
@pytest.mark.parametrize("pause", [3.0, 0.4])
def test_blows_give_the_response_where_the_window_takes_it(pause):
    """Exactly H at i w + r: with r = 0 where the motion has decayed, else with modes that decay faster by r."""
    force, motion = hammered([0.1], 0.1 + pause)
    assert of_blows_alone(force)
    found = from_blows(force, motion, RATE)
    assert (found.decay == 0) == (pause > 2) and found.averages == 1 and found.coherence is None
    omega = 2 * np.pi * found.frequency - 1j * found.decay
    exact = receptance(omega / (2 * np.pi))[:, 0]
    band = (found.frequency > 50) & (found.frequency < 1500)
    assert np.max(abs(found.response[:, 0] - exact)[:, band]) < 3e-3 * np.max(abs(exact[:, band]))


def test_modes_of_short_blows_have_their_own_damping():
    found = from_blows(*hammered([0.1, 0.6, 1.1], 1.6), RATE)
    band = (found.frequency > 100) & (found.frequency < 1500)
    modes = identify(found.frequency[band], found.response[:, 0, band])
    np.testing.assert_allclose(modes.frequency, FREQUENCY, rtol=2e-3)
    assert found.decay > 1
    corrected = (-modes.pole.real - found.decay) / abs(modes.pole)
    np.testing.assert_allclose(corrected, DAMPING, rtol=0.06)


def test_blows_that_are_of_no_use_are_left_out_and_told():
    force, motion = hammered([0.1, 1.1, 2.1, 3.1, 4.1], 4.3, 4, lambda t: 30 * blow(t, 2.13))
    motion[1, int(3.1 * RATE) + 20:int(3.1 * RATE) + 26] = abs(motion[1]).max() * 1.01
    found = from_blows(force, motion, RATE)
    assert found.averages == 2 and [why for _, why in found.left_out] == [
        "struck twice", "clipped", "cut off by the end of the record"]
    assert [time for time, _ in found.left_out] == pytest.approx([2.1, 3.1, 4.1], abs=5e-3)
    band = (found.frequency > 200) & (found.frequency < 1200)
    assert found.coherence[:, band].mean() > 0.999


def test_one_blow_late_in_the_record_is_whole():
    assert from_blows(*hammered([1.5], 2.5, 4), RATE).averages == 1


def test_without_a_usable_blow_each_is_told():
    force, motion = hammered([0.5], 1.5, 4, lambda t: 30 * blow(t, 0.53))
    with pytest.raises(ConfigError, match="one usable blow at least, found 0.49.* s: struck twice"):
        from_blows(force, motion, RATE)
    with pytest.raises(ConfigError, match="found no force"):
        from_blows(0 * force, motion, RATE)


@pytest.mark.exact
def test_a_periodic_force_gives_the_response_at_its_lines():
    """Lines four segments' lines apart: no leakage, H1 is exact there once the start has decayed."""
    size, random = 4096, np.random.default_rng(1)
    lines = np.arange(4, 800, 4)
    phase = random.uniform(0, 2 * np.pi, len(lines))
    time = np.arange(10 * size) / RATE
    force = np.cos(2 * np.pi * np.outer(time, lines * RATE / size) + phase).sum(axis=1)
    gain = receptance(lines * RATE / size)[:, 0]
    motion = np.real(np.einsum("of,tf->ot", gain * np.exp(1j * phase), np.exp(
        2j * np.pi * np.outer(time, lines * RATE / size))))
    found = from_lasting_forces(force[None], motion, RATE, RATE / size)
    np.testing.assert_allclose(found.response[:, 0, lines], gain, rtol=1e-8)
    np.testing.assert_allclose(found.coherence[:, lines], 1.0, atol=1e-8)
    assert not of_blows_alone(force)


def test_noise_of_the_motion_averages_out_and_the_coherence_tells():
    random = np.random.default_rng(2)
    force = random.standard_normal(int(60 * RATE))
    clean = moved(force)
    motion = clean + 0.3 * clean.std() * random.standard_normal(clean.shape)
    found = from_lasting_forces(force[None], motion, RATE, 1.0)
    band = (found.frequency > 250) & (found.frequency < 1000)
    exact = receptance(found.frequency)[:, 0]
    peak = band & (abs(found.frequency - 420) < 3)
    np.testing.assert_allclose(abs(found.response[:, 0, peak]), abs(exact[:, peak]), rtol=0.1)
    assert found.coherence[:, peak].min() > 0.95 > 0.5 > np.median(found.coherence[:, found.frequency > 2000])


@pytest.mark.parametrize("lines, least, most", [(2, 0.95, 1.25), (4, 0.99, 1.01), (8, 0.99, 1.01)])
def test_damping_may_come_out_too_large_where_few_lines_lie_within_a_peak(lines, least, most):
    """Lines within the half-power band of the lowest mode: what the docs say of lasting forces. Of two lines a fit with
    17 % too much and a right one are alike: rounding decides."""
    force = np.random.default_rng(3).standard_normal(int(120 * RATE))
    found = from_lasting_forces(force[None], moved(force), RATE, 2 * DAMPING[0] * FREQUENCY[0] / lines)
    band = (found.frequency > 250) & (found.frequency < 1200)
    modes = identify(found.frequency[band], found.response[:, 0, band])
    assert least < modes.damping_ratio[abs(modes.frequency - FREQUENCY[0]).argmin()] / DAMPING[0] < most


@pytest.mark.exact
def test_two_forces_at_once_are_told_apart():
    random = np.random.default_rng(3)
    force = random.standard_normal((2, int(40 * RATE)))
    share = moved(force[0])
    time = np.arange(force.shape[1]) / RATE
    impulse = np.einsum("mo,mt->ot", SHAPE * SHAPE[:, 2:3], np.imag(np.exp(POLE[:, None] * time)) / POLE.imag[:, None])
    motion = share + scipy.signal.fftconvolve(impulse, force[1][None], axes=1)[:, :len(time)] / RATE
    found = from_lasting_forces(force, motion, RATE, 0.5)
    exact = receptance(found.frequency, (0, 2))
    near = abs(found.frequency - 420) < 2
    assert found.response.shape[:2] == (3, 2)
    assert np.max(abs(found.response - exact)[:, :, near]) < 0.1 * np.max(abs(exact[:, :, near]))
    with pytest.raises(ConfigError, match="forces that differ from each other"):
        from_lasting_forces(np.array([force[0], force[0]]), motion, RATE, 0.5)


def test_motions_alone_give_frequencies_and_damping():
    """Under white noise at one point: what a random record of two minutes tells."""
    random = np.random.default_rng(4)
    motion = moved(random.standard_normal(int(120 * RATE)))
    found = from_motions(motion, (0, 1), RATE, 1.0)
    band = (found.frequency > 100) & (found.frequency < 1500)
    modes = identify(found.frequency[band], found.response.reshape(6, -1)[:, band])
    nearest = [abs(modes.frequency - f).argmin() for f in FREQUENCY]
    np.testing.assert_allclose(modes.frequency[nearest], FREQUENCY, rtol=3e-3)
    damping = ((-modes.pole.real - found.decay) / abs(modes.pole))[nearest]
    np.testing.assert_allclose(damping, DAMPING, rtol=0.3)
    assert found.coherence is None and found.decay == pytest.approx(np.log(1e3))


@pytest.mark.parametrize("ask, told", [
    (lambda f, x: from_lasting_forces(f[None], x, RATE, 0.01), "2 or more segments, found 0 of 100 s in 2 s"),
    (lambda f, x: from_motions(x, (0,), RATE, 1.0), "ten times 1 s or more, found 2 s")])
def test_records_that_are_too_short_are_refused(ask, told):
    force = np.random.default_rng(0).standard_normal(int(2 * RATE))
    with pytest.raises(ConfigError, match=told):
        ask(force, np.array([force] * 3))

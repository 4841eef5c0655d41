"""Half-sine pulses: exact moments whatever lies between samples, and the exact response of modes to them."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.half_sine import SPREAD, HalfSine, spectrum
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import ACCELERATION, DISPLACEMENT, INPUT_FORCE, Sensor
from tests.physics.lumps import lumps

WIDTHS = [0.1, 0.5, 1.5, 5.0, 40.0]
#: a chain of two masses of 1 kg on springs (N/m), damped in proportion (s); the frequencies are as 2.86 to 1
STIFFNESS, LOSS = np.array([1.0, 1.4]), 0.01
#: samples a period of the slower mode, 7 of the faster one
SLOW = 20
IMPULSE, CENTRE, SAMPLES = 0.7, 30.37, 200


def modes(count):
    """(Squares of angular frequencies, shapes of unit mass) of the first mass alone, or of both."""
    first, second = STIFFNESS
    stiffness = [[first]] if count == 1 else [[first + second, -second], [-second, second]]
    return scipy.linalg.eigh(stiffness)


def rig(count, steps):
    """(Bench of ``count`` masses, the last of which is seen, with so many ``steps`` a sample; sample rate in Hz)."""
    rate = SLOW * np.sqrt(modes(count)[0][0]) / (2 * np.pi)
    rows = [[1.0]] if count == 1 else [[1.0, 0.0], [-1.0, 1.0]]
    model = lumps([1.0] * count, rows, STIFFNESS[:count], LOSS * STIFFNESS[:count])
    return Bench(model, Hard(), constant(0.0), 1 / (steps * rate),
                 (Sensor("x", DISPLACEMENT, f"sensor_{count - 1}"),)), rate


def answer(root, time, width):
    """Answer of 1 kg whose free vibration is exp(root t) to a half sine of 1 N s about time 0: Duhamel's integral."""
    turn, within = np.pi / width, np.clip(time, -width / 2, width / 2)
    integral = (np.exp(root * (time - within)) * (turn * np.sin(turn * within) - root * np.cos(turn * within))
                + turn * np.exp(root * (time + width / 2))) * turn / 2 / (root**2 + turn**2)
    return np.where(time > -width / 2, np.imag(integral) / root.imag, 0.0)


def exact(count, time, width):
    """Displacement of the last mass, struck by a half sine about time 0."""
    square, shapes = modes(count)
    decay = LOSS * square / 2
    return IMPULSE * sum(share * answer(root, time, width) for root, share in
                         zip(-decay + 1j * np.sqrt(square - decay**2), shapes[-1] ** 2, strict=True))


def error(count, width, steps, inputs=None):
    """Largest errors (behind the pulse, at all samples) of the answer over the largest exact one; ``width`` in samples.

    ``inputs(rate)`` stands in for the pulse.
    """
    bench, rate = rig(count, steps)
    name, pulse = f"input_{count - 1}", HalfSine(IMPULSE, CENTRE / rate, width / rate)
    given = {"pulses": {name: pulse}} if inputs is None else {"inputs": {name: inputs(rate)}}
    run = Run("struck", (SAMPLES - 1) / rate, rate, **given)
    true = exact(count, run.time - pulse.time, pulse.width)
    off = abs(respond(bench, run)["x"] - true) / abs(true).max()
    return off[int(CENTRE + width / 2 + SPREAD) + 1:].max(), off.max()


def spline(rate):
    k = round(CENTRE)
    u, force = CENTRE - k, np.zeros(SAMPLES)
    force[k - 1:k + 2] = IMPULSE * rate * np.array([(0.5 - u) ** 2 / 2, 0.75 - u**2, (0.5 + u) ** 2 / 2])
    return force


@pytest.mark.exact
@pytest.mark.parametrize("width", [1e-6, *WIDTHS])
@pytest.mark.parametrize("between", [0.0, 0.3, 0.5])
def test_samples_have_impulse_centre_and_variance_of_the_pulse(width, between):
    rate, samples = 4.0, np.arange(SAMPLES)
    centre = 100 + between
    force = HalfSine(IMPULSE, centre / rate, width / rate).force(SAMPLES, rate)
    assert force.sum() / rate == pytest.approx(IMPULSE, rel=1e-9)
    weights = force / force.sum()
    assert weights @ samples == pytest.approx(centre, abs=1e-8)
    lines = 1 / 6                                       # what straight lines between samples add to the variance
    assert weights @ (samples - centre) ** 2 + lines == pytest.approx(width**2 * (1 / 4 - 2 / np.pi**2), abs=1e-8)
    assert np.abs(samples[force != 0] - centre).max() <= width / 2 + SPREAD


@pytest.mark.exact
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("width", WIDTHS)
def test_modes_answer_as_to_the_pulse_itself(count, width):
    """At 20 and 7 samples a period; errors of the largest exact answer, behind the pulse and at all samples."""
    behind, every = error(count, width, steps=5)
    assert behind < 1e-5 and every < 5e-4
    behind, every = error(count, width, steps=1)
    assert behind < 2e-3 and every < 1e-2
    assert error(count, width, 5, spline)[0] > 10 * behind, "three samples of one shape answer otherwise"


@pytest.mark.exact
def test_the_spectrum_is_that_of_the_samples():
    width, cycles = 60.0, np.array([0.0, 0.3, 0.5, 1.3, 1.5])
    force, time = HalfSine(1.0, 100.0, width).force(SAMPLES, 1.0), np.arange(SAMPLES) - 100.0
    turns = cycles / width
    seen = np.cos(2 * np.pi * turns[:, None] * time) @ force * np.sinc(turns) ** 2
    np.testing.assert_allclose(seen, spectrum(cycles), atol=1e-6)
    assert spectrum(0.0) == 1 and spectrum(0.5) == pytest.approx(np.pi / 4) and abs(spectrum(1.5)) < 1e-15


@pytest.mark.exact
def test_the_force_is_smooth_in_time_and_width():
    def force(time, width):
        return HalfSine(1.0, time, width).force(40, 1.0)

    for width in (1e-3, 0.7, 3.0, 9.0):
        for step in np.eye(2) * 1e-4 * np.array([1.0, width]):
            at = np.array([20.2, width])
            coarse = (force(*(at + step)) - force(*(at - step))) / 2
            fine = force(*(at + step / 2)) - force(*(at - step / 2))
            np.testing.assert_allclose(coarse, fine, atol=1e-11)


def test_a_run_that_is_cut_keeps_its_pulse():
    whole = HalfSine(1.0, 10.3, 4.0).force(40, 1.0)
    np.testing.assert_array_equal(HalfSine(1.0, 10.3, 4.0).force(11, 1.0), whole[:11])
    assert not HalfSine(1.0, 60.0, 4.0).force(40, 1.0).any() and not HalfSine(1.0, -20.0, 4.0).force(40, 1.0).any()


@pytest.mark.parametrize("held", [(), ("input_0",)])
def test_a_pulse_acts_on_top_of_an_input(held):
    bench, rate = rig(1, steps=4)
    bench = bench.with_channels(lambda c: Sensor("x", INPUT_FORCE, "input_0"))
    ramp, pulse = np.arange(SAMPLES) / rate, HalfSine(IMPULSE, CENTRE / rate, 3 / rate)
    run = Run("struck", (SAMPLES - 1) / rate, rate, {"input_0": ramp}, held=held, pulses={"input_0": pulse})
    seen = respond(bench, run)["x"]
    np.testing.assert_allclose(seen, ramp + pulse.force(4 * SAMPLES - 3, 4 * rate)[::4], atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("width", [0.02, 0.7, 6.0])
def test_a_pulse_behind_a_filter_is_the_convolution(width):
    pulse, corner, time = HalfSine(1.3, 2.0, width), 0.4, np.linspace(-3, 9, 41)
    pole, turn = 2 * np.pi * corner, np.pi / width

    def exact(t):
        begin, end = 2.0 - width / 2, min(t, 2.0 + width / 2)
        if end <= begin:
            return 0.0
        course = scipy.integrate.quad(lambda s: np.sin(turn * (s - begin)) * np.exp(-pole * (t - s)), begin, end)[0]
        return pole * 1.3 * turn / 2 * course

    np.testing.assert_allclose(pulse.filtered(time, corner), [exact(t) for t in time], atol=1e-9)
    inside = np.linspace(2.0 - 0.499 * width, 2.0 + 0.499 * width, 7)
    force = 1.3 * turn / 2 * np.cos(turn * (inside - 2.0))
    np.testing.assert_allclose(pulse.filtered(inside, np.inf), force, rtol=1e-9)
    assert not pulse.filtered(np.array([2.0 - 0.6 * width, 2.0 + 0.6 * width]), np.inf).any()


@pytest.mark.exact
@pytest.mark.parametrize("width", [0.05, 0.6, 3.0])
def test_an_accelerometer_sees_a_pulse_shorter_than_a_step(width):
    """Widths in steps; what a filtered accelerometer shows, against the same in steps a fortieth as long."""
    bench, rate = rig(1, 5)
    seen = Sensor("x", ACCELERATION, "sensor_0", corner=0.8 * rate, delay=0.1 / rate)
    run = Run("r", (SAMPLES - 1) / rate, rate, pulses={"input_0": HalfSine(IMPULSE, CENTRE / rate, width * bench.step)})
    coarse, fine = (respond(replace(bench, step=bench.step / finer, channels=(seen,)), run)["x"] for finer in (1, 40))
    assert np.abs(coarse - fine).max() < 2e-3 * np.abs(fine).max()

"""Overload: what is cut off at the end of a range, by any instrument, and what only repeats itself."""

import nptdms
import numpy as np
import pytest
import scipy
import soundfile

from pipeline.physics.signals.overload import overload

RATE = 48000
TIME = np.arange(RATE) / RATE
RANDOM = np.random.default_rng(4)
NOISE = RANDOM.standard_normal(RATE)


def tone(frequency, noise=2e-3):
    return np.sin(2 * np.pi * frequency * TIME) + noise * NOISE


def found(samples):
    return overload(lambda: [samples])


def as_sound(samples, folder, suffix, subtype):
    soundfile.write(folder / f"x{suffix}", samples, RATE, subtype=subtype)
    return soundfile.read(folder / f"x{suffix}")[0]


@pytest.mark.parametrize("suffix, subtype", [(".wav", "PCM_U8"), (".wav", "PCM_16"), (".flac", "PCM_24"),
                                             (".aiff", "PCM_24"), (".wav", "FLOAT"), (".wav", "DOUBLE")])
@pytest.mark.parametrize("frequency", [120.0, 3000.0, 9100.7])
def test_files_of_sound_that_were_overloaded(suffix, subtype, frequency, tmp_path):
    one = found(as_sound(np.clip(1.2 * tone(frequency), -1, 1), tmp_path, suffix, subtype))
    assert one.low and one.high and one.limit == pytest.approx(1.0, abs=0.01)
    assert one.share == pytest.approx(2 * np.arccos(1 / 1.2) / np.pi, rel=0.15)
    assert found(as_sound(0.8 * tone(frequency), tmp_path, suffix, subtype)) is None


def test_raw_integers_with_a_scale_of_their_own(tmp_path):
    """An accelerometer of 50 m/s^2 in a TDMS file, as its converter left it."""
    raw = np.clip(np.round(tone(700.0) * 40000), -32768, 32767).astype(np.int16)
    with nptdms.TdmsWriter(tmp_path / "x.tdms") as file:
        file.write_segment([nptdms.ChannelObject("a", "pad", raw)])
    values = 50.0 / 32768 * nptdms.TdmsFile.read(tmp_path / "x.tdms")["a"]["pad"][:] + 0.3
    assert found(values).limit == pytest.approx(50.0, rel=0.01)


@pytest.mark.parametrize("samples, low, high", [
    (np.minimum(NOISE, 2.2), False, True), (np.maximum(0.4 * NOISE, -0.9).astype(np.float32), True, False),
    (np.clip(123.4 * (0.01 * NOISE + 2 * np.sin(2 * np.pi * 997 * TIME) * (abs(TIME - 0.5) < 2e-3)), -90, 90),
     True, True)])
def test_one_end_alone_floats_and_a_short_burst(samples, low, high):
    one = found(samples)
    assert (one.low, one.high) == (low, high)


def smooth_noise():
    made = scipy.signal.lfilter([1.0], [1.0, -1.8, 0.98], NOISE)
    return made / abs(made).max()


@pytest.mark.parametrize("samples", [
    *(np.sin(2 * np.pi * f * TIME) for f in (20.0, 1000.0, 3000.0, 6000.0, 8000.0, 12000.0)),
    *(np.round(100 * np.sin(2 * np.pi * f * TIME)) / 100 for f in (2.0, 50.0, 1000.0)),
    NOISE, np.round(3 * NOISE), smooth_noise(), np.round(2000 * smooth_noise()), np.zeros(RATE), np.ones(RATE),
    np.where(np.arange(RATE) % 6000 < 40, 400 * np.exp(-np.arange(RATE) % 6000 / 9.0), 0.0),
    np.sin(2 * np.pi * 3150 * TIME) * (abs(TIME - 0.5) < 0.2), tone(440.0) * np.exp(-3 * TIME)])
def test_what_swings_freely_is_not_overloaded(samples):
    """Tones that repeat themselves exactly, coarse steps, noise, silence, blows, bursts, decays."""
    assert found(samples) is None


def test_parts_and_blocks_tell_when():
    samples = tone(700.0, 0.01) * np.where(abs(TIME - 0.5) < 0.1, 1.5, 0.5)
    samples = np.clip(samples, -1.0, 1.0)
    one = overload(lambda: np.array_split(samples, [10240, 20480, 40960]))
    assert one.share == found(samples).share and one.blocks.sum() == pytest.approx(one.share * RATE)
    assert one.during(0.45, 0.55, RATE) and not one.during(0.0, 0.3, RATE) and not one.during(0.7, 0.9, RATE)

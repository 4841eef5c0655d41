"""Frames: a tone by its formula; nothing depends on the blocks that they are transformed in."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.frames import frames
from pipeline.physics.signals.noise_events import Broadband, Tonal
from pipeline.physics.signals.squeal_detector import Detector, Loudest

RATE = 48000.0
DETECTOR = Detector((2000.0, 16000.0), 70.0, 20e-6, 0.04, 0.75, 10.0, 40.0, 40.0, 0.05, 0.1, 100.0, 0.05, 0.1, 0.33,
                    True, 12.0, 4)


class Kept:
    """Watches Frames and keeps them."""

    def __init__(self):
        self.first, self.spectra = [], []

    def see(self, first, spectra):
        self.first.append(first)
        self.spectra.append(spectra)


def squealing(seconds=6.0):
    """Tones that go on over any border of blocks, one that sweeps, and loud noise."""
    time, random = np.arange(round(seconds * RATE)) / RATE, np.random.default_rng(5)
    steady = 1.5 * np.sin(2 * np.pi * 3150 * time) * ((time > 0.7) & (time < 4.1))
    sweeping = 0.15 * np.sin(2 * np.pi * (5000 * time + 200 * time**2)) * (time > 2)
    return steady + sweeping + random.standard_normal(len(time)) * np.where((time > 4.5) & (time < 5.2), 0.5, 1e-3)


def seen(signal, at_once, detector=DETECTOR):
    found = frames(signal, RATE, detector, np.float32)
    found = replace(found, at_once=at_once or found.at_once)
    kept, tones, noise, loudest = Kept(), Tonal(found, detector, 0.03), Broadband(found, detector), Loudest(found,
                                                                                                           detector)
    found.scan(kept, tones, noise, loudest)
    return (np.concatenate(kept.spectra), [asdict(event) for event in tones.result() + noise.result()],
            loudest.result(), noise.background())


@pytest.mark.exact
def test_a_tone_on_a_line_shows_its_effective_value():
    detector = replace(DETECTOR, weighted=False)
    spectra, *_ = seen(0.3 * np.sqrt(2) * np.sin(2 * np.pi * 3000 * np.arange(48000) / RATE), 8, detector)
    found = frames(np.zeros(48000), RATE, detector)
    assert found.hop == pytest.approx(0.01) and len(spectra) == len(found.time) == 97
    assert found.time[[0, -1]] == pytest.approx([0.02, 0.98])
    assert spectra[:, 120] == pytest.approx(0.3, rel=1e-6) and found.frequency[120] == pytest.approx(3000)


@pytest.mark.parametrize("at_once", [1, 7, 8, 100])
def test_nothing_depends_on_the_blocks(at_once):
    signal = squealing()
    spectra, events, loudest, background = seen(signal, 10_000)
    again, same, peak, level = seen(signal, at_once)
    np.testing.assert_allclose(again, spectra, rtol=2e-6, atol=1e-12)
    assert [event["kind"] for event in events] == ["squeal", "sweep", "broadband"]
    for one, other in zip(events, same, strict=True):
        assert one == {key: pytest.approx(value, rel=1e-6) if key != "kind" else value for key, value in other.items()}
    assert peak == pytest.approx(loudest) and level == pytest.approx(background)


def test_what_gives_slices_serves_as_the_signal():
    class Sliced:
        def __init__(self, values):
            self.values, self.most = values, 0

        def __len__(self):
            return len(self.values)

        def __getitem__(self, part):
            self.most = max(self.most, part.stop - part.start)
            return self.values[part].astype(np.float32)

    signal = squealing()
    sliced = Sliced(signal)
    assert [e["kind"] for e in seen(sliced, 0)[1]] == [e["kind"] for e in seen(signal, 0)[1]]
    assert sliced.most < 200_000


def test_bad_input():
    with pytest.raises(ConfigError, match="expected a signal of at least 0.04 s, found 0.0002"):
        frames(np.zeros(10), RATE, DETECTOR)
    with pytest.raises(ConfigError, match="half the sampling rate"):
        frames(np.zeros(100000), 30e3, DETECTOR)

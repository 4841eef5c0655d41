"""Classification of synthetic spectra: each kind from its definition."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.stability.lock_in import CLASSICAL, DUAL, INTERMEDIATE, MULTIPLE, NONE, OTHER, lock_in

pytestmark = pytest.mark.exact
RATE = 1e5
TIME = np.arange(20000) / RATE
DISC, PIN = 2250.0, 2100.0


def tones(*pairs, noise=1e-6):
    random = np.random.default_rng(0)
    clean = sum(a * np.sin(2 * np.pi * f * TIME + 0.3 * k) for k, (f, a) in enumerate(pairs))
    return clean + noise * random.standard_normal(len(TIME))


def harmonics(base, count, fall=0.2):
    return [(k * base, fall ** (k - 1)) for k in range(1, count + 1)]


def test_harmonics_of_a_body_are_classical():
    found = lock_in(tones(*harmonics(2240.0, 5, 0.4)), RATE, DISC, PIN)
    assert found.kind == CLASSICAL and found.harmonics == 5
    assert found.base == pytest.approx(2240, abs=1)
    assert found.levels[:5] == pytest.approx(20 * np.log10(0.4) * np.arange(5), abs=0.5)
    assert np.isneginf(found.levels[5:]).all()


def test_a_base_between_both_bodies_is_intermediate():
    assert lock_in(tones(*harmonics(1900.0, 3)), RATE, DISC, 1500.0).kind == INTERMEDIATE
    assert lock_in(tones(*harmonics(1510.0, 3)), RATE, DISC, 1500.0).kind == CLASSICAL
    assert lock_in(tones(*harmonics(1900.0, 3)), RATE, [1000.0, 2250.0], [1500.0, 5000.0]).kind == INTERMEDIATE
    assert lock_in(tones(*harmonics(3000.0, 3)), RATE, DISC, PIN).kind == OTHER


def test_side_bands_are_multiple():
    modulated = (1 + 0.3 * np.sin(2 * np.pi * 120 * TIME)) * tones(*harmonics(2215.0, 3))
    found = lock_in(modulated, RATE, DISC, PIN)
    assert found.kind == MULTIPLE
    assert (found.base, found.second) == pytest.approx((2215, 120), abs=2)


def test_two_bases_are_dual():
    found = lock_in(tones(*harmonics(2215.0, 3), (3650.0, 0.3), (7300.0, 0.1)), RATE, DISC, PIN)
    assert found.kind == DUAL
    assert found.second == pytest.approx(3650, abs=2)


def test_a_weak_second_harmonic_keeps_its_base():
    assert lock_in(tones((1100.0, 0.5), (2200.0, 1.0)), RATE, DISC, PIN).base == pytest.approx(1100, abs=1)


def test_noise_and_silence_have_no_lock_in():
    random = np.random.default_rng(1)
    assert lock_in(random.standard_normal(len(TIME)), RATE, DISC, PIN).kind == NONE
    assert lock_in(np.zeros(len(TIME)), RATE, DISC, PIN).kind == NONE


def test_a_short_signal_is_refused():
    with pytest.raises(ConfigError, match="lengthen the window"):
        lock_in(np.sin(TIME[:500]), RATE, DISC, PIN)

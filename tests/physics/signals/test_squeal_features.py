"""States and features of motions whose growth, level and harmonics are known."""

import numpy as np
import pytest

from pipeline.physics.signals.squeal_features import (
    GROWING,
    QUIET,
    SATURATED,
    agree,
    means,
    motion_features,
    saturated,
    state,
)

RATE, SIZE, BASE = 25600.0, 640, 2210.0
TIME = np.arange(6400) / RATE


def motion(growth, begin=1e-3, size=1.0):
    """Two channels that grow at ``growth`` 1/s and saturate as van der Pol's: f with 10 % of 2 f and 1 % of 3 f."""
    ratio = np.minimum((begin / size) ** 2 * np.exp(2 * growth * TIME), 1e12)
    wave = sum(a * np.cos(2 * np.pi * n * BASE * TIME + n) for n, a in ((1, 1.0), (2, 0.1), (3, 0.01)))
    return np.array([1.0, 30.0])[:, None] * size * np.sqrt(ratio / (1 + ratio)) * wave


@pytest.mark.exact
@pytest.mark.parametrize("growth, wanted", [(-20, QUIET), (0, QUIET), (1, QUIET), (3, GROWING), (20, GROWING),
                                            (60, SATURATED), (500, SATURATED)])
def test_a_motion_is_saturated_where_it_outgrew_its_start_and_grows_no_more(growth, wanted):
    """From 1e-3 a rate of 28 1/s reaches saturation after 0.25 s, one of 500 1/s within the first stretch."""
    assert state(motion(growth), SIZE) == wanted


@pytest.mark.exact
def test_saturated_stretches_are_those_at_the_end():
    """Half the power of saturation is reached where the growth from 1e-3 has made 1: after ln(1000) / 60 s."""
    kept = saturated(motion(60.0), SIZE)
    first = np.log(1000) / 60 / 0.025
    assert kept[-1] == 9 and abs(kept[0] - first) <= 1 and (np.diff(kept) == 1).all()


@pytest.mark.exact
def test_features_of_a_motion_are_its_tone_level_and_harmonics():
    samples = motion(500.0)[1]
    found = motion_features(samples, RATE, SIZE, np.arange(6, 10), 200.0)
    assert found["frequency"] == pytest.approx(np.full(4, BASE), abs=0.02 / 0.025), "a parabola errs by 2 % of a line"
    assert found["level"] == pytest.approx(np.full(4, 30 * np.sqrt((1 + 0.01 + 1e-4) / 2)), rel=5e-3)
    assert found["level of 2 f over f"] == pytest.approx(np.full(4, -20.0), abs=0.1)
    assert found["level of 3 f over f"] == pytest.approx(np.full(4, -40.0), abs=0.2)
    assert "level of 3 f over f" not in motion_features(samples[::3], RATE / 3, SIZE // 3, np.arange(4), 200.0)


@pytest.mark.exact
def test_means_are_those_of_the_stretches():
    np.testing.assert_allclose(means(np.repeat([1.0, 2.0, 5.0], SIZE), SIZE, [1, 2]), [2.0, 5.0])


@pytest.mark.exact
def test_agreement_is_within_both_spreads():
    narrow, wide = np.array([0.0, 2.0]), np.array([2.0, 8.0])
    assert agree(narrow, wide, 2.0) and not agree(narrow, wide, 1.0), "4 apart, sqrt(1 + 9) together"
    assert agree(narrow, narrow, 0.1) and not agree(np.zeros(2), np.ones(2), 2.0)

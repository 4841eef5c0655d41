"""Rates of instants that were rounded."""

import numpy as np
import pytest

from pipeline.recordings.tables.rounded import agrees, rounded_rate, roundings


@pytest.mark.parametrize("rate, decimals, count", [
    (51200, 6, 5000), (25600, 4, 20000), (48000, 5, 4800), (44100, 6, 9000), (65536, 6, 9000), (51200, 3, 50000)])
@pytest.mark.parametrize("cut", [np.rint, np.floor])
def test_the_rate_comes_back_and_lost_or_jittering_samples_do_not_pass(rate, decimals, count, cut):
    instants = np.arange(count) / rate
    time = cut(instants * 10.0**decimals) / 10.0**decimals
    rounded = rounded_rate(time)
    assert rounded.rate == rate and rounded.step == pytest.approx(10.0**-decimals)
    assert rounded.lowest <= rate <= rounded.highest and agrees(time, rate)
    assert rounded_rate(np.delete(time, count // 2)) is None and not agrees(np.delete(time, count // 2), rate)
    late = instants + 0.5 * 10.0**-decimals * np.random.default_rng(1).standard_normal(count)
    assert rounded_rate(np.rint(late * 10.0**decimals) / 10.0**decimals) is None


@pytest.mark.parametrize("time", [
    np.array([float(f"{t:.6g}") for t in np.arange(9000) / 12800]), (np.arange(9000) / 12800).astype(np.float32),
    (np.arange(9000) / 12800).astype(np.float32).astype(float)])
def test_significant_digits_and_single_precision_are_roundings_too(time):
    assert rounded_rate(time).rate == pytest.approx(12800, rel=1e-12)


def test_a_short_record_leaves_the_rate_open_and_a_known_one_is_taken():
    time = np.round(np.arange(12) / 51200, 4)
    assert rounded_rate(time) is None and rounded_rate(time, known=51200).rate == 51200
    few = np.round(np.arange(400) / 25599.99, 6)
    assert rounded_rate(few).rate == 25600 and rounded_rate(few, known=25599.99).rate == 25599.99
    assert rounded_rate(np.arange(20) ** 2.0) is None
    assert rounded_rate(np.cumsum(np.random.default_rng(0).random(20))) is None


def test_few_steps_of_twice_the_usual_are_lost_samples():
    time = np.delete(np.arange(200) / 10, 100)
    assert rounded_rate(time) is None and not agrees(time, 10.0)
    assert not agrees(np.array([0.0, 0.1, 0.1]), 10.0)
    assert [np.max(bound) for bound in roundings(np.array([0.1, 0.25]))][-1] == pytest.approx(0.005)

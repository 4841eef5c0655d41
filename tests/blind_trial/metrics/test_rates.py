"""Rates and their intervals."""

import pytest

from pipeline.blind_trial.metrics.rates import calibration, line, rate


@pytest.mark.exact
def test_wilson_bounds_of_none_in_130_and_of_half():
    none, half, nobody = rate([False] * 130), rate([True, False] * 50), rate([])
    assert none["low"] == 0.0 and none["high"] == pytest.approx(1.96**2 / (130 + 1.96**2), rel=1e-4)
    assert half["low"] + half["high"] == pytest.approx(1.0) and 0.40 < half["low"] < 0.41
    assert nobody == {"hits": 0, "count": 0, "low": 0.0, "high": 1.0}


def test_a_line_tells_hits_rate_and_interval():
    assert line("controls", rate([True, False])).split()[:5] == ["controls", "1", "of", "2", "50.0%"]


@pytest.mark.exact
def test_calibration_by_bins_and_its_brier_score():
    found = calibration([(0.9, True), (0.92, False), (1.0, True), (0.2, False)])
    assert found["count"] == 4 and found["brier"] == pytest.approx((0.01 + 0.8464 + 0 + 0.04) / 4)
    assert [(b["low"], b["so"]["hits"], b["so"]["count"]) for b in found["bins"]] == [(0.0, 0, 1), (0.85, 1, 2),
                                                                                    (0.99, 1, 1)]
    assert found["bins"][1]["stated"] == pytest.approx(0.91) and calibration([]) == {"count": 0}

"""Rates and their intervals."""

import pytest

from pipeline.concealed.rates import line, wilson


@pytest.mark.exact
def test_wilson_bounds_of_none_in_130_and_of_half():
    low, high = wilson(0, 130)
    assert low == 0.0 and high == pytest.approx(1.96**2 / (130 + 1.96**2), rel=1e-12)
    low, high = wilson(50, 100)
    assert low + high == pytest.approx(1.0) and 0.40 < low < 0.41
    assert wilson(0, 0) == (0.0, 1.0)


def test_a_line_tells_hits_rate_and_interval():
    assert line("controls", [True, False]).split()[:5] == ["controls", "1", "of", "2", "50.0%"]

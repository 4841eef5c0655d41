"""Assignment and chance: lists at random are not matched, lists that agree are."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.published.chance_agreement import assigned, chance, covered, match

BAND = (1000.0, 2000.0)


def test_assignment_gives_each_line_a_partner_of_its_own():
    assert assigned([100.0, 104.0], [103.0, 90.0, 400.0]).tolist() == [1, 0]
    assert assigned([100.0, 200.0], [199.0]).tolist() == [-1, 0]


def test_covered_share_counts_overlap_once():
    assert covered([1100.0, 1110.0, 1990.0], 20.0, BAND) == pytest.approx((50 + 30) / 1000)
    assert covered([], 20.0, BAND) == 0 and covered([1500.0], 5000.0, BAND) == 1


def test_chance_is_that_of_any_of_independent_lines():
    assert chance(0.5, 2) == 0.75 and chance(0.0, 5) == 0


def test_p_value_is_the_covered_share_to_the_number_of_lines():
    model = np.array([1200.0, 1400.0, 1700.0])
    found = match([1201.0, 1699.0], [10.0, 10.0], model, BAND)
    assert found.matched == 2 and found.p_value == pytest.approx(0.06**2, abs=0.0015)
    assert found.gain > 5                                      # two lines, each to 5 Hz out of 1 kHz


def test_a_dense_list_meets_anything_and_says_nothing():
    found = match([1234.0, 1777.0], [50.0, 50.0], np.arange(1000.0, 2001.0, 80.0), BAND)
    assert found.matched == 2 and found.p_value == 1.0 and abs(found.gain) < 1


def test_lists_at_random_are_rarely_matched():
    generator = np.random.default_rng(1)
    drawn = [match(generator.uniform(*BAND, 3), np.full(3, 5.0), generator.uniform(*BAND, 10), BAND, draws=2000, seed=k)
             for k in range(100)]
    assert sum(m.p_value <= 0.01 and m.matched == 3 for m in drawn) <= 3


def test_lines_outside_the_band_are_refused():
    with pytest.raises(ConfigError, match="a band that holds"):
        match([900.0], [5.0], [950.0], BAND)

"""The study of draws beside LAPACK: it sees a root that is lost, and one that is off."""

import numpy as np

from tests.studies.draws import Beside, beside, cases, told


def test_draws_of_a_small_brake_are_those_of_lapack():
    every, drawn, speed, neutral = cases(2, 5, small=True)
    found = [[beside(case.compact(), speed, neutral, factors) for factors in drawn] for case in every]
    assert all(each.same for of_case in found for each in of_case)
    assert f"{2 * len(every)} of {2 * len(every)} sets" in told(found)[0]


def test_a_root_that_lacks_or_is_off_is_told():
    root = np.array([3 + 2e4j, 40 + 6e4j])
    found = [[Beside(root[:1], root), Beside(root + 0.2, root), Beside(root[:0], root[:1])]]
    same, apart, share = told(found)
    assert same == "the same growing modes: 1 of 3 sets, 5 roots by LAPACK" and "0.2 1/s at most" in apart
    assert "0.667" in share and "1.000" in share

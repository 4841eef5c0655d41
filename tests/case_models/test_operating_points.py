"""Operating points of the middle speed."""

import numpy as np
import pytest

from pipeline.case_models.operating_points import middle_speed, selected_speeds


@pytest.mark.parametrize(("speeds", "middle"), [((12.0, 8.5, 10.25), 10.25), ((8.0, 12.0), 12.0), ((3.0,), 3.0),
                                                ((8.0, 8.0, 8.0, 12.0, 9.0), 9.0)])
def test_the_middle_speed_is_that_of_the_different_speeds(speeds, middle):
    assert middle_speed(speeds) == middle
    assert middle_speed(np.tile(speeds, 4)) == middle     # at several pressures


def test_all_speeds_or_the_middle_one():
    assert selected_speeds("all", (12.0, 8.5)) == [12.0, 8.5]
    assert selected_speeds("middle", (12.0, 8.5, 10.25)) == [10.25]

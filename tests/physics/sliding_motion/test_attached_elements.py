"""Elements beside the patches: what is beyond their slopes, and a closed form of one that only they move."""

import numpy as np
import pytest

from pipeline.physics.sliding_motion.attached_elements import attached, beyond_slopes
from pipeline.physics.time_stepping.elements import Element, Maxwell, Polynomial, Sliders, Turning

ROW = np.ones(1)


def beyond(element, place, slopes, moved, rate=0.0, time=0.0, memory=None, begun=None):
    """(force beyond the slopes, its derivatives to place and rate, memory after) of one element behind one patch."""
    kernel, held = attached((element,), [place], np.reshape(slopes, (2, 1)), memory, 3.0)
    y, rest, slope, after = np.zeros((4, 2)), np.full((3, 2), 7.0), np.zeros((3, 4, 2)), held.copy()
    y[:2, 1] = moved, rate
    beyond_slopes(kernel, held, np.array([place if begun is None else begun]), time, y, rest, slope, after)
    assert (rest[:, 0] == 7.0).all() and not rest[1:, 1].any()
    return rest[0, 1], slope[0, 0, 1], slope[0, 1, 1], after


@pytest.mark.exact
def test_a_cubic_spring_beyond_its_slope_at_rest():
    """F = 5 e + 2e9 e^3 about e0 = 1e-4: k = 5 + 6e9 e0^2."""
    spring, place, moved = Element("cubic", ROW, Polynomial(5.0, 0.0, 2e9)), 1e-4, 3e-5
    slope = 5.0 + 6e9 * place**2
    force, by_place, by_rate, _ = beyond(spring, place, (slope, 0.0), moved)
    end = place + moved
    expected = -(5.0 * end + 2e9 * end**3 - 5.0 * place - 2e9 * place**3 - slope * moved)
    assert force == pytest.approx(expected, rel=1e-12)
    assert by_place == pytest.approx(slope - 5.0 - 6e9 * end**2, rel=1e-12) and by_rate == 0


@pytest.mark.exact
def test_a_linear_law_leaves_nothing():
    assert beyond(Element("spring", ROW, Polynomial(5.0, 0.0, 0.0)), 0.1, (5.0, 0.0), 0.3)[0] == pytest.approx(0.0)
    assert beyond(Element("turning", ROW, Turning(1.0, 0)), 0.0, (0.0, 4.0), 0.0, rate=2.0)[0] == 0.0


@pytest.mark.exact
def test_a_slider_gives_way_at_its_limit_and_remembers():
    slider = Element("slider", ROW, Sliders(np.array([100.0]), np.array([1.0])))
    force, by_place, _, after = beyond(slider, 0.0, (100.0, 0.0), 0.03)
    assert force == pytest.approx(100.0 * 0.03 - 1.0) and by_place == 100.0 and after[0] == 1.0
    back, *_ = beyond(slider, 0.0, (100.0, 0.0), 0.02, memory=after, begun=0.03)
    # from where it gave way: the force at rest there is 1 N, and it has gone back by 0.01 m
    assert back == pytest.approx(1.0 + 100.0 * 0.02 - 0.0)


@pytest.mark.exact
def test_a_branch_that_is_held_relaxes():
    branch = Element("branch", ROW, Maxwell(np.array([50.0]), np.array([0.2])))
    kernel, _ = attached((branch,), [0.0], np.zeros((2, 1)), None, 0.0)
    assert list(kernel.branch) == [0]
    force, *_ = beyond(branch, 0.0, (0.0, 0.0), 0.0, time=0.1, memory=[4.0, 0.0], begun=0.0)
    assert force == pytest.approx(4.0 - 4.0 * np.exp(-0.5), rel=1e-12)

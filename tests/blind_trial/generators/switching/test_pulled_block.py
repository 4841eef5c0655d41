"""A pulled block: steady sliding, the onset of slip and the instants of the machine in closed form; friction laws."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching.pulled_block import (
    FORMS,
    LEAST,
    NAMES,
    Block,
    Course,
    friction_law,
    made,
    pulled,
)

BLOCK = Block(1.0, 2500.0, 20.0, 0.4, 5.0)
COURSE = Course((0.1, 1.0), (0.01, 0.0))
FINE = np.linspace(0, 2, 16_001)


@pytest.mark.exact
def test_a_machine_leads_its_end_in_pieces():
    np.testing.assert_allclose(COURSE.displacement([0.0, 0.1, 0.6, 1.0, 2.0]), [0, 0, 0.005, 0.009, 0.009], atol=1e-15)
    np.testing.assert_array_equal(COURSE.velocity(np.array([0.05, 0.1, 0.99, 1.5])), [0, 0.01, 0.01, 0])


@pytest.mark.exact
def test_the_block_lets_go_when_the_spring_overcomes_friction_slides_steadily_and_holds_in_the_end():
    """It rests until k V (t - t_0) + c V = mu N, and slides at V with the spring at mu N."""
    motion, force = pulled(BLOCK, COURSE, friction_law(BLOCK, "", 0.01, 0.0), FINE)
    onset = 0.1 + (2.0 - 20 * 0.01) / (2500 * 0.01)
    assert not motion.velocity[0, onset - 1e-9 > FINE].any() and motion.velocity[0, onset + 2e-3 < FINE][0] > 0
    steady = (FINE > 0.95) & (FINE < 1.0)
    np.testing.assert_allclose(force[steady], -2.0, rtol=2e-3)
    np.testing.assert_allclose(motion.velocity[0, steady], 0.01, rtol=2e-2)
    assert motion.velocity[0, -1] == 0 and abs(force[-1]) <= 2.0


@pytest.mark.exact
@pytest.mark.parametrize("form, factor", [("falling_friction", 1 + 0.1 / np.e), ("viscous", 1.1),
                                          ("velocity_strengthening", 1.0)])
def test_friction_at_the_typical_speed_has_its_closed_form(form, factor):
    law = friction_law(BLOCK, form, 0.01, 0.1)
    assert law.force(0, 0, 0.01, (), 1) == pytest.approx(2.0 * factor, rel=1e-3)
    assert law.force(0, 0, 0.01, (), -1) == -law.force(0, 0, 0.01, (), 1)


@pytest.mark.exact
def test_an_aged_contact_is_as_old_as_it_rested_and_steady_at_the_age_of_its_length():
    law = friction_law(BLOCK, "contact_ageing", 0.01, 0.1)
    length = 0.2 * 0.01 / BLOCK.frequency
    assert law.rates(0, 0, 0.0, np.array([3.0]), 0) == 1
    assert law.rates(0, 0, 0.01, np.array([length / 0.01]), 1) == pytest.approx(0.0, abs=1e-12)
    assert law.limits(0, 0, np.array([2 * length / 0.01]))[1] == pytest.approx(2.0 * (1 + 0.1 * np.log(3)))
    ripple = friction_law(BLOCK, "rippled_track", 0.01, 0.1)
    assert ripple.limits(0, 0.75 * length, ())[1] == pytest.approx(2.2) and not FORMS["rippled_track"]


def test_a_control_and_a_hidden_law():
    case = made(1, "control", level=0.05)
    assert case.left == 0 == case.change and len(case.shown) == 4 and case.shown[0].shape[0] == 2
    off = [abs(np.log(getattr(case.belief, name) / getattr(case.truth, name))) for name in NAMES]
    assert np.log(1.1) <= min(off) and max(off) <= np.log(1.3)
    hidden = made(1, "effect", "falling_friction", 0.05)
    assert hidden.left >= LEAST and hidden.change > 0

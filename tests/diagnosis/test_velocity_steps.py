"""Velocity steps made by SciPy: rate-and-state friction is named, and friction of ln v alone is not taken for it."""

import numpy as np
import pytest

from pipeline.physics.friction.joint_friction import REFERENCE_SPEED
from tests.diagnosis.velocity_steps import COURSES, MACHINE, dragged, load_point, problem, recording

STATES = {"rate_state_ageing at face", "rate_state_slip at face"}


@pytest.mark.exact
@pytest.mark.parametrize("law", ["ageing", "slip"])
def test_the_truth_slides_steadily_by_the_logarithm_of_the_speed(law):
    point = load_point(COURSES["steps_1"])
    slip, load = dragged(point, 30.0, 0.012, 0.018, 2e-5, law)
    speed = 200e-6
    assert load[-1] == pytest.approx(MACHINE * (slip[-1] - point[-1]))
    before = round(12.0 * 100) - 1      # the end of the second slide at 200 um/s
    assert -load[before] == pytest.approx(30.0 * (1 - 0.006 * np.log(speed / REFERENCE_SPEED)), rel=1e-3)


def test_the_prior_of_friction_follows_the_load_cell():
    """No spring of the nominal model holds the face: its force would be that of the drag alone, some 10 mN."""
    asked = problem(recording(), ("logarithmic_friction",))
    force, _ = next(c for c in asked.candidates if c.name == "logarithmic_friction at face").parameters
    assert 5 < force.nominal < 10


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("law", ["ageing", "slip"])
def test_rate_and_state_friction_is_named_or_a_tie_of_its_laws(law):
    told = problem(recording(law=law)).solved()
    named = {c.name for c in told.decision.named}
    assert told.decision.verdict in ("missing", "tie") and f"rate_state_{law} at face" in named and named <= STATES


@pytest.mark.slow
@pytest.mark.study
def test_friction_of_the_logarithm_of_the_speed_alone_is_not_taken_for_it():
    told = problem(recording(evolution=0.0)).solved()
    assert [c.name for c in told.decision.named] == ["logarithmic_friction at face"]

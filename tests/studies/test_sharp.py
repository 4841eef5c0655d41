"""The study of sharp laws: its plan, its recordings, its score; one draw of Coulomb friction; and, slow, the others."""

import numpy as np
import pytest

from tests.studies.sharp import DRAWS, KINDS, NOISES, Plan, Truth, made, plans, right, solved, table


def test_every_kind_has_twelve_draws_at_both_levels_of_noise():
    names = [plan.name for plan in plans()]
    assert len(set(names)) == len(names) == len(KINDS) * DRAWS * len(NOISES) and DRAWS == 12


def test_recordings_have_the_noise_that_is_stated_and_are_the_same_again():
    plan = Plan("nothing", 3, 0.05)
    truth, again = made(plan, levels=(1.0,)), made(plan, levels=(1.0,))
    shown = truth.recording.runs["run_1"].channels["left"].samples
    assert truth.effects == () and truth.noise["left"] == pytest.approx(0.05 * shown.std(), rel=0.02)
    np.testing.assert_array_equal(shown, again.recording.runs["run_1"].channels["left"].samples)


def test_only_what_is_hidden_at_its_place_is_right():
    plan, truth = Plan("coulomb", 0, 0.01), Truth((("coulomb", "mount"),), {}, None)

    def answer(verdict, *named):
        return {"verdict": verdict, "effects": [{"name": n, "place": p} for n, p in named]}

    assert right(plan, truth, answer("missing", ("coulomb", "mount")))
    assert not right(plan, truth, answer("missing", ("coulomb", "coupling")))
    assert not right(plan, truth, answer("unknown"))
    assert right(plan, Truth((), {}, None), answer("parameters"))
    assert "1 of 1" in table([(plan, True, 9.0)])[0]


@pytest.mark.slow
@pytest.mark.study
def test_coulomb_friction_that_really_sticks_is_named_at_its_joint():
    """Fifty samples in a period, against the laws that are next to it."""
    plan = Plan("coulomb", 1, 0.05)
    truth = made(plan, levels=(1.0, 3.0, 1.6))
    answer = solved(truth, 2, effects=["coulomb", "viscous", "cubic_stiffness"])
    assert right(plan, truth, answer)
    assert answer["fit"]["held_out"]["after"] < 1.1 * answer["fit"]["held_out"]["noise_floor"]


@pytest.mark.slow
@pytest.mark.study
def test_a_play_in_little_noise_is_found_from_far_off():
    """The nominal model is hundreds of noise powers off, and fits of the play begin over short parts of the runs."""
    plan = Plan("backlash", 0, 0.01)
    truth = made(plan)
    assert right(plan, truth, solved(truth, effects=["coulomb", "cubic_stiffness", "backlash", "moving_base"]))


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("kind, draw", [("coulomb", 2), ("backlash", 2), ("coulomb + cubic", 0), ("nothing", 0)])
def test_a_draw_of_a_kind_is_told_right(kind, draw):
    plan = Plan(kind, draw, 0.01)
    truth = made(plan)
    assert right(plan, truth, solved(truth))

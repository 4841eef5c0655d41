"""Known laws for which hidden physics can be taken: found again whatever their size, near or far as they are."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.imitating_laws import (
    APART,
    KIN,
    beside_the_other,
    left_beside,
    of_laws,
    rivals,
)
from pipeline.blind_trial.generators.spring_mass.placement import difference
from pipeline.blind_trial.generators.spring_mass.rig_case import made


def softening(level):
    return made(11, "magnetic_softening", level=level, masses=1, change=0.03)


def test_kin_are_known_pieces_at_such_a_place():
    for name, kin in KIN.items():
        assert all(HIDDEN[k].known and HIDDEN[k].place == HIDDEN[name].place for k in kin)


@pytest.mark.slow
def test_a_law_of_another_size_is_found_again():
    """What is left is how odd its size is: ln 1.5, a standard deviation being a factor e.

    The way there is a bent valley of values: which side of it a fit enters depends on the processor.
    """
    case = made(11, "cubic_stiffness", level=0.01, masses=1, change=0.1)
    law, hiding = case.planted[0], case.hiding
    own = of_laws(hiding.recorder, hiding.values, [replace(law, size=1.5 * law.size)], hiding.trained)
    change = difference(hiding.shown((law,)), own.at_rest)
    assert own.left(change, case.noise) == pytest.approx(np.log(1.5), abs=0.1)


def test_a_law_that_bends_the_other_way_is_near_where_noise_hides_the_rest():
    near, far = (rivals(softening(level))[0] for level in (0.1, 0.001))
    assert (near.name, near.place) == ("cubic_stiffness", "link_0") and near.left < APART
    assert far.left > 5 * near.left


@pytest.mark.slow
@pytest.mark.study
def test_the_truth_of_a_case_says_what_cannot_be_told_from_it():
    told = case_files.truth(softening(0.1))
    assert told["class"] == "foreign" and told["left"] < APART
    assert told["effects"][0]["alike"] == [{"name": "cubic_stiffness", "place": "link_0"}]


@pytest.mark.parametrize("hidden", [
    pytest.param("impact", marks=(pytest.mark.slow, pytest.mark.study)), "parametric_stiffness"])
def test_what_has_no_kin_is_taken_for_nothing(hidden):
    case = made(11, hidden, level=0.1, masses=1, change=0.1)
    assert rivals(case) == [] and case_files.truth(case)["left"] == min(case.left)


@pytest.mark.slow
@pytest.mark.study
def test_of_a_pair_each_leaves_what_the_other_alone_cannot_explain():
    """A gap is another cubic spring, nearly."""
    pair = made(12, ("cubic_stiffness", "backlash"), (0, 0), level=0.05, masses=1, change=0.05)
    spring, gap = beside_the_other(pair)
    assert spring <= pair.left[0] and 5 < gap < 0.9 * pair.left[1]
    assert case_files.truth(pair)["left"] == pytest.approx(gap)


@pytest.mark.slow
@pytest.mark.study
def test_of_a_pair_far_above_the_noise_nothing_is_refitted():
    pair = made(12, ("cubic_stiffness", "backlash"), (0, 0), level=0.001, masses=1, change=0.05)
    assert beside_the_other(pair) == pair.left


def test_what_a_piece_leaves_beside_named_laws():
    """Nothing beside itself, nearly all beside a faulty sensor; what the generator cannot make explains nothing."""
    case = made(11, "cubic_stiffness", level=0.05, masses=1, change=0.1)
    assert left_beside(case, [("cubic_stiffness", "link_0")]) < APART
    beside = left_beside(case, [("sensor_delay", "x_0")])
    assert APART < beside <= case.left[0] * 1.01
    both = left_beside(case, [("sensor_delay", "x_0"), ("cubic_stiffness", "link_0")])
    assert both < APART
    assert left_beside(case, [("lugre", "link_0")]) == left_beside(case, [("backlash", "link_7")]) == np.inf

"""Records that separate what published lists leave: checks that undo alternatives, outcomes that differ."""

import numpy as np
import pytest

from pipeline.diagnosis.experiment_design.next_lists import Check, best_check, best_outcome
from pipeline.diagnosis.experiment_design.next_run import Rival
from pipeline.diagnosis.published.frequency_lists import Alternative, Features, list_problem
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.planning.experiment_choice import divergence, predicted
from tests.diagnosis.solving import solved

STD = 5.0
MODEL = {"one": 200.0, "two": 700.0, "three": 1600.0}
WRONG, RISE = "mis_paired at two", "rise at modes"


def asked():
    """Lines of which the last lies low: of another mode, or all fall the more the higher they lie."""
    features = {n: Features("frequency", "Hz", [f - 60.0 * (n == "three")], [STD]) for n, f in MODEL.items()}
    lists = {n: np.array([f]) for n, f in MODEL.items()}
    return list_problem(features, lists, [
        Alternative("mis_paired", "two", {"three": np.array([1540.0])}, "sensor"),
        Alternative("rise", "modes", {n: f * (1 - 0.05 * f / 1600) for n, f in lists.items()}, "numerics"),
        Alternative("unlisted", "three", {"three": np.array([1540.0])}, "sensor")])


def rivals(given, names, shares=(0.5, 0.5)):
    """Rivals whose alternatives hold whole."""
    noises = [given.budget[run.name] for run in given.problem.runs]
    fits = {c.name: linearised(given.problem, noises, c, [c.parameters[0].prior.latent(1.0)], given.problem.runs)
            for c in given.candidates}
    return [Rival(name, share, fits[name]) for name, share in zip(names, shares, strict=True)]


@pytest.mark.exact
def test_a_check_moves_the_lines_by_the_share_of_what_it_undoes():
    """KL by hand: the mesh moves line f by -0.05 f^2 / 1600 under one, by nothing under the other."""
    given = asked()
    own = rivals(given, (WRONG, RISE))
    found = best_check(given, own, {"mesh": Check(("rise",))})
    moves = -0.05 * np.array(list(MODEL.values())) ** 2 / 1600 / STD
    prior, latent = own[1].fit.hypothesis.parameters[0].prior, own[1].fit.latent[0]
    slope = (prior.value(latent + 1e-4) - prior.value(latent - 1e-4)) / 2e-4
    fall = predicted(moves, slope * moves[:, None], own[1].fit.covariance())
    none = predicted(0 * moves, np.zeros((3, 1)), np.eye(1))
    assert found.condition == "mesh" and set(found.separates) == {WRONG, RISE}
    assert found.value == pytest.approx(0.25 * (divergence(fall, none) + divergence(none, fall)), rel=1e-3)


def test_shapes_tell_which_of_two_modes_it_is_and_frequencies_do_not():
    given = asked()
    own = rivals(given, (WRONG, "unlisted at three"))
    pairs = ("mis_paired", "unlisted")
    assert best_check(given, own, {"frequency": Check(pairs)}) is None
    assert best_check(given, own, {"shapes": Check(pairs, True)}).value > 5
    both = {"frequency": Check(pairs), "shapes": Check(pairs, True), "mesh": Check(("rise",))}
    assert best_check(given, own, both).condition == "shapes"


def test_a_check_of_what_no_rival_holds_tells_nothing():
    given = asked()
    assert best_check(given, rivals(given, (WRONG, "unlisted at three")), {"mesh": Check(("rise",))}) is None


@pytest.mark.exact
def test_sure_outcomes_differ_by_half_the_squared_distance():
    own = rivals(asked(), (WRONG, RISE), (0.8, 0.2))
    found = best_outcome(own, {"load": {WRONG: np.array([0.0, 3.0]), RISE: np.array([4.0, 0.0])},
                               "speed": {WRONG: np.zeros(2), RISE: np.ones(2)}})
    assert found.condition == "load" and found.value == pytest.approx(2 * 0.8 * 0.2 * 12.5)
    assert best_outcome(own, {"load": {WRONG: np.zeros(2), RISE: np.zeros(2)}}) is None


def test_the_diagnosis_of_a_list_gives_such_rivals():
    found = solved(asked(), draws=2000)
    assert {w.candidate.name for w in found.weighed} == {WRONG, RISE, "unlisted at three"}

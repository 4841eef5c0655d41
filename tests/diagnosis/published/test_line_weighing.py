"""Weighing hypotheses: Bayes factors against closed forms, and what draws near the lines have in common."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.diagnosis.published.line_hypotheses import FALLING, LOADING, Drawn, Hypothesis
from pipeline.diagnosis.published.line_tests import BenchTests
from pipeline.diagnosis.published.line_weighing import predicted, weighed
from pipeline.inference.decision.line_evidence import Band, Heard

LINES, READING, BAND, ERROR = np.array([8e3, 11e3]), 50.0, Band(1e3, 20e3, 0.1, 0.05), 0.01
GIVEN = SimpleNamespace(low=BAND.low, high=BAND.high, unexplained=BAND.unexplained, elsewhere=BAND.elsewhere,
                        heard=(0.5, 0.5), model_error=ERROR, reference="one_way", seed=1)
#: two lines in a cycle, and a silent test at constant load
TESTS = BenchTests(("cycle", "constant load"), np.arange(2), np.full(2, 8.0), np.arange(2), np.array([True, False]),
                   Heard(LINES, np.array([[1, 0], [1, 0]])), READING)


def hypothesis(disc, offset, count=400, silent=True, seed=0, harmonics=False, least=1.0):
    """Predicted of draws with one mode each near either line, which grow where a ``stiffness`` exceeds ``least``."""
    rng = np.random.default_rng(seed)
    stiffness = rng.lognormal(0, 0.3, count)
    values = np.column_stack((stiffness, rng.uniform(0.5, 2, count), np.zeros(count), np.zeros(count)))
    drawn = Drawn(("stiffness", "idle", FALLING, LOADING), values, ())
    growth = 200 * (stiffness - least)
    cycle = [np.array([g + 2j * np.pi * (f + offset) for f in LINES]) for g in growth]
    roots = [[of, np.empty(0, complex) if silent else of] for of in cycle]
    return predicted(Hypothesis(disc=disc, harmonics=harmonics), drawn, roots, TESTS, 20e3, ERROR)


def fields(**hypotheses):
    return weighed(hypotheses, TESTS, GIVEN)


@pytest.mark.exact
def test_the_evidence_of_one_set_of_tones_is_a_closed_form():
    made = fields(one_way=hypothesis("rigid", 4e3), flexible_disc=hypothesis("flexible", 0.0))
    grows = np.mean(hypothesis("flexible", 0.0).drawn.column("stiffness") > 1)
    mean, missed = np.log(2), 0.5 * (1 - BAND.elsewhere)
    background, std = BAND.unexplained / 19e3 / 3, np.hypot(ERROR * LINES, READING)
    cycle_alone = mean * missed / (1 - missed) / (np.sqrt(2 * np.pi) * std)
    own = np.exp(-2 * mean - BAND.unexplained) * np.prod(cycle_alone + background)
    none = np.exp(-BAND.unexplained) * background**2
    assert made["evidence"][1] == pytest.approx(np.log(grows * own + (1 - grows) * none), rel=1e-9)
    assert made["evidence"][2] == pytest.approx(np.log(none), rel=1e-9)
    assert made["flexible"] == pytest.approx(made["factor"][1], rel=1e-12) and made["factor"][0] == 0
    assert made["flexible"] > np.log(100) and made["verdict"] == "flexible"


def test_nothing_favours_either_disc_where_both_predict_the_same():
    made = fields(one_way=hypothesis("rigid", 0.0), flexible_disc=hypothesis("flexible", 0.0, seed=5))
    assert abs(made["flexible"]) < 4 * made["flexible_error"] < 1
    assert np.mean(abs(made["simulated"][:2]) > np.log(10)) < 0.01
    assert made["confusion"][0][-1] > 0.9 and made["verdict"] == "undecided"


def test_where_growing_tones_are_elsewhere_unexplained_lines_are_named():
    made = fields(one_way=hypothesis("rigid", 4e3, least=0.0), flexible_disc=hypothesis("flexible", 2e3, least=0.0))
    growing = 2 * np.log(2)
    np.testing.assert_allclose(made["evidence"][2] - made["evidence"][:2], growing, rtol=1e-6)
    assert made["verdict"] == "undecided"
    loud = SimpleNamespace(**{**vars(GIVEN), "heard": (0.9, 0.9)})
    both = {"one_way": hypothesis("rigid", 4e3, silent=False, least=0.0),
            "flexible_disc": hypothesis("flexible", 2e3, silent=False, least=0.0)}
    assert weighed(both, TESTS, loud)["verdict"] == "none"


def test_silence_counts_against_tones_at_constant_load():
    made = fields(one_way=hypothesis("rigid", 0.0, silent=False), flexible_disc=hypothesis("flexible", 0.0))
    assert made["lines_alone"][0] == pytest.approx(made["lines_alone"][1], rel=1e-12)
    assert made["silence"][0] < 0.7 < 0.9 < made["silence"][1] and made["flexible"] > 1


def test_what_draws_near_the_lines_need_is_found():
    made = fields(one_way=hypothesis("rigid", 4e3), flexible_disc=hypothesis("flexible", 0.0))
    stiffness, idle = (made["column"].index(c) for c in ("stiffness", "idle"))
    grows = np.mean(made["value"][1][:, stiffness] > 1)
    np.testing.assert_allclose(made["near"][1], grows)
    assert not made["near"][0].any() and not made["near"][2].any()
    assert (made["target_shift"][1, :, stiffness] > 5).all() and (abs(made["target_shift"][1, :, idle]) < 4).all()
    assert made["target_quantile"][1, 0, stiffness, 0] > 1 > made["all_quantile"][1, stiffness, 0]
    np.testing.assert_allclose(made["line_growth"][1, :, 0], 200 * (made["value"][1][:, stiffness] - 1))
    np.testing.assert_allclose(made["line_growth"][0, :, 1], -2 * np.pi * LINES[1])


def test_tones_are_listed_by_hypothesis_and_draw():
    made = fields(one_way=hypothesis("rigid", 4e3), flexible_disc=hypothesis("flexible", 0.0))
    own = made["tone_hypothesis"] == 1
    grows = made["value"][1][:, 0] > 1
    np.testing.assert_array_equal(np.unique(made["tone_draw"][own]), np.flatnonzero(grows))
    np.testing.assert_allclose(np.unique(made["tone"][own]), LINES)

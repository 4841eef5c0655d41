"""Every number of a result from a few cases whose numbers can be counted by hand."""

import json

import pytest

from pipeline.blind_trial.metrics.result import claims, confusion, detection, parameters, result, visible
from tests.blind_trial.protocol.small_set import TOLD, TRUTH


@pytest.fixture
def found():
    told = {n: {**a, "cpu_seconds": 10.0 * int(n)} for n, a in TOLD.items()}
    return result({"name": "small", "kind": "open"}, TRUTH, {"diagnosis": told, "b": told})


def test_rates_count_what_belongs_to_them(found):
    rates = found["methods"]["diagnosis"]["rates"]
    assert {name: (one["hits"], one["count"]) for name, one in rates.items()} == {
        "type and place, one effect": (1, 1), "type and place, one effect, forced": (1, 1),
        "type alone, one effect": (1, 1), "truth among the tied, one effect": (0, 1),
        "truth among the first three, one effect": (1, 1), "false alarms": (0, 1), "nothing missing told so": (1, 1),
        "not in the catalogue: unknown": (0, 1), "held out within 1.2 noise floors, named": (2, 2),
        "stated with about 90 %: right": (0, 1), "refused": (0, 3)}
    assert rates["false alarms"]["goal"] == ["at most", 0.03] and rates["refused"]["goal"] == []
    assert found["methods"]["b"]["rates"] == rates


def test_confusion_detection_systems_and_cost(found):
    main = found["methods"]["diagnosis"]
    assert main["confusion"] == {"control": {"parameters": 1}, "effect": {"missing, right": 1},
                                 "foreign": {"missing": 1}}
    assert main["names"] == {"coulomb": {"coulomb": 1}, "magnet": {"coulomb": 1}}
    point, = main["detection"]
    assert (point["noise"], point["low"], point["high"], point["right"]["hits"]) == (0.01, 0.2, 0.4, 1)
    assert main["systems"]["rig"]["named"]["hits"] == 1 and "named" not in main["systems"]["belt"]
    assert main["cost"]["total"] == 60 and main["cost"]["systems"]["rig"] == {"count": 2, "median": 15, "largest": 20}


def test_fitted_values_are_compared_with_the_truth_where_the_verdict_is_right(found):
    values = found["methods"]["diagnosis"]["parameters"]["nominal"]
    assert values["count"] == 1 and values["median_error"] == pytest.approx(0.05)
    assert values["distances"] == [1.25] and values["within_68"]["hits"] == 0 and values["within_95"]["hits"] == 1
    assert found["methods"]["diagnosis"]["parameters"]["effects"] == {"count": 0}


def test_values_of_named_effects_are_compared_too():
    truth, answer, right = case("effect", "missing", ("coulomb", "a", 1.0), right=True)
    truth["effects"][0]["parameters"] = {"force": 2.0, "speed": 0.1}
    answer["effects"][0]["parameters"] = {"force": {"value": 2.2, "std": 0.05}}
    told = parameters([(truth, answer, right)])["effects"]
    assert (told["count"], told["distances"]) == (1, [4.0]) and told["within_95"]["hits"] == 0


def test_values_of_models_that_lack_something_are_counted_apart():
    cases = [case("control", "parameters", right=True), case("effect", "missing", ("coulomb", "a", 1.0), right=True),
             case("foreign", "unknown", right=True), case("below", "parameters", right=True),
             case("effect", "unknown", right=False)]
    for shift, (truth, answer, found) in enumerate(cases, 1):
        truth["parameters"], answer["parameters"] = {"mass": 2.0}, {"mass": {"value": 2.0 + shift, "std": 1.0}}
        found["named"] = found["right"] and truth["class"] == "effect"
    told = parameters(cases)
    assert told["nominal"]["distances"] == [1, 2] and told["lacking"]["distances"] == [3, 4]


def test_only_a_case_that_is_not_right_says_why(found):
    assert [n for n, one in found["cases"].items() if "why" in one["answers"]["diagnosis"]] == ["003"]
    assert json.loads(json.dumps(found, allow_nan=False)) == found


def case(kind, verdict, *named, hidden=("coulomb", "a"), right=False, **more):
    truth = {"class": kind, "effects": [dict(zip(("name", "place"), hidden, strict=True))], "noise": 0.1, **more}
    answer = {"verdict": verdict, "effects": [{"name": n, "place": p, "posterior": q} for n, p, q in named]}
    return truth, answer, {"right": right, "named": right, "type": right}


def test_everything_that_was_named_is_a_claim_of_its_probability():
    assert claims([case("effect", "tie", ("coulomb", "a", 0.6), ("viscous", "a", 0.4)),
                   case("foreign", "missing", ("coulomb", "a", 0.95))]) == [(0.6, True), (0.4, False), (0.95, False)]


def test_a_solver_that_is_named_is_a_claim_that_it_is_wrong():
    """It has no place among what is hidden, which is physics or a sensor."""
    right, wrong = ({**case("control", "numerics", ("time_step", "solver", 1.0))[0], "class": kind, "effects": []}
                    for kind in ("solver", "control"))
    answer = case("control", "numerics", ("time_step", "solver", 1.0))[1]
    assert claims([(right, answer, {}), (wrong, answer, {})]) == [(1.0, True), (1.0, False)]


def test_a_size_without_a_noise_is_in_no_curve():
    truth, answer, judged = case("effect", "missing", right=True, size=0.2)
    del truth["noise"]
    assert detection([(truth, answer, judged)]) == []


def test_an_effect_named_at_another_place_and_abstaining_below_the_threshold():
    elsewhere = case("effect", "missing", ("coulomb", "b", 1.0))
    elsewhere[2]["type"] = True
    assert confusion([elsewhere])["effect"] == {"missing, other place": 1}
    below = case("below", "parameters", size=0.02, right=True)
    below[2]["named"] = False
    assert detection([below])[0]["right"]["hits"] == 0, "to abstain is right, and is no detection"


def test_a_result_tells_what_counts_as_visible_in_its_cases(found):
    told = {n: {**t, **more} for (n, t), more in zip(TRUTH.items(), ({}, {"left": 5.0}, {"left": 9.0, "visible": 7.0}),
                                                    strict=True)}
    assert found["thresholds"] == [] and result({}, told, {"diagnosis": TOLD})["thresholds"] == [4.0, 7.0]


def test_what_is_visible_is_counted_in_bins_of_what_is_left():
    clear, faint, old = (case("effect", "missing", right=True, **left) for left in ({"left": 40.0}, {"left": 3.0}, {}))
    faint[2]["named"] = False
    assert [(b["low"], b["high"], b["right"]["hits"]) for b in visible([clear, faint, old])] == [(2, 4, 0), (32, 64, 1)]

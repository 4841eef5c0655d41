"""Answers of baselines: in the form of a diagnosis."""

from pipeline.blind_trial.baselines.answers import named, nothing
from pipeline.blind_trial.baselines.regression import Term

TERMS = [Term("coulomb", "tie"), Term("cubic_stiffness", "tie"), Term("sensor_offset_drift", "x", "sensor")]


def test_what_is_named_comes_first_and_the_others_are_alternatives():
    found = named(TERMS, 2, dict.fromkeys(TERMS, 0.5))
    assert found["verdict"] == "missing" and [e["name"] for e in found["effects"]] == ["coulomb", "cubic_stiffness"]
    assert found["effects"][0]["posterior"] == 0.5 and found["alternatives"][0]["place"] == "x"


def test_a_sensor_alone_is_the_verdict_of_a_sensor():
    assert named(TERMS[2:])["verdict"] == "sensor" and nothing() == {
        "verdict": "parameters", "effects": [], "alternatives": []}

"""What decides answers and scores, and what does not."""

from pipeline import effects
from pipeline.blind_trial.protocol import code_digest


def test_answers_depend_on_the_diagnosis_and_scores_on_the_judging_and_neither_on_views_or_generators():
    found = code_digest.files()
    assert {"stages/diagnosis.py", "pipeline/inference/decision/decision_rules.py", "pipeline/effects/joint/coulomb.py",
            "pipeline/blind_trial/metrics/criteria.py"} <= set(found)
    assert not [name for name in found if name.startswith(("pipeline/views", "pipeline/trial/", "pipeline/cli"))]
    changed = {**found, "pipeline/blind_trial/metrics/criteria.py": "0"}
    assert code_digest.of_answers(changed) == code_digest.of_answers(found)
    assert code_digest.of_answers({**found, "stages/diagnosis.py": "0"}) != code_digest.of_answers(found)
    assert code_digest.changed(found, {**found, "a.py": "1"}) == ["a.py"] and code_digest.changed(found, found) == []


def test_a_set_records_catalogue_and_thresholds():
    told = code_digest.described()
    assert told["catalogue"] == [e.name for e in effects.CATALOGUE]
    assert told["thresholds"]["decision"]["posterior"] == 0.9
    assert set(told["packages"]) >= {"numpy", "scipy"}

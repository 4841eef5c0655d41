"""What decides answers and scores, and what does not."""

from pipeline import effects
from pipeline.concealed import code


def test_answers_depend_on_the_diagnosis_and_scores_on_the_judging_and_neither_on_views_or_generators():
    found = code.files()
    assert {"stages/diagnosis.py", "pipeline/inference/decision/decision_rules.py", "pipeline/effects/joint/coulomb.py",
            "pipeline/concealed/judging.py"} <= set(found)
    assert not [name for name in found if name.startswith(("pipeline/views", "pipeline/trial/", "pipeline/cli"))]
    assert code.of_answers({**found, "pipeline/concealed/judging.py": "0"}) == code.of_answers(found)
    assert code.of_answers({**found, "stages/diagnosis.py": "0"}) != code.of_answers(found)
    assert code.changed(found, {**found, "a.py": "1"}) == ["a.py"] and code.changed(found, found) == []


def test_a_set_records_catalogue_and_thresholds():
    told = code.described()
    assert told["catalogue"] == [e.name for e in effects.CATALOGUE] and told["thresholds"]["posterior"] == 0.9
    assert set(told["packages"]) >= {"numpy", "scipy"}

"""Stage diagnosis: from products to a verdict; what it refuses before it computes."""

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from stages.bench import bench
from stages.diagnosis import Settings, diagnosis
from tests.diagnosis.small_rig import HIDDEN, effects, laid_out, model, recording
from tests.diagnosis.test_answer import ASKED


def test_the_stage_names_what_was_hidden():
    given = recording(HIDDEN)
    shown = bench(model(), effects({}), given, settings=laid_out())
    found = diagnosis(model(), effects({}), given, shown, settings=fill(Settings, {**ASKED, "kept": 2}, "diagnosis"))
    assert found.verdict.item() == "missing" and found.effect[found.named[0]] == "cubic_stiffness"
    assert set(found.runs) == set(given.runs)


def test_what_is_known_to_be_there_is_no_longer_missing():
    given = recording(HIDDEN)
    shown = bench(model(), effects(HIDDEN), given, settings=laid_out())
    found = diagnosis(model(), effects(HIDDEN), given, shown, settings=fill(Settings, {**ASKED, "kept": 2}, "d"))
    assert found.verdict.item() == "consistent"


def test_poles_are_asked_for_on_both_sides():
    given = recording()
    shown = bench(model(), effects({}), given, settings=laid_out())
    with pytest.raises(ConfigError, match="diagnosis.forward"):
        diagnosis(model(), effects({}), given, shown, settings=fill(Settings, {**ASKED, "forward": "poles"}, "d"))


def test_an_effect_both_weighed_and_not_is_refused():
    with pytest.raises(ConfigError, match="diagnosis.without"):
        diagnosis.check({"diagnosis": fill(Settings, {"effects": ["coulomb"], "without": ["coulomb"]}, "d")})

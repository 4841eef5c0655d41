"""The question of measured motions: named without any simulation of the runs."""

import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.settings import Settings
from tests.case_models.test_force_balance import BALANCED
from tests.diagnosis.small_rig import HIDDEN, laid_out, model, recording

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
         "held_out": ["level_4"], "noise": {"std": {"force on block": "0.2 N"}},
         "effects": ["cubic_stiffness", "coulomb", "quadratic_damping", "moving_base"]}


def asked(hidden=None, **more):
    settings = laid_out(**BALANCED)
    return force_balance_problem(benches.built(model(), settings), recorded(recording(hidden, noise=1e-5), settings),
                    fill(Settings, {**ASKED, **more}, "diagnosis"), settings.equation)


def test_cubic_stiffness_is_named_with_its_value():
    given = asked(HIDDEN)
    found = given.solved()
    assert found.decision.verdict == "missing" and found.named[0].candidate.effects == (("cubic_stiffness", "mount"),)
    assert found.named[0].fit.values["cubic_stiffness@mount.coefficient"] == pytest.approx(15000.0, rel=0.02)
    assert "give all 2 coordinates" in found.failures["moving_base at mount"], "a base that is not measured"


def test_the_noise_is_that_of_the_forces():
    found = asked()
    assert found.units == {"force on block": "N"} and found.budget["level_1"].std == pytest.approx([0.2])
    with pytest.raises(ConfigError, match="noise.std"):
        asked(noise={"std": {"x": "0.2 mm"}})


def test_the_place_and_the_size_of_the_missing_force_are_told():
    given = asked(HIDDEN)
    found = given.solved()
    axes = given.locator.located(found)
    assert axes["place"][0].significant() == ("block",) and {"stage", "run", "band"} <= set(axes)
    told = given.latent.described(found, axes)
    assert told.location == "block" and {"amplitude", "velocity", "time"} <= set(told.regimes)
    follows = {f.name: f.p_value for f, _ in told.follows}
    assert follows["displacement"] <= 0.01, "a cubic spring follows the displacement"


def test_where_nothing_is_missing_no_place_is_told_and_no_force():
    given = asked(effects=["cubic_stiffness", "coulomb"])
    found = given.solved()
    axes = given.locator.located(found)
    assert not axes["place"][0].significant() and given.latent.described(found, axes) is None

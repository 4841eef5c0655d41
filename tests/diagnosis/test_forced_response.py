"""The question of forced recordings, and what it refuses."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.settings import Settings
from pipeline.inference.priors import HalfNormal
from tests.diagnosis.small_rig import HIDDEN, laid_out, model, recording

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}}, "held_out": ["level_4"],
         "noise": {"std": {"x": "0.2 mm"}}}


def asked(shown=None, **more):
    return forced_problem(benches.built(model(), laid_out()), recorded(shown or recording(), laid_out()),
                    fill(Settings, {**ASKED, **more}, "diagnosis"))


def test_the_question_holds_runs_noise_parameters_and_candidates():
    found = asked(effects=["cubic_stiffness", "sensor_gain"])
    assert [r.name for r in found.problem.held_out] == ["level_4"] and len(found.problem.training) == 3
    assert [c.kind for c in found.candidates] == ["physics", "sensor", "numerics"]
    assert found.budget["level_1"].std == pytest.approx([2e-4]) and found.units == {"x": "m"}
    assert found.problem.nominal.parameters[0].nominal == 400.0


def test_effects_can_be_left_out():
    names = {c.effects[0][0] for c in asked(without=["coulomb"], solver=False).candidates}
    assert "coulomb" not in names and "cubic_stiffness" in names and "time_step" not in names


def test_stated_priors_of_effects_take_the_place_of_typical_ones():
    given = {"prior": "half_normal", "std": "3 mm/N"}
    found = asked(effects=["compliant_arm"], solver=False, priors={"compliant_arm.compliance": given})
    parameter, _ = found.candidates[0].parameters
    assert parameter.prior == HalfNormal(3e-3) and parameter.null == 0.0


def test_the_limit_of_a_channel_is_looked_for_where_its_largest_samples_lie():
    limit, = asked(effects=["clipping"], solver=False).candidates[0].parameters
    largest = max(abs(recording().runs[f"level_{k}"].channels["x"].samples).max() for k in (1, 2, 3))
    assert 1 / limit.prior.scale == pytest.approx(largest, rel=1e-12)


def test_runs_that_could_be_next_come_with_their_noise():
    found = asked(next={"shaker": [2.0]}, effects=["coulomb"])
    run, = found.next_runs
    assert run.name == "shaker x 2" and found.budget[run.name] is found.budget["level_1"]
    values = found.problem.nominal.values(found.problem.nominal.nominal)
    once, twice = (found.problem.predict(found.problem.nominal, values, r) for r in (found.problem.runs[0], run))
    np.testing.assert_allclose(twice, 2 * once, rtol=1e-9, atol=1e-12)


def reassembled(hidden=None):
    """Recording of the rig whose mount was another one in every run, within 1 %."""
    whole = recording(hidden)
    for name, stiffness in zip(whole.runs, (400, 404, 397, 402), strict=True):
        other = recording(hidden, corrections={"joints.mount.stiffness": f"{stiffness} N/m"})
        whole.runs[name] = other.runs[name]
    return whole


def test_values_that_differ_between_runs_hide_nothing_and_are_no_missing_effect():
    """Without them the same records are unknown: no single stiffness predicts all runs."""
    more = {"parameters": {"joints.mount.stiffness": {"spread": 0.1, "between_runs": 0.01},
                           "joints.mount.damping": {"spread": 0.3}},
            "effects": ["cubic_stiffness", "coulomb"], "solver": False}
    question = asked(reassembled(), **more)
    same = question.solved()
    assert same.decision.verdict == "consistent"
    fitted, held_out = np.array(product(question, same).fit)
    assert fitted[1] < 1.1 * fitted[3] and held_out[1] < 1.1 * held_out[3], "each run is shown with its own value"
    own = same.completed.values
    assert [own[f"between_runs@level_{k}.joints.mount.stiffness"] * own["joints.mount.stiffness"]
            for k in (1, 2, 3)] == pytest.approx([400, 404, 397], abs=0.3)
    told = asked(reassembled(HIDDEN), **more).solved()
    assert told.decision.verdict == "missing" and [c.name for c in told.decision.named] == ["cubic_stiffness at mount"]
    assert told.named[0].fit.values["cubic_stiffness@mount.coefficient"] == pytest.approx(15000, rel=0.01)


@pytest.mark.parametrize("more, said", [
    ({"parameters": {"joints.mount.stiffness": {"between_runs": "1 kg"}}}, "stiffness.between_runs"),
    ({"parameters": {"joints.mount.stiffness": {"between_runs": 2.0}}}, "stiffness.between_runs.*share"),
    ({"priors": {"compliant_arm.stiffness": {}}}, "diagnosis.priors"),
    ({"priors": {"coulomb.force": {"between_runs": 0.1}}}, "diagnosis.priors.coulomb.force.between_runs"),
    ({"next": {"temperature": ["20 K"]}}, "diagnosis.next.temperature"),
    ({"held_out": ["level_9"]}, "diagnosis.held_out"), ({"effects": ["magic"]}, "diagnosis.effects"),
    ({"parameters": {"joints.mount.stifness": {}}}, "diagnosis.parameters.*do you mean joints.mount.stiffness"),
    ({"noise": {"std": {"x": "1 kg"}}}, "diagnosis.noise.std.x"),
    ({"noise": {"std": {"y": "1 mm"}}}, "noise.std.*y"), ({"noise": {}}, "noise"),
    ({"held_out": ["level_1", "level_2", "level_3", "level_4"]}, "at least one run to fit")])
def test_wrong_questions_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        asked(**more)

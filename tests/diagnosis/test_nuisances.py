"""Hidden values of a rig that a case declares: families, and diagnoses beside them."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.files import as_json
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.settings import Settings
from tests.case_models.test_force_balance import BALANCED
from tests.diagnosis.small_rig import HIDDEN, effects, laid_out, model, recording

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
         "held_out": ["level_4"], "noise": {"std": {"x": "0.2 mm"}}, "solver": False,
         "effects": ["cubic_stiffness", "coulomb", "quadratic_stiffness"]}
#: a magnet every 30 mm, of which a case knows the distance alone
COGGING = {"cogging": {"mount": {"sine": "0 N", "cosine": "0 N", "period": "30 mm"}}}
STRONG = {"cogging": {"mount": {"sine": "2 N", "cosine": "-1 N", "period": "30 mm"}}}
#: levels of shaking, the last of them held out
THREE = (2.0, 9.0, 7.0)


def asked(shown, stated=None, **more):
    bench = with_effects(benches.built(model(), laid_out()), effects(stated or {}))
    return forced_problem(bench, recorded(shown, laid_out()), fill(Settings, {**ASKED, **more}, "diagnosis"))


def found(told, name, true, size=4.0):
    """Whether a value lies within standard deviations of the ``true`` one."""
    return abs(told.completed.values[name] - true) < size * told.completed.spread(told.weights)[name]


def test_families_have_priors_of_the_sizes_of_the_rig():
    declared = asked(recording(), nuisances=["loads", "zeros", "drifts"]).nuisances
    (load,), (zero,), (drift,) = (one.parameters for one in declared)
    assert (load.name, load.unit, zero.name, zero.unit, drift.name, drift.unit) == (
        "loads.mount", "N", "channels.x.offset", "m", "channels.x.drift", "m/s")
    assert load.prior.scale >= 9.8, "a block of 1 kg may hang"
    shown = max(np.std(recording().runs[f"level_{k}"].channels["x"].samples) for k in (1, 2, 3))
    assert zero.prior.scale == pytest.approx(shown, rel=0.05)
    assert drift.prior.scale == pytest.approx(zero.prior.scale / 5.995)


def test_what_the_case_fits_anyway_is_no_nuisance():
    given = {**ASKED["parameters"], "loads.mount": {"prior": "normal", "std": "1 N"}}
    assert not asked(recording(), nuisances=["loads"], parameters=given).nuisances


def test_a_forgotten_weight_does_not_hide_a_cubic_spring():
    """The block hangs: without a word of its weight its spring seems to be unsymmetric."""
    shown = recording(HIDDEN, THREE, corrections={"loads.mount": "-9.81 N"})
    problem = asked(shown, nuisances=["loads", "zeros"], held_out=["level_3"])
    told = problem.solved()
    assert [c.name for c in told.decision.named] == ["cubic_stiffness at mount"], told.decision.reasons
    assert found(told, "loads.mount", -9.81) and found(told, "cubic_stiffness@mount.coefficient", 15000.0)
    answer = as_json(product(problem, told))
    assert answer["verdict"] == "missing"
    assert any("fitted beside every hypothesis: loads.mount" in why for why in answer["reasons"])


def test_a_zero_that_is_off_is_no_missing_effect():
    told = asked(recording(corrections={"channels.x.offset": "3 mm", "channels.x.drift": "0.2 mm/s"}),
                 nuisances=["zeros", "drifts"]).solved()
    assert told.decision.verdict in ("consistent", "parameters"), told.decision.reasons
    assert found(told, "channels.x.offset", 3e-3) and found(told, "channels.x.drift", 2e-4)


def test_cogging_of_a_known_period_is_fitted_beside_a_law():
    both = {**STRONG, "coulomb": {"mount": {"force": "1 N"}}}
    told = asked(recording(both, THREE), COGGING, nuisances=["cogging"], held_out=["level_3"],
                 effects=["cubic_stiffness", "coulomb"]).solved()
    assert [c.name for c in told.decision.named] == ["coulomb at mount"], told.decision.reasons
    assert found(told, "cogging@mount.sine", 2.0) and found(told, "cogging@mount.cosine", -1.0)
    assert found(told, "coulomb@mount.force", 1.0)


def test_balances_of_forces_have_them_too():
    settings = laid_out(**BALANCED)
    shown = recording(HIDDEN, noise=1e-5, corrections={"loads.mount": "-4 N"})
    asked_of = {**ASKED, "noise": {"std": {"force on block": "0.2 N"}}, "nuisances": ["loads"]}
    told = force_balance_problem(benches.built(model(), settings), recorded(shown, settings),
                                 fill(Settings, asked_of, "diagnosis"), settings.equation).solved()
    assert [c.name for c in told.decision.named] == ["cubic_stiffness at mount"], told.decision.reasons
    assert found(told, "loads.mount", -4.0)


def test_cogging_without_a_period_is_refused():
    with pytest.raises(ConfigError, match="nuisances: cogging.*period"):
        asked(recording(), nuisances=["cogging"])

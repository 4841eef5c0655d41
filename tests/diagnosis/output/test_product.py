"""The product of a diagnosis: rows, errors and runs are those of the inference."""

from functools import cache

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.files import as_json, completed_name
from pipeline.diagnosis.output.product import located, product
from pipeline.diagnosis.settings import Settings
from pipeline.inference.fitting.parameter_drift import spread
from pipeline.inference.search.localisation import against_null
from tests.diagnosis.small_rig import HIDDEN, NOISE, laid_out, model, recording
from tests.diagnosis.solving import diagnosis_product, solved

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.2}},
         "held_out": ["level_4"], "noise": {"std": {"x": f"{NOISE} m"}}, "draws": 2000,
         "effects": ["cubic_stiffness", "quadratic_stiffness", "coulomb", "sensor_gain"]}


@cache
def told(hidden=True, stiffness=None):
    given = recording(HIDDEN if hidden else None, corrections=None if stiffness is None else
                      {"joints.mount.stiffness": stiffness})
    return asked_of(given, ASKED)


def asked_of(given, section):
    """Product Diagnosis of a Recording under a section ``diagnosis``."""
    settings = fill(Settings, section, "d")
    return diagnosis_product(forced_problem(benches.built(model(), laid_out()), recorded(given, laid_out()), settings),
                             kept=3)


def test_the_hidden_effect_is_named_with_its_value():
    found = told()
    row, = found.named
    assert found.verdict.item() == "missing" and found.effect[row] == "cubic_stiffness" and found.place[row] == "mount"
    k = list(found.parameter_owner).index(row)
    assert abs(found.parameter_value[k] - 1.5e4) < 4 * found.parameter_std[k] < 1.5e3
    assert found.posterior.sum() == pytest.approx(1.0, abs=1e-6) and found.posterior[row] > 0.9


def test_errors_fall_from_nominal_to_completed_and_reach_the_noise():
    for row, part in enumerate(("training", "held out")):
        before, recalibrated, after, noise = told().fit[row]
        assert before >= recalibrated > 3 * after and after == pytest.approx(noise, rel=0.2), part
    assert told().unexplained_share < 0.05
    run = told().runs["level_4"]
    assert run.held_out == 1 and run.error[2] == pytest.approx(told().fit[1, 2])
    assert np.std(run.measured - run.completed) == pytest.approx(NOISE, rel=0.1)


def test_two_effects_are_both_named_and_their_probabilities_sum_to_one():
    given = recording({**HIDDEN, "coulomb": {"mount": {"force": "0.3 N"}}}, levels=(1.0, 3.0, 2.5))
    found = asked_of(given, {**ASKED, "held_out": ["level_3"], "solver": False,
                             "effects": ["cubic_stiffness", "coulomb", "sensor_gain"]})
    (known,), (named,) = found.known, found.named
    assert found.verdict.item() == "missing" and {found.effect[known], found.effect[named]} == {
        "cubic_stiffness", "coulomb"}
    assert len(set(found.hypothesis)) == len(found.hypothesis) and found.hypothesis[0] == "nothing missing"
    assert found.posterior.sum() == pytest.approx(1.0, abs=1e-9) and found.posterior[named] > 0.9
    values = dict(zip(found.parameter, found.parameter_value, strict=True))
    assert values["cubic_stiffness@mount.coefficient"] == pytest.approx(1.5e4, rel=0.01)
    assert values["coulomb@mount.force"] == pytest.approx(0.3, rel=0.05)
    effects = {e["name"]: e["posterior"] for e in as_json(found)["effects"]}
    assert set(effects) == {"cubic_stiffness", "coulomb"} and min(effects.values()) > 0.9
    assert completed_name(found, "rig") == "rig_with_cubic_stiffness_and_coulomb.yaml"


def test_nothing_missing_and_wrong_values():
    assert told(hidden=False).verdict.item() == "consistent" and not len(told(hidden=False).named)
    found = told(hidden=False, stiffness="430 N/m")
    assert found.verdict.item() == "parameters"
    assert abs(found.parameter_value[0] - 430.0) < 4 * found.parameter_std[0]


def test_where_nothing_is_named_values_are_as_uncertain_as_what_is_missing():
    given = recording(HIDDEN, levels=(2.0, 9.0, 7.0))
    asked = forced_problem(benches.built(model(), laid_out()), recorded(given, laid_out()), fill(
        Settings, {**ASKED, "held_out": ["level_3"], "solver": False, "effects": ["coulomb", "quadratic_stiffness"]},
        "d"))
    found = solved(asked, kept=2)
    written, null = product(asked, found), found.null
    assert written.verdict.item() == "unknown" and list(written.parameter) == list(null.values)
    better = [w.fit for w in found.weighed if w.fit.objective < null.objective]
    assert better and np.all(null.chi_square > 10 * null.counts)
    for name, std in zip(written.parameter, written.parameter_std, strict=True):
        apart = max(abs(fit.values[name] - null.values[name]) for fit in better)
        assert apart / np.sqrt(1 + len(better)) < std < apart + 2 * spread(null, null.weights)[name]


def test_an_axis_of_names_and_one_of_bins():
    axis = against_null(("a", "b"), [3.0, 0.0], np.random.default_rng(1).standard_normal((500, 2)))
    assert list(located(axis).item) == ["a", "b"] and located(axis).unit == ""
    assert located(axis, "Hz", [(0, 1), (1, 2)]).high.tolist() == [1, 2]

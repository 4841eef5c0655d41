"""Before the bench: d of planned runs against its closed form, and the cheapest set."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.campaign_planning import channel_units, conclusion, plan, planned_runs, table
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.small_rig import laid_out, model

RUN = {"duration": "4 s", "sample_rate": "100 Hz"}
ASKED = {"noise": {"std": {"x": "1 mm"}}, "parameters": {"joints.mount.stiffness": {"spread": 0.1}},
         "effects": ["cubic_stiffness", "sensor_gain", "coulomb"], "plan": {"runs": {
             "small": {**RUN, "inputs": {"shaker": {"amplitude": "0.5 N"}}},
             "large": {**RUN, "inputs": {"shaker": {"amplitude": "8 N"}}, "cost": 2}}}}


def planned(**more):
    bench = benches.built(model(), laid_out())
    return plan(bench, channel_units(bench), fill(Settings, {**ASKED, **more}, "diagnosis"))


@pytest.fixture(scope="module")
def found():
    return planned()


def test_a_large_run_sees_a_cubic_spring_and_a_small_one_does_not(found):
    row = found.effects.index("cubic_stiffness at mount")
    assert found.power[found.runs.index("large"), row] > 4 > found.power[found.runs.index("small"), row]
    assert (found.whole >= found.power.max(axis=0) - 1e-9).all()


def test_the_cheapest_set_covers_what_is_wanted():
    found = planned(plan={**ASKED["plan"], "wanted": ["cubic_stiffness"]})
    assert found.chosen == ("large",) and found.cost == 2 and not found.missed
    assert found.together[found.effects.index("cubic_stiffness at mount")] >= 4


def test_what_is_out_of_reach_is_told():
    small = {"runs": {"small": ASKED["plan"]["runs"]["small"]}, "wanted": ["cubic_stiffness"]}
    found = planned(plan=small, noise={"std": {"x": "1 m"}})
    assert found.missed == ("cubic_stiffness at mount",) and "out of reach: cubic" in conclusion(found)


def test_d_falls_with_the_noise_where_nothing_hides_it():
    """Without parameters d is proportional to 1 / noise."""
    one, ten = (planned(parameters={}, noise={"std": {"x": f"{n} mm"}}).power for n in (1, 10))
    np.testing.assert_allclose(one, 10 * ten, rtol=1e-9)


def test_a_size_that_is_known_otherwise_is_planned_with():
    """Friction far below what moves slides all the time: ten times the force is seen ten times as well."""
    faint, weak = (planned(priors={"coulomb.force": {"prior": "uniform", "low": "0 N", "high": f"{force} mN"}},
                           effects=["coulomb"], parameters={}).power for force in (1, 10))
    np.testing.assert_allclose(weak, 10 * faint, rtol=0.05)


def test_the_table_has_a_row_an_effect(found):
    head, rows = table(found)
    assert head == ("effect", "small", "large", "all", "chosen") and [r[0] for r in rows] == list(found.effects)


def test_a_sweep_ends_at_its_frequency():
    runs = planned_runs(benches.built(model(), laid_out()), fill(Settings, ASKED, "d").plan)
    signal, time = runs["large"].inputs["shaker"], runs["large"].time
    crossings = np.flatnonzero(np.diff(np.sign(signal)))
    assert 0.5 / np.diff(time[crossings])[-3:].mean() == pytest.approx(10.0, rel=0.05) and abs(signal).max() <= 8


@pytest.mark.parametrize("more, said", [
    ({"plan": {}}, "diagnosis.plan.runs"), ({"noise": {}}, "diagnosis.noise.std"),
    ({"plan": {**ASKED["plan"], "wanted": ["magic"]}}, "diagnosis.plan.wanted"),
    ({"plan": {"runs": {"a": {**RUN, "inputs": {"hammer": {"amplitude": "1 N"}}}}}}, "plan.runs.a.inputs")])
def test_wrong_plans_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        planned(**more)

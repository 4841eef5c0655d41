"""Stage diagnosis: from products to a verdict; what it refuses before it computes."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

from pipeline.contract import ConfigError, ConvergenceError
from pipeline.contract.documents import yaml_text
from pipeline.contract.settings import fill
from pipeline.diagnosis.output.files import as_json, completed
from stages.bench import bench
from stages.diagnosis import Settings, diagnosis
from tests.diagnosis import decays
from tests.diagnosis.output.test_product import ASKED
from tests.diagnosis.small_rig import FINE, HIDDEN, effects, laid_out, model, recording

#: shaking at which the hidden effects are small: fits stay near and quick
GENTLE = (1.0, 1.5, 2.0, 1.7)
SENSORS = ["cubic_stiffness", "clipping", "sensor_delay"]


def told(given, nothing=None, **asked):
    """Product Diagnosis of recordings of the rig through both stages; ``nothing`` is the section bench."""
    laid_out_so = laid_out() if nothing is None else nothing
    shown = bench(model(), effects({}), given, settings=laid_out_so)
    return diagnosis(model(), effects({}), given, shown,
                     settings=fill(Settings, {**ASKED, "solver": False, "kept": 2, **asked}, "diagnosis"))


def test_the_stage_names_what_was_hidden():
    given = recording(HIDDEN)
    shown = bench(model(), effects({}), given, settings=laid_out())
    found = diagnosis(model(), effects({}), given, shown, settings=fill(Settings, {**ASKED, "kept": 2}, "diagnosis"))
    assert found.verdict.item() == "missing" and found.effect[found.named[0]] == "cubic_stiffness"
    assert set(found.runs) == set(given.runs)


def test_what_is_known_to_be_there_is_no_longer_missing():
    """In steps that resolve it; in those of the rig the solver is what differs."""
    given = recording(HIDDEN)
    for step, verdict in ((FINE, "consistent"), ("2.5 ms", "numerics")):
        shown = bench(model(), effects(HIDDEN), given, settings=laid_out(step=step))
        found = diagnosis(model(), effects(HIDDEN), given, shown, settings=fill(Settings, {**ASKED, "kept": 2}, "d"))
        assert found.verdict.item() == verdict


def test_poles_are_asked_for_on_both_sides():
    given = recording()
    shown = bench(model(), effects({}), given, settings=laid_out())
    with pytest.raises(ConfigError, match="diagnosis.forward"):
        diagnosis(model(), effects({}), given, shown, settings=fill(Settings, {**ASKED, "forward": "poles"}, "d"))


def test_an_effect_both_weighed_and_not_is_refused():
    with pytest.raises(ConfigError, match="diagnosis.without"):
        diagnosis.check({"diagnosis": fill(Settings, {"effects": ["coulomb"], "without": ["coulomb"]}, "d")})


@pytest.mark.parametrize("asked", [{"held_out": []}, {"held_out": ["level_4"], "forward": "poles"}])
def test_a_latent_force_predicts_runs_over_time_that_are_held_out(asked):
    with pytest.raises(ConfigError, match="diagnosis.latent_force.predict"):
        diagnosis.check({"diagnosis": fill(Settings, {"latent_force": {"predict": True}, **asked}, "d")})


def test_squeals_are_simulated_where_poles_are_compared():
    with pytest.raises(ConfigError, match="diagnosis.saturated_squeal"):
        diagnosis.check({"diagnosis": fill(Settings, {"saturated_squeal": {"repeats": 3}}, "d")})


@pytest.mark.parametrize("hidden, found", [({"clipping": {"x": {"inverse_limit": 200.0}}}, "clipping"),
                                           ({"sensor_delay": {"x": {"delay": "4 ms"}}}, "sensor_delay")])
def test_a_fault_of_the_measurement_is_told_from_physics(hidden, found):
    answer = told(recording(hidden, levels=GENTLE), effects=SENSORS)
    row, = answer.named
    assert answer.verdict.item() == "sensor" and answer.effect[row] == found


def test_one_run_names_nothing_and_says_so():
    answer = told(recording(HIDDEN, levels=GENTLE[2:3]), held_out=[], effects=["cubic_stiffness", "sensor_gain"])
    assert answer.verdict.item() == "tie" and any("one run only" in why for why in answer.reason)


def test_a_prior_that_excludes_the_data_is_told():
    answer = told(recording(levels=GENTLE, corrections={"joints.mount.stiffness": "470 N/m"}), effects=["sensor_gain"],
                  parameters={"joints.mount.stiffness": {"spread": 0.01}})
    assert answer.verdict.item() == "unknown"
    assert any("the prior of joints.mount.stiffness excludes the data" in why for why in answer.reason)


def test_recordings_that_are_none_or_of_another_system_are_refused():
    given = recording(levels=GENTLE[:1])
    with pytest.raises(ConfigError, match="of which there are none"):
        told(replace(given, runs={}))
    run = given.runs["level_1"]
    other = replace(run, channels={"pressure": run.channels["x"], "force": run.channels["force"]})
    with pytest.raises(ConfigError, match="channels of the recording, of force, pressure"):
        told(replace(given, runs={"level_1": other}))
    bare = replace(run, channels={"x": run.channels["x"]})
    with pytest.raises(ConfigError, match=r"bench.inputs.shaker.channel: expected one of x of run level_1"):
        told(replace(given, runs={"level_1": bare}))


def test_a_nominal_model_that_diverges_is_told():
    with pytest.raises(ConvergenceError, match="unbounded growth"):
        told(recording(levels=GENTLE), laid_out(corrections={"joints.mount.damping": "-500 N s/m"}))


def test_a_free_motion_needs_no_start_and_its_completed_case_states_none():
    """A decay under a law that is not weighed: place and latent force are told with the fitted starts."""
    starts = {"a": (0.1, 0.3), "b": (-0.03, 1.2), "last": (0.02, -1.6)}
    given, std = decays.recording({n: decays.decay(decays.duffing, start, 3.0) for n, start in starts.items()},
                                  "velocity")
    section = laid_out(channels={"x": {"quantity": "velocity", "source": "block"}}, inputs={})
    found = told(given, section, effects=["quadratic_damping"], held_out=["last"],
                 noise={"std": {"x": f"{std!r} m/s"}})
    assert found.verdict.item() == "unknown" and "mount" in found.location["place"].item[0]
    assert set(found.start_run) == {"a", "b"} and set(found.start_unit) == {"m", "m/s"}
    assert not [name for name in found.parameter if "start" in str(name)]
    case = SimpleNamespace(name="rig", document={"bench": {}, "diagnosis": {}})
    assert "start" not in yaml_text(completed(found, case))
    assert "start@" not in json.dumps(as_json(found))

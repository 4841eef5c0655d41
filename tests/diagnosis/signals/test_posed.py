"""From the sections of a case to a problem: values of effects that the case states are nominal ones."""

import json

import numpy as np
import pytest
import yaml

from pipeline.case_models.runs import Recorded
from pipeline.case_models.virtual_rig import Settings as BenchSettings
from pipeline.contract.settings import fill
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.posed import posed
from pipeline.physics.virtual_rig.response import Run, respond
from tests.case_models.test_stated_values import BENCH, FORCE, bench
from tests.cli.bench.rigs import driven
from tests.commands import brakechain


def test_a_wrong_friction_is_a_wrong_value_of_a_balance(tmp_path):
    """The bearing rubs with 0.2 N m, the case says 0.1: told in the answer and in the completed case."""
    for k in range(4):
        driven(tmp_path, f"run_{k}.csv", seed=k, friction=0.2, samples=1200)
    brakechain("new", "mine", *[word for k in range(4) for word in ("--from", f"run_{k}.csv")], cwd=tmp_path)
    case = yaml.safe_load((tmp_path / "mine.yaml").read_text())
    case["effects"] = {"coulomb": {"bearing": {"force": "0.1 N"}}}
    case["lumped"]["springs"]["bearing"]["torsional_damping"] = "0.3 N m s/rad"
    case["diagnosis"]["effects"] = ["coulomb", "cubic_stiffness"]
    case["diagnosis"]["parameters"][FORCE.replace("tie", "bearing")] = {"spread": 0.5}
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(case))
    brakechain("run", "other.yaml", "--until", "diagnosis", cwd=tmp_path)
    answer = json.loads((tmp_path / "data" / "runs" / "other" / "diagnosis.json").read_text())
    assert answer["verdict"] == "parameters", answer["reasons"]
    assert answer["parameters"]["coulomb@bearing.force"]["value"] == pytest.approx(0.2, rel=0.05)
    completed = yaml.safe_load((tmp_path / "data" / "runs" / "other" / "other_with_other_values.yaml").read_text())
    force = completed["effects"]["coulomb"]["bearing"]["force"]["value"]
    assert float(force.split()[0]) == pytest.approx(0.2, rel=0.05)


def test_a_wrong_friction_is_a_wrong_value_of_simulated_runs():
    """The block rubs with 2 N, the case says 1 N; the same law is no candidate at its place, others are."""
    whole, true = bench(coulomb={"tie": {"force": "1 N"}}), bench(coulomb={"tie": {"force": "2 N"}})
    random, time = np.random.default_rng(0), np.arange(400) / 200
    runs = {}
    for name, size, pace in (("a", 5.0, 9.0), ("b", 8.0, 14.0), ("c", 6.0, 25.0), ("d", 10.0, 11.0)):
        run = Run(name, 399 / 200, 200.0, {"pull": size * np.sin(pace * time)})
        shown = respond(true, run)["x"] + 1e-5 * random.standard_normal(400)
        runs[name] = Recorded(run, ("x",), ("m",), shown[None], np.ones((1, 400), bool), "")
    settings = fill(Settings, {"parameters": {FORCE: {"spread": 0.5}, "joints.tie.stiffness": {"spread": 0.1}},
                               "effects": ["coulomb", "cubic_stiffness"], "held_out": ["d"], "solver": False,
                               "noise": {"std": {"x": "10 um"}}}, "diagnosis")
    problem = posed(whole, runs, settings, fill(BenchSettings, BENCH | {"start": "rest"}, "bench"))
    assert [c.name for c in problem.candidates] == ["cubic_stiffness at tie"]
    found = problem.solved()
    assert found.decision.verdict == "parameters"
    assert found.null.values[FORCE] == pytest.approx(2.0, rel=0.01)

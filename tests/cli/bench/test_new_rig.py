"""Command 'new NAME --from FILE': from a file to a diagnosis that runs."""

import json

from tests.cli.bench.rigs import driven
from tests.commands import brakechain


def test_what_it_writes_is_checked_and_runs_to_a_verdict(tmp_path):
    """Dry friction of 0.2 N m beside a damping that the case states: named, without a line changed."""
    for k in range(4):
        driven(tmp_path, f"run_{k}.csv", seed=k, friction=0.2, samples=1500)
    asked = [word for k in range(4) for word in ("--from", f"run_{k}.csv")]
    told = brakechain("new", "mine", *asked, cwd=tmp_path).stdout
    assert "angle" in told and "rad? (not stated)" in told and "balance of forces" in told
    assert "coulomb at bearing" in brakechain("check", "mine.yaml", cwd=tmp_path).stdout
    brakechain("run", "mine.yaml", "--until", "diagnosis", "--set",
               "diagnosis.effects=[coulomb, cubic_stiffness]", cwd=tmp_path)
    answer = json.loads((tmp_path / "data" / "runs" / "mine" / "diagnosis.json").read_text())
    assert answer["verdict"] == "missing" and answer["effects"][0]["name"] == "coulomb", answer["reasons"]


def test_a_record_is_no_disc_brake(tmp_path):
    driven(tmp_path)
    assert "--from goes with neither" in brakechain("new", "mine", "--from", "shaft.csv", "--ask", code=2,
                                                    cwd=tmp_path).stderr

"""Public recordings by 'brakechain new --from', as it stands: what is named, and how far it holds."""

import csv
import json
import os
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from pipeline.cli.main import cli

pytestmark = [pytest.mark.slow, pytest.mark.measured]


def diagnosed(file, folder, monkeypatch, effects):
    """diagnosis.json of the case that 'new --from' makes of a ``file``, of some ``effects``, which are quicker."""
    monkeypatch.chdir(folder)
    for command in (["new", "set", "--from", str(file)], ["run", "set.yaml"]):
        told = CliRunner().invoke(cli, command)
        assert told.exit_code == 0, told.output
        case = Path("set.yaml")
        case.write_text(re.sub(r"# effects: \[.*?\].*", f"effects: [{effects}]", case.read_text()))
    return json.loads((folder / "data" / "runs" / "set" / "diagnosis.json").read_text())


def sheet(name, file):
    """One sheet of the workbook of dropped balls, written as CSV."""
    openpyxl = pytest.importorskip("openpyxl")
    source = Path(os.environ["BRAKECHAIN_DATA"]) / "recordings" / "ball_drops" / "Ball_drops_data.xls"
    copy = file.with_suffix(".xlsx")
    copy.write_bytes(source.read_bytes())
    rows = openpyxl.load_workbook(copy, data_only=True)[name].values
    with file.open("w", newline="") as written:
        csv.writer(written).writerows(row[:3] for row in rows)
    return file


def test_a_falling_whiffle_ball_is_held_back_by_drag_that_grows_with_speed(tmp_path, monkeypatch):
    told = diagnosed(sheet("Whiffle Ball 1", tmp_path / "ball.csv"), tmp_path, monkeypatch,
                     "coulomb, dahl, joint_damping, quadratic_damping")
    assert (told["verdict"], told["grade"]) == ("missing", "in part")
    assert [(e["name"], e["place"]) for e in told["effects"]] == [("joint_damping", "support")]
    assert told["effects"][0]["parameters"]["damping"]["value"] == pytest.approx(0.52, rel=0.05), "by SciPy, .520 /s"
    assert told["unexplained_share"] < 0.01


def test_a_cycled_bar_of_steel_yields_with_memory(tmp_path, monkeypatch):
    steel = Path(os.environ["BRAKECHAIN_DATA"]) / "recordings" / "steel_loops" / "example_1.csv"
    told = diagnosed(steel, tmp_path, monkeypatch, "bouc_wen, coulomb, cubic_stiffness, dahl, jenkins")
    assert (told["verdict"], told["grade"]) == ("missing", "in part")
    assert [(e["name"], e["place"]) for e in told["effects"]] == [("bouc_wen", "support")]
    assert told["unexplained_share"] < 0.01

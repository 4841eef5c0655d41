"""The record of computed facts, and the tables that documents show of it."""

import json
import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from pipeline.cli.main import cli
from pipeline.contract import ConfigError, store
from pipeline.products import Comparison
from pipeline.views.figures.number_format import MINUS
from pipeline.views.pages import facts as page
from tests.views.products_for_views import comparison, filled

ROOT = Path(__file__).parents[3]
RECORDS = sorted(ROOT.glob("data/reference/computed/*.json"))
COMMIT = "c0ffee" + "0" * 34
#: a table in a document, between its command and the end mark
TABLE = re.compile(r"<!-- facts: `brakechain (?P<command>[^`]*)` -->\n(?P<table>.*?)\n<!-- /facts -->", re.DOTALL)


def fact(ours, tolerance=0.0, unit="Hz", **more):
    return {"quantity": "q", "field": "squeal.event_frequency", "unit": unit, "paper": 267.0, "tolerance": tolerance,
            "allowed": "± 1", "ours": ours, "verdict": "within", "tuned": "", **more}


def command(*arguments):
    return CliRunner().invoke(cli, ["facts", *map(str, arguments)], catch_exceptions=False).output


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Run folders of one case from two processors that differ in the first row, and one of another case."""
    folders = []
    for name, kernel, change in (("a", "openblas Haswell", {}),
                                 ("b", "openblas Zen", {"ours": 0.47, "verdict": "outside"}), ("other", "", None)):
        product = comparison()
        values = {field: getattr(product, field).copy() for field in product.__dataclass_fields__}
        for field, value in (change or {}).items():
            values[field][0] = value
        product = filled(Comparison) if change is None else Comparison(**values)
        folders.append(tmp_path_factory.mktemp(name))
        store.write(product, folders[-1] / "comparison.h5", {"git_commit": COMMIT, "kernels": json.dumps([kernel])})
    return folders


def test_numbers_that_a_processor_moves_are_ranges_and_the_verdict_is_the_worse_one(runs, tmp_path):
    command(*runs[:2], "--record", tmp_path / "case.json")
    record = json.loads((tmp_path / "case.json").read_text())
    assert [run["kernels"] for run in record["runs"]] == [["openblas Haswell"], ["openblas Zen"]]
    assert record["runs"][0]["commits"] == [COMMIT]
    lowest = record["facts"]["friction_lowest"]
    assert (lowest["ours"], lowest["verdict"], lowest["field"]) == ([0.41, 0.47], "outside", "micro_friction.friction")
    assert "damped_at_low_load" not in record["facts"], "a fact without a verdict is not recorded"
    shown = command(tmp_path / "case.json", "--markdown", "--only", "mode_01_02_test,friction_lowest").splitlines()
    assert [line.split("|")[1].strip() for line in shown[2:]] == ["free disc, mode 1/2", "friction, lowest"]
    assert "| 0.410–0.470 | ± 0.05 | outside, tuned: shear limit | `micro_friction.friction` |" in shown[3]
    assert "friction, lowest" in command(runs[0])


def test_what_cannot_be_shown_is_refused(runs, tmp_path):
    with pytest.raises(ConfigError, match="key of a testable fact"):
        command(runs[0], "--only", "colour")
    with pytest.raises(ConfigError, match="run folders of one case"):
        command(runs[0], runs[2])
    (tmp_path / "x.json").write_text("[]")
    with pytest.raises(ConfigError, match="a record of facts"):
        command(tmp_path / "x.json")
    assert "cannot be mixed" in command(tmp_path / "x.json", runs[0])
    store.write(filled(Comparison), tmp_path / "comparison.h5", {"git_commit": f"{COMMIT}+", "kernels": "[]"})
    with pytest.raises(ConfigError, match="runs of committed code"):
        command(tmp_path, "--record", tmp_path / "case.json")


@pytest.mark.parametrize("given, shown", [
    (fact([259.4, 259.4], 13), "259 Hz"), (fact([16596.0, 16604.0], 166), "16600 Hz"),
    (fact([0.774, 0.776], 0.15, "um"), "0.77–0.78\u202f\u00b5m"), (fact([0.0, 0.0], 0.5, "1"), "0"),
    (fact([0.0178, 0.0178], 0, "1"), "0.0178"), (fact([29.77, 30.25], 0, "N"), "29.8–30.2 N"),
    (fact([-23.4, -23.2], 0, "1"), f"{MINUS}23.4 to {MINUS}23.2"), (fact([-0.0001, 0.0001], 0.05, "1"), "0.000")])
def test_printed_digits_follow_the_tolerance(given, shown):
    assert page.table({"key": given})[1][0][2].replace("\u202f", " ") == shown.replace("\u202f", " ")


def test_a_run_beyond_the_recorded_range_is_told():
    """One printed digit beyond a single value, and the width of a range beyond a range, are covered."""
    record = {"a": fact([259.4, 259.4], 13), "b": fact([29.8, 30.2], unit="N")}
    assert not page.deviations(record, {"a": fact([260.3, 260.3], 13), "b": fact([29.5, 29.5], unit="N")})
    out = page.deviations(record, {"a": fact([260.6, 260.6], 13), "b": fact([30.7, 30.7], unit="N"), "c": fact([1, 1])})
    assert out == {"a": "q: recorded 259.4 to 259.4, now 260.6 Hz", "b": "q: recorded 29.8 to 30.2, now 30.7 N",
                   "c": "q: not recorded"}
    assert page.deviations(record, {"a": fact([259.4, 259.4], 13)})["b"].endswith("no longer computed")


def test_every_table_of_the_documents_is_what_its_command_prints(monkeypatch):
    monkeypatch.chdir(ROOT)
    tables = [match for file in (ROOT / "README.md", *ROOT.glob("docs/**/*.md")) for match in
              TABLE.finditer(file.read_text())]
    assert tables, "README.md shows a table of facts"
    for match in tables:
        arguments = shlex.split(match["command"])
        assert arguments[0] == "facts"
        assert command(*arguments[1:]).strip() == match["table"], f"print it anew: {match['command']}"
    assert {path.name for path in RECORDS} == {Path(shlex.split(m["command"])[1]).name for m in tables}, "all are shown"


@pytest.mark.parametrize("path", RECORDS, ids=lambda path: path.stem)
def test_every_record_names_its_commit_and_kernels(path):
    record = json.loads(path.read_text())
    assert all(run["kernels"] and all(len(commit) == 40 for commit in run["commits"]) for run in record["runs"])
    assert all(fact["field"] and fact["verdict"] in ("within", "outside") for fact in record["facts"].values())

"""A set that was written as docs/trial_sets.md says, without any of this program, from its sealing to its page."""

import json
import re
import shutil

import pytest
from click.testing import CliRunner

from pipeline.cli.main import cli
from tests.blind_trial.protocol.their_set import block, their_set


def brakechain(*arguments):
    """What a command prints; its error is raised."""
    done = CliRunner().invoke(cli, ["trial", *map(str, arguments)])
    if done.exception and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == 0, done.output
    return done.output


@pytest.fixture
def theirs(tmp_path):
    """Two cases of the document, and one whose nominal model nobody can read."""
    folder = their_set(tmp_path / "theirs")
    shutil.copytree(folder / "cases" / "001", folder / "cases" / "003")
    (folder / "cases" / "003" / "nominal.yaml").write_text("chain: lumped_bench\nlumpt: {}\n")
    truth = json.loads((folder / "truth.json").read_text())
    (folder / "truth.json").write_text(json.dumps({**truth, "003": truth["001"]}))
    return folder


def test_the_example_is_of_twenty_lines_and_needs_nothing_of_this_program():
    recorder, _, truths = block("python").partition("random, values =")
    assert len(recorder.strip().splitlines()) <= 20 and truths
    assert "brakechain" not in block("python") and "pipeline" not in block("python")


def test_a_set_made_by_others_is_sealed_solved_scored_shown_and_verified(theirs, tmp_path):
    key = tmp_path / "theirs.key"
    assert "commitment" in brakechain("seal", theirs, "--key", key) and not (theirs / "truth.json").exists()
    assert "3 of 3 solved" in brakechain("solve", theirs, "--methods", "diagnosis", "--workers", 1)
    told = brakechain("score", theirs, "--key", key)
    assert re.search(r"single effect: type and location correct +1 of 1", told) and re.search(r"refused +1 of 3", told)
    assert re.search(r"false alarms +0 of 2", told)
    assert re.search(r"controls: nothing missing, and reported so +1 of 2", told)
    result = json.loads((theirs / "result.json").read_text())
    assert "lumpt: unknown section; did you mean 'lumped'?" in result["cases"]["003"]["answers"]["diagnosis"]["why"][1]
    found = result["methods"]["diagnosis"]["parameters"]["nominal"]
    assert found["count"] == 6 and found["median_error"] < 0.01
    assert "result.json is the score of 3 cases" in brakechain("verify", theirs)
    assert "trial.html" in brakechain("show", theirs) and "Case 003" in (theirs / "trial.html").read_text()
    assert brakechain("show", theirs, "--markdown").startswith("| | goal | diagnosis |")

"""The commands of a trial: what they print and what they refuse before anything is made."""

import pytest
from click.testing import CliRunner

from pipeline.blind_trial.generators.systems import System
from pipeline.blind_trial.protocol import making
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.cli.main import cli


def trial(*arguments):
    return CliRunner().invoke(cli, ["trial", *map(str, arguments)])


@pytest.fixture
def toy(monkeypatch):
    """A system whose cases are made at once."""
    def write(draw, folder):
        folder.mkdir()
        for name in ("nominal.yaml", "recordings.h5"):
            (folder / name).write_text(str(draw.seed))
        return {"class": draw.kind, "effects": [], "system": "toy"}

    monkeypatch.setattr(making, "SYSTEMS", {"toy": System("toy", write, {"control": ((),)}, (0.0,), (0.01,))})


def test_help_tells_the_course_of_a_trial():
    told = trial("--help").output
    for name in ("make", "seal", "solve", "score", "verify", "show"):
        assert f"\n  {name} " in told


def test_make_tells_classes_commitment_and_where_the_key_lies(tmp_path, toy):
    told = trial("make", tmp_path / "a", "--cases", 2, "--systems", "toy", "--workers", 1).output
    assert "2 of 2 made" in told and "2 cases: 2 control" in told and "commitment" not in told
    key = tmp_path / "b.key"
    told = trial("make", tmp_path / "b", "--cases", 2, "--systems", "toy", "--workers", 1, "--sealed", "--key",
                 key).output
    assert f"commitment {TrialSet(tmp_path / 'b').about['commitment']}" in told and f"key: {key}" in told
    assert key.exists()


@pytest.mark.parametrize("more, message", [
    (("--sealed", "--seed", 1), "--seed belongs to open sets"), (("--key", "a.key"), "--key belongs to sealed sets"),
    (("--cases", 0), "0 is not in the range")])
def test_what_does_not_fit_is_refused(tmp_path, more, message):
    done = trial("make", tmp_path / "a", *more)
    assert done.exit_code == 2 and message in done.output and not (tmp_path / "a").exists()

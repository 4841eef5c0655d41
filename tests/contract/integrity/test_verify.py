"""Damaged and edited files of a run: verified, told, and computed again."""

import h5py
import pytest
from click.testing import CliRunner

from pipeline.cli.main import cli
from pipeline.contract import Context, ProductError, case, runner
from pipeline.contract.integrity.verify import verify
from tests.contract.toy import CHAINS, load


@pytest.fixture
def job(tmp_path):
    (tmp_path / "toy.yaml").write_text("chain: varied\n")
    job = runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load), tmp_path / "run", "superlu")
    assert job.execute(Context()) == 6
    return job


def flaws(job):
    return {file.name: file.flaw for file in verify(job.folder) if file.flaw}


def test_a_run_as_it_was_written(job):
    names = {file.name for file in verify(job.folder)}
    assert {"source.h5", "doubled.h5", "doubled.csv", "variants/louder/doubled.csv"} <= names and not flaws(job)
    assert job.execute(Context()) == 0


def test_an_edited_number_and_a_changed_table_are_told_and_computed_again(job):
    reported = []
    with h5py.File(job.folder / "source.h5", "a") as h5:
        h5["data/signal"][0, 0] += 1e-9
    (job.folder / "doubled.csv").write_text("1,2,3")
    assert set(flaws(job)) == {"source.h5"} | {"doubled.csv"}
    assert {state.stage.name: state.reasons for state in job.plan()}["source"] == ("its file is damaged",)
    assert job.execute(Context(), report=lambda state, seconds: reported.append((state.stage.name, state.reasons))) == 2
    assert reported[:2] == [("source", ("its file is damaged",)),
                            ("doubled", ("doubled.csv is not as it was written",))]
    assert not flaws(job) and job.execute(Context()) == 0


def test_files_of_variants_and_companions_that_are_gone(job):
    (job.folder / "variants" / "louder" / "doubled.csv").unlink()
    (job.folder / "variants" / "stronger" / "doubled.h5").write_bytes(b"none")
    assert set(flaws(job)) == {"variants/louder/doubled.csv", "variants/stronger/doubled.h5"}


def test_the_command(job, tmp_path):
    done = CliRunner().invoke(cli, ["verify", str(job.folder)])
    assert done.exit_code == 0 and "doubled.csv" in done.output and "as it was written" in done.output
    (job.folder / "doubled.csv").write_text("1")
    done = CliRunner().invoke(cli, ["verify", str(job.folder)])
    assert isinstance(done.exception, ProductError) and "1 that are not: doubled.csv" in str(done.exception)
    with pytest.raises(ProductError, match="a run folder with products"):
        verify(tmp_path / "none")

"""A received folder does no harm: nothing in it is imported, followed, or read beyond what is asked for."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline.blind_trial.protocol import solver_process
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.contract import BrakechainError, Context, ProductError, case, runner
from pipeline.contract.errors import ConfigError
from pipeline.contract.executors import LocalProcesses
from pipeline.environment import fix
from pipeline.views.figures import scene
from tests.commands import ROOT
from tests.contract.toy import CHAINS, load

pytestmark = pytest.mark.apart

#: modules that children of this program import, here as a received folder may bring them
NAMES = ("numpy.py", "pickle.py", "multiprocessing.py", "threadpoolctl.py", "json.py", "pipeline/__init__.py",
         "pipeline/views/scene.py", "pipeline/contract/following.py", "pipeline/contract/__init__.py")


@pytest.fixture
def trapped(tmp_path, monkeypatch):
    """The current folder: every module in it writes a file when it is imported; returns that file."""
    trace, folder = tmp_path / "executed", tmp_path / "received"
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(f"open({str(trace)!r}, 'a').write({name!r})\nraise SystemExit(9)\n")
    monkeypatch.chdir(folder)
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    return trace


def outcome(call, *given):
    """What a call returns, or its error: a child that executed a trap ends, and the trap tells more."""
    try:
        return call(*given)
    except BrakechainError as error:
        return error


def test_pictures_import_nothing_of_the_current_folder(trapped):
    pictures = outcome(scene.render, [scene.Scene(())])
    assert not trapped.exists() and (pictures is None or len(pictures) == 1)


def test_workers_import_nothing_of_the_current_folder(trapped):
    work = LocalProcesses(1)
    try:
        results = outcome(work.map, abs, [-3], lambda: None)
    finally:
        work.close()
    assert not trapped.exists() and results == [3]


def test_solvers_import_nothing_of_the_current_folder(trapped, tmp_path):
    work = tmp_path / "received"
    (work / "nominal.yaml").write_text("chain: none\n")
    variables = solver_process.environment(tmp_path, work)
    refusal = solver_process._run(solver_process.command("diagnosis"), work, variables, 99)
    assert not trapped.exists() and "chain: expected one of" in refusal["reasons"][0]


def test_the_command_itself_leaves_the_current_folder_out(trapped):
    path = ["", str(Path.cwd()), str(ROOT)]
    fix({}, path)
    assert path == [str(ROOT)]
    done = subprocess.run([sys.executable, "-P", "-m", "pipeline", "data", "list"], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT)}, timeout=120)
    assert done.returncode == 0 and not trapped.exists()


def toy(folder):
    folder.mkdir()
    (folder / "toy.yaml").write_text("chain: toy\n")
    return runner.ChainRun(case.load(folder / "toy.yaml", CHAINS, load), folder / "run", "superlu")


def test_no_link_is_followed_by_a_run(tmp_path):
    victim, job = tmp_path / "victim", toy(tmp_path / "received")
    victim.write_text("mine")
    job.folder.mkdir()
    for name in (".source.h5.partial", "doubled.h5", ".doubled.csv.partial", "doubled.csv", ".checked.json"):
        (job.folder / name).symlink_to(victim)
    assert job.execute(Context()) == 2 and victim.read_text() == "mine"
    assert not any(path.is_symlink() for path in job.folder.iterdir())


def test_a_lock_that_is_a_link_or_a_pipe_is_refused(tmp_path):
    victim, job = tmp_path / "victim", toy(tmp_path / "received")
    victim.write_text("mine")
    job.folder.mkdir()
    (job.folder / ".lock").symlink_to(victim)
    refusal = outcome(job.execute, Context())
    assert victim.read_text() == "mine"
    assert isinstance(refusal, ProductError) and "lock: a symbolic link" in str(refusal)
    (job.folder / ".lock").unlink()
    os.mkfifo(job.folder / ".lock")
    with pytest.raises(ProductError, match="lock: not a regular file"):
        job.execute(Context())


def test_a_variant_leaves_its_run_folder_by_no_link(tmp_path):
    folder = tmp_path / "received"
    folder.mkdir()
    (folder / "toy.yaml").write_text("chain: varied\n")
    (folder / "run").mkdir()
    (folder / "run" / "variants").symlink_to(tmp_path)
    job = runner.ChainRun(case.load(folder / "toy.yaml", CHAINS, load), folder / "run", "superlu")
    with pytest.raises(ConfigError, match="expected a path inside"):
        job.execute(Context())
    assert not (tmp_path / "louder").exists()


def test_a_pipe_as_a_case_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "case.yaml")
    with pytest.raises(ConfigError, match="not a regular file"):
        case.load(tmp_path / "case.yaml", CHAINS, load)


SECRET = "root:x:0:0:secret-of-the-machine"


@pytest.mark.parametrize("nominal", [
    "based_on: {secret}\n", "chain: recording\nrecording: {{files: [{{kind: hdf5, file: {secret}}}]}}\n",
    "chain: recording\nrecording: {{files: [{{kind: hdf5, file: 'measured:recordings/x.h5'}}]}}\n",
    "chain: lumped_bench\nlumped: {{masses: {{a: {{mass: 1 kg, moves: [x]}}}}, inputs: {{f: {{along: {{a.x: 1}}, "
    "force: 1 N, history: {{kind: file, file: {secret}, column: x, interval: 1 ms}}}}}}}}\n"])
def test_a_foreign_case_reads_its_own_two_files_and_tells_nothing_of_others(tmp_path, nominal):
    secret, one = tmp_path / "secret.yaml", tmp_path / "set" / "cases" / "001"
    secret.write_text(SECRET)
    one.mkdir(parents=True)
    (one / "nominal.yaml").write_text(nominal.format(secret=secret))
    (one / "recordings.h5").write_bytes(b"none")
    answer = solver_process.answered(one, "diagnosis", 120)
    assert answer["verdict"] == "refused" and "secret-of" not in str(answer)
    assert "a file of the case" in answer["reasons"][0], answer


def test_a_case_of_links_is_refused(tmp_path):
    secret, one = tmp_path / "secret.yaml", tmp_path / "set" / "cases" / "001"
    secret.write_text(SECRET)
    one.mkdir(parents=True)
    (one / "nominal.yaml").symlink_to(secret)
    (one / "recordings.h5").write_bytes(b"none")
    with pytest.raises(ConfigError, match="a regular file of the case, found a symbolic link"):
        solver_process.answered(one, "diagnosis", 120)
    with pytest.raises(ConfigError, match="found no nominal.yaml"):
        TrialSet(tmp_path / "set").cases  # noqa: B018

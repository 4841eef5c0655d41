"""A Dask cluster with a worker in another process gives the same content as local processes."""

import re
import shutil
import time

import pytest

from pipeline.blind_trial.protocol.case_set import TrialSet
from tests.blind_trial.protocol.their_set import their_set
from tests.chain.conftest import QUICK, contents
from tests.commands import ROOT, brakechain
from tests.contract.executors.dask_processes import address_of, cluster, scheduler, worker

pytest.importorskip("distributed")


@pytest.mark.slow
def test_the_same_bits_come_back(tmp_path, finished):
    with cluster(tmp_path) as address:
        brakechain("run", QUICK, "--run", tmp_path / "run", "--scheduler", address)
    assert contents(tmp_path / "run") == contents(finished)


@pytest.mark.slow
def test_a_trial_is_solved_alike(tmp_path):
    here, there = their_set(tmp_path / "here"), their_set(tmp_path / "there")
    brakechain("trial", "solve", here, "--methods", "diagnosis", "--workers", 1)
    with cluster(tmp_path) as address:
        brakechain("trial", "solve", there, "--methods", "diagnosis", "--scheduler", address)
    one, other = ({number: {**told, "cpu_seconds": None} for number, told in answers(folder).items()}
                  for folder in (here, there))
    assert one == other and [one[number]["verdict"] for number in sorted(one)] == ["parameters", "missing"]


def answers(folder):
    return TrialSet(folder).read("answers.json")["answers"]["diagnosis"]


def without_brakechain(folder):
    """A place where the project is not installed."""
    (folder / "pipeline").mkdir()
    (folder / "pipeline" / "__init__.py").write_text("raise ModuleNotFoundError('No module named pipeline')\n")


def with_another_version(folder):
    """A place with one line of other code."""
    for name in ("pipeline", "stages"):
        shutil.copytree(ROOT / name, folder / name)
    with (folder / "stages" / "squeal.py").open("a") as file:
        file.write("# another version\n")


@pytest.mark.parametrize("build, found", [(without_brakechain, "No module named pipeline"),
                                          (with_another_version, "other code")])
@pytest.mark.parametrize("which", ["worker", "scheduler"])
def test_a_cluster_with_other_code_or_none_is_refused(tmp_path, which, build, found):
    """Told once and at once, whichever of its processes it is."""
    other = tmp_path / "other"
    other.mkdir()
    build(other)
    with scheduler(other if which == "scheduler" else ROOT) as started:
        address = address_of(started)
        with worker(address, 1, tmp_path, other if which == "worker" else ROOT):
            begin = time.monotonic()
            told = brakechain("surface", QUICK, "--run", tmp_path / "run", "--scheduler", address, code=2).stderr
    assert told.count("error: ") == 1 and "Traceback" not in told and time.monotonic() - begin < 30
    where = re.escape("the scheduler") if which == "scheduler" else r"tcp://127.0.0.1:\d+"
    assert re.search(rf"found {found} \({where}\); install it in their environments and restart them", told)
    assert not (tmp_path / "run" / "surface.h5").exists()

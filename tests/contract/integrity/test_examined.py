"""Products of others whose checksum is right: what HDF5 does not survive ends in a process of its own, told at once."""

import os
import shutil
import signal
import subprocess

import pytest

from pipeline.contract import Context, ProductError, case, runner, store
from pipeline.contract.integrity import checksum, examined, seen
from pipeline.contract.integrity.verify import verify
from pipeline.contract.received import process
from tests.contract.test_product import GOOD
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Source

pytestmark = pytest.mark.apart


def looping(path):
    """The product at ``path``, its heap of texts zeroed, where HDF5 goes round for ever, and sealed again."""
    content = path.read_bytes()[:-checksum._BEHIND]
    begin = content.index(b"GCOL") + 32
    path.write_bytes(content[:begin] + bytes(256) + content[begin + 256:])
    checksum.seal(path)


@pytest.fixture
def job(tmp_path, monkeypatch):
    """A run of three stages and two variants, as another machine made it."""
    (tmp_path / "toy.yaml").write_text("chain: varied\n")
    made = runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load), tmp_path / "made", "superlu")
    assert made.execute(Context()) == 6
    shutil.copytree(made.folder, tmp_path / "run")
    monkeypatch.setattr(examined, "_known", {})
    return runner.ChainRun(made.case, tmp_path / "run", "superlu")


@pytest.fixture
def started(monkeypatch):
    """Number of products that each process was started for."""
    counts = []

    def counted(reader, path, folder, limits, given, before=process.started):
        counts.append(len(given["paths"]))
        return before(reader, path, folder, limits, given)

    monkeypatch.setattr(process, "started", counted)
    return counts


@pytest.fixture
def hurried(monkeypatch):
    monkeypatch.setattr(process, "_SECONDS", 2)


def test_hdf5_never_ends_such_a_product(tmp_path):
    """What the others are about: a process that opens it does so until it is stopped."""
    store.write(Source(**GOOD), tmp_path / "source.h5", {})
    looping(tmp_path / "source.h5")
    command = ("import sys, h5py\nwith h5py.File(sys.argv[1]) as h5:\n    print('opened', flush=True)\n"
               "    dict(h5.attrs)\n    print('read')\n")
    child = subprocess.Popen([process.sys.executable, "-c", command, tmp_path / "source.h5"], text=True,
                             stdout=subprocess.PIPE)
    assert child.stdout.readline() == "opened\n"
    with pytest.raises(subprocess.TimeoutExpired):
        child.wait(1.0)
    child.send_signal(signal.SIGKILL)
    assert child.communicate()[0] == ""


def test_a_run_computes_again_what_hdf5_does_not_survive(job, started, hurried):
    looping(job.folder / "source.h5")
    assert {state.stage.name: state.reasons for state in job.plan()}["source"] == ("its file is damaged",)
    assert job.execute(Context()) == 1 and store.read(Source, job.folder / "source.h5")
    assert sum(started) >= 6 and len(started) <= 2


def test_verify_and_readers_say_so_in_one_sentence(job, hurried):
    looping(job.folder / "source.h5")
    flaws = {file.name: file.flaw for file in verify(job.folder) if file.flaw}
    assert flaws == {"source.h5": "HDF5 is not done with it within 2 s"}
    with pytest.raises(store.DamagedFile, match="damaged file .HDF5 is not done with it within 2 s.; rerun the stage"):
        store.read(Source, job.folder / "source.h5")


def test_a_folder_of_others_is_examined_once_and_by_one_process(job, started):
    assert job.execute(Context()) == 0 and started == [6]
    examined._known.clear()
    assert job.execute(Context()) == 0 and not [file for file in verify(job.folder) if file.flaw]
    assert started == [6]
    os.utime(job.folder / "source.h5")
    assert job.execute(Context()) == 0 and started == [6, 1]


def test_what_this_process_wrote_is_known(tmp_path, started):
    store.write(Source(**GOOD), tmp_path / "source.h5", {})
    assert store.read(Source, tmp_path / "source.h5") and not started
    (tmp_path / seen.LIST).write_text('{"source.h5": [1, 2, 3, ""]}')
    examined._known.clear()
    assert store.read(Source, tmp_path / "source.h5") and store.identity(tmp_path / "source.h5") and started == [1]


def test_what_crashes_or_stumbles_leaves_the_others(tmp_path, monkeypatch):
    """``leave`` with a reader that dies of one file and stumbles over another."""
    (tmp_path / "sitecustomize.py").write_text(
        "import pipeline.contract.received.hdf5 as h\nimport os\n"
        "def read(path):\n    name = os.path.basename(path)\n"
        "    name == 'b' and os.kill(os.getpid(), 11)\n    name == 'c' and {}['x']\n"
        "h.read_whole = read\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    paths = [tmp_path / name for name in "abcd"]
    for path in paths:
        path.write_text(path.name)
    assert examined.examine(paths) == 4
    flaws = ["", "HDF5 does not survive it: exit code -11", "KeyError: 'x'", ""]
    assert [examined.flaw(path) for path in paths] == flaws
    assert examined.examine(paths) == 0


def test_a_reader_examines_no_more(tmp_path, monkeypatch, started):
    """It is a process of its own already."""
    (tmp_path / "a").write_text("")
    monkeypatch.setenv(process._READER, "1")
    assert examined.flaw(tmp_path / "a") == "" and examined.examine([tmp_path / "a"]) == 0 and not started


def test_a_product_that_is_gone(tmp_path):
    with pytest.raises(ProductError, match="no file"):
        store.read(Source, tmp_path / "source.h5")

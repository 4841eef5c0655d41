"""One thread and one worker for each process of the tests, which run side by side on all cores; readers of files in
these processes; public recordings are found, or tests of them skip with the reason."""

import fcntl
import os
from contextlib import nullcontext
from pathlib import Path

import pytest

from pipeline.environment import ONE_THREAD
from tests.cost import pytest_collection_finish, pytest_runtest_makereport, pytest_terminal_summary  # noqa: F401

os.environ.update(ONE_THREAD)       # before anything loads linear algebra, also above: more would wait for each other
os.environ["BRAKECHAIN_WORKERS"] = "1"      # processes of short tasks would take longer to start than to compute

_VARIABLE = "BRAKECHAIN_DATA"
_BESIDE = Path(__file__).parents[2] / "shared" / "data"
_DATA = Path(os.environ.get(_VARIABLE, _BESIDE)).resolve()
if _DATA.is_dir():
    os.environ[_VARIABLE] = str(_DATA)


def pytest_collection_modifyitems(items):
    """Tests marked ``measured`` skip where the public recordings are not."""
    if _DATA.is_dir():
        return
    for item in items:
        if item.get_closest_marker("measured"):
            item.add_marker(pytest.mark.skip(reason=f"no public recordings at {_DATA}; set {_VARIABLE}"))


@pytest.fixture(autouse=True)
def _readers_here(request):
    """Readers of files run in the process of the test; in processes of their own where it is marked ``apart``."""
    from tests import readers

    with nullcontext() if request.node.get_closest_marker("apart") else readers.in_this_process():
        yield


@pytest.fixture(autouse=True, scope="session")
def _notes_apart(tmp_path_factory):
    """What runs of tests take is noted apart from what those of the user took."""
    from pipeline.cli import pace

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pace, "user_folder", lambda: tmp_path_factory.mktemp("notes"))
        yield


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """``once(name, make)``: a folder that ``make(folder)`` fills, in whichever process of the tests asks first."""
    shared = tmp_path_factory.getbasetemp()
    shared = shared.parent if "PYTEST_XDIST_WORKER" in os.environ else shared

    def made(name, make):
        folder, done = shared / name, shared / f"{name}.done"
        with (shared / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not done.exists():
                make(folder)
                done.touch()
        return folder

    return made

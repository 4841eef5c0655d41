"""One thread and one worker for each process of the tests, which run side by side on all cores; public recordings are
found, or tests of them skip with the reason."""

import os
from pathlib import Path

import pytest

from pipeline.environment import ONE_THREAD
from tests.cost import pytest_runtest_makereport, pytest_terminal_summary  # noqa: F401: hooks

os.environ.update(ONE_THREAD)       # before anything loads linear algebra: more would wait for each other
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

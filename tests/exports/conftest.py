"""Runs that several tests export."""

import pytest

from tests.exports.small_runs import brake_run, flutter_run


@pytest.fixture(scope="session")
def brake(tmp_path_factory):
    """Folder of a run of a brake of a few elements."""
    return brake_run(tmp_path_factory.mktemp("brake"))


@pytest.fixture(scope="session")
def rig(tmp_path_factory):
    """Folder of a run of a lumped brake."""
    return flutter_run(tmp_path_factory.mktemp("rig"))

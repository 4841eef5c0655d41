"""Folders of two cases that every baseline is shown: a cubic spring hidden in one mass on a link, and nothing."""

import pytest

from pipeline.blind_trial.generators.case_files import write
from pipeline.blind_trial.generators.spring_mass.rig_case import made


@pytest.fixture(scope="session")
def hidden(tmp_path_factory):
    """Folder with cubic_stiffness at link_0, noise 0.1 %."""
    return _written(tmp_path_factory.mktemp("hidden"), "cubic_stiffness")


@pytest.fixture(scope="session")
def control(tmp_path_factory):
    """Folder with nothing hidden, noise 0.1 %."""
    return _written(tmp_path_factory.mktemp("control"), "")


def _written(folder, name):
    write(made(7, name, level=1e-3, masses=1, change=0.1), folder)
    return folder

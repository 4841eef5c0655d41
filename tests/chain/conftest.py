"""One undisturbed run of the quick case, made once for all tests of the chain."""

import shutil
from pathlib import Path

import pytest

from stages import CHAINS
from tests.chain.run_contents import everything
from tests.commands import ROOT, brakechain

NAMES = CHAINS["disc_brake"]
QUICK = ROOT / "configs" / "disc_brake_quick.yaml"


def contents(folder):
    """File -> content hash of every product in a run folder, and SHA-256 of what stands beside them."""
    return {name.removesuffix(".h5"): digest for name, digest in everything(folder).items()
            if Path(name).suffix in (".h5", ".csv", ".html", ".json", ".inp", ".adm", ".txt")}


@pytest.fixture(scope="session")
def finished(once):
    """Folder of a finished quick run; read only: copy it before you change it."""
    return once("disc_brake_quick", lambda folder: brakechain("run", QUICK, "--run", folder))


@pytest.fixture
def copy(finished, tmp_path):
    """A copy of the finished run that a test may change."""
    return Path(shutil.copytree(finished, tmp_path / "run"))

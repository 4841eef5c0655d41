"""Compiled code is found again as long as all that it was compiled from is as it was, and only then."""

import os
import subprocess
import sys

import pytest
from numba import config

from pipeline import sources
from pipeline.environment import CACHE, LOCATORS
from pipeline.physics.numerics import compiled_cache
from pipeline.physics.numerics.compiled_cache import SourceLocator, state_of

CALLEE = """
from pipeline.physics.numerics.compiled import njit

@njit
def scaled(x):
    return 2.0 * x
"""
CALLER = """
from pipeline.callee import scaled
from pipeline.physics.numerics.compiled import njit

@njit
def twice(x):
    return scaled(x)
"""
ASK = "from pipeline import caller; print(caller.twice(1.0), sum(caller.twice.stats.cache_hits.values()))"


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project of three files: ``caller`` compiles what ``callee`` gives it; ``other`` has nothing to do with it."""
    folder = tmp_path / "pipeline"
    folder.mkdir()
    for name, text in (("__init__", ""), ("callee", CALLEE), ("caller", CALLER), ("other", "")):
        (folder / f"{name}.py").write_text(text)
    for name in ("sources.py", "environment.py"):
        (folder / name).write_text((sources.ROOT / "pipeline" / name).read_text())
    numerics = folder / "physics" / "numerics"
    numerics.mkdir(parents=True)
    for name in ("__init__.py", "numerics/__init__.py"):
        (folder / "physics" / name).write_text("")
    for name in ("compiled.py", "compiled_cache.py"):
        (numerics / name).write_text((sources.ROOT / "pipeline" / "physics" / "numerics" / name).read_text())
    return folder


def environment(project):
    """Variables of a process that runs the project and caches in a folder beside it.

    Python's own bytecode, which it takes for that of a source as long and as old to the second, is not kept.
    """
    home = project.parent / "compiled"
    home.mkdir(exist_ok=True)
    locators = "pipeline.physics.numerics.compiled_cache.SourceLocator"
    return {**os.environ, CACHE: str(home), LOCATORS: locators, "PYTHONPATH": str(project.parent),
            "PYTHONDONTWRITEBYTECODE": "1"}


def answer(project):
    """(value, cache hits) of the compiled function in a process of its own."""
    done = subprocess.run([sys.executable, "-c", ASK], cwd=project.parent, capture_output=True, text=True, check=True,
                          env=environment(project))
    value, hits = done.stdout.split()
    return float(value), int(hits)


def test_code_is_compiled_again_when_what_it_uses_changes_and_not_for_anything_else(project):
    assert answer(project) == (2.0, 0)
    (project / "other.py").write_text("x = 1\n")
    assert answer(project) == (2.0, 1), "found again, as an unrelated file changes nothing"
    (project / "callee.py").write_text(CALLEE.replace("2.0", "3.0"))
    assert answer(project) == (3.0, 0), "a kernel of another file"
    (project / "callee.py").write_text(CALLEE)
    assert answer(project) == (2.0, 1), "the first state is still there"


EDITED = """
import sys, time
from pathlib import Path
from pipeline import caller
time.sleep(0.05)
file = Path(sys.argv[1])
file.write_text(file.read_text().replace("2.0", "5.0"))
print(caller.twice(1.0))
"""


def test_code_of_sources_that_were_edited_after_they_were_loaded_is_not_cached(project):
    """It would be found again under the digest of the new sources, and answer for them."""
    callee = str(project / "callee.py")
    done = subprocess.run([sys.executable, "-c", EDITED, callee], cwd=project.parent, capture_output=True, text=True,
                          check=True, env=environment(project))
    assert float(done.stdout) == 2.0, "the process goes on with what it has loaded"
    assert not list((project.parent / "compiled").rglob("*.nbi"))
    assert answer(project) == (5.0, 0)


def test_the_states_that_were_not_used_for_longest_are_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    folders = [tmp_path / f"physics.friction.friction_table-{number}" for number in range(10)]
    for number, folder in enumerate(folders):
        monkeypatch.setattr(compiled_cache, "state_of", lambda path, number=number: str(number))
        SourceLocator.from_function(answer, sources.ROOT / "pipeline" / "physics" / "friction" / "friction_table.py")
        os.utime(folder, (number, number))
    assert [folder.exists() for folder in folders] == [False] * 2 + [True] * 8


def test_the_state_of_a_kernel_holds_the_kernels_that_it_calls():
    loop = sources.ROOT / "pipeline" / "physics" / "time_stepping" / "step_loop.py"
    files = sources.files_of("pipeline.physics.time_stepping.step_loop")
    assert "pipeline.physics.time_stepping.contact_solver" in files
    assert "pipeline.physics.rupture.plate_step" not in files
    assert len(state_of(loop)) == 16

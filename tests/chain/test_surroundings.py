"""A run where machines are poor: no HOME, an ASCII locale, odd folder names, little memory, a full disk."""

import os
import resource
import subprocess
import sys

import pytest

from tests.chain.conftest import QUICK, contents
from tests.commands import ROOT

CASE = ROOT / "configs" / "two_mode_flutter.yaml"
PRODUCTS = ("lumped", "effects", "reduced_model", "complex_modes", "transient", "comparison", "report")
#: a name with spaces, umlauts, characters beyond any one code page, and a quotation mark
ODD = "Größe der Bremse, Ωμ '日本'"
#: bytes of address space: the libraries alone map two of them
SPACE = 4 * 2**30


def run(case, folder, environment, command=(), space=None):
    """Exit code, and what the command line says of a case in this environment alone."""
    environment = {"PYTHONPATH": str(ROOT), "PATH": os.environ["PATH"]} | environment
    done = subprocess.run(
        [*command, sys.executable, "-m", "pipeline", "run", str(case), "--run", str(folder)], capture_output=True,
        env=environment, cwd=ROOT, timeout=600,
        preexec_fn=space and (lambda: resource.setrlimit(resource.RLIMIT_AS, (space, space))))
    return done.returncode, (done.stdout + done.stderr).decode(errors="replace")


def case_in(folder, title):
    """A case in ``folder`` that is the other one with this title."""
    path = folder / "Fall äöü.yaml"
    path.write_text(f'based_on: {CASE}\ntitle: "{title}"\n', encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize("environment, space", [
    ({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, None), ({"LC_ALL": "C.UTF-8"}, SPACE)])
def test_a_case_of_odd_names_runs_without_home_in_an_ascii_locale_and_in_little_memory(environment, space, tmp_path):
    folder = tmp_path / ODD
    folder.mkdir()
    code, told = run(case_in(folder, "Größe Ω"), folder / "Lauf 1", environment, space=space)
    assert code == 0 and "Traceback" not in told, told
    assert all((folder / "Lauf 1" / f"{name}.h5").exists() for name in PRODUCTS)
    assert "Größe Ω" in (folder / "Lauf 1" / "report.html").read_text(encoding="utf-8")
    code, told = run(folder / "Fall äöü.yaml", folder / "Lauf 1", environment, space=space)
    assert code == 0 and "nothing to compute" in told, told


@pytest.mark.slow
def test_threads_of_linear_algebra_change_no_bit(finished, tmp_path):
    """Four threads are asked for; the quick brake takes one for each process, as everywhere."""
    four = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "4")
    code, told = run(QUICK, tmp_path / "run", four)
    assert code == 0, told
    assert contents(tmp_path / "run") == contents(finished)


def on_small_disk(size, folder):
    """Words before a command that runs it with a disk of ``size`` of its own at ``folder``; skips without the right to.
    """
    script = f'mount -t tmpfs -o size={size} tmpfs "$0" && exec "$@"'
    words = ("unshare", "--mount", "sh", "-c", script, str(folder))
    try:
        made = subprocess.run([*words, "true"], capture_output=True, timeout=60).returncode == 0
    except OSError:
        made = False
    if not made:
        pytest.skip("no right to mount a small disk")
    return words


@pytest.mark.slow
def test_a_full_disk_is_told_in_one_sentence_and_keeps_what_is_whole(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    code, told = run(CASE, disk / "run", {}, (*on_small_disk("300k", disk), "sh", "-c",
                                              '"$@"; code=$?; ls -A "$0"; exit $code', str(disk / "run")))
    listed = told[told.index("comp"):]
    assert code == 4 and "Traceback" not in told, told
    assert "expected a file that can be written, found a full disk; free space" in told
    assert "complex_modes.h5" in listed and "partial" not in told and "report.html" not in listed

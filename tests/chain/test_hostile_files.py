"""Damaged files that once crashed, hung or puzzled the program: each gives its one sentence by the command line."""

import os
from pathlib import Path

import pytest

from tests.commands import ROOT, brakechain

pytestmark = [pytest.mark.measured, pytest.mark.apart]
HOSTILE = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "hostile"
DAMAGED = "expected an undamaged file, found"
#: file -> (exit code, what its sentence says)
CASES = {"case_1199.yaml": "expected at most 1e+09 of them, found 6.4e+65; choose a coarser spacing",
         "case_2025.yaml": "case_2025.yaml:35: expected a bool, found '0.3 m/s'"}
PRODUCTS = ("product_friction_map.h5", "product_surface.h5")
RECORDINGS = {"crash_v5_a.mat": DAMAGED, "crash_v5_b.mat": "expected an undamaged ",
              "internal_v73.mat": DAMAGED, **{f"internal_{k}.h5": DAMAGED for k in (4, 21, 28, 30, 39)},
              "loop.h5": "expected a file that is read within 15 s, found a reader that is not done",
              "byte_lost_58b.uff": "expected finite numbers, found others"}
KINDS = {".mat": "{{kind: matlab, file: {}, sample_rate: 1 kHz, runs: {{a: {{}}}}, "
                 "columns: {{x: {{column: x, unit: m, measures: position}}}}}}",
         ".h5": "{{kind: hdf5, file: {}}}", ".uff": "{{kind: uff, file: {}, run: a}}"}


def sentence(code, *command):
    """The one line of stderr of a command that must fail with ``code``."""
    lines = brakechain(*command, code=code).stderr.strip().splitlines()
    assert len(lines) == 1 and lines[0].startswith("error: ") and len(lines[0]) <= 2000, lines
    assert "internal error" not in lines[0]
    return lines[0]


def test_every_file_has_a_test():
    named = {*CASES, *PRODUCTS, *RECORDINGS, "standard_58b_one_set.uff", "README.md"}
    assert named == {path.name for path in HOSTILE.iterdir()}


@pytest.mark.parametrize("name", CASES)
def test_cases(tmp_path, name):
    text = (HOSTILE / name).read_text().replace("based_on: ", f"based_on: {ROOT}/configs/")
    (tmp_path / name).write_text(text)
    assert CASES[name] in sentence(2, "run", tmp_path / name, "--run", tmp_path / "run")


@pytest.mark.parametrize("name", PRODUCTS)
def test_products(name):
    assert "found a truncated or damaged file (no checksum at its end" in sentence(4, "inspect", HOSTILE / name)


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name == "loop.h5" else ())
                                  for name in RECORDINGS])
def test_recordings(tmp_path, name):
    assert RECORDINGS[name] in sentence(2, "recording", recording(tmp_path, name), "--run", tmp_path / "run")


def test_a_right_file_that_was_refused_is_read(tmp_path):
    brakechain("recording", recording(tmp_path, "standard_58b_one_set.uff"), "--run", tmp_path / "run")
    assert "mic_1" in brakechain("inspect", tmp_path / "run" / "recording.h5").stdout


def recording(tmp_path, name):
    """A case of one file."""
    file = KINDS[Path(name).suffix].format(HOSTILE / name)
    (tmp_path / "case.yaml").write_text(f"chain: recording\nrecording: {{files: [{file}]}}\n")
    return tmp_path / "case.yaml"

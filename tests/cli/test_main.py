"""The command line: derived, quick to answer, its errors one sentence with an exit code."""

import ast
import json
import subprocess
import sys

import numpy as np
import pytest

import stages
from pipeline.cli.main import _headline
from tests import commands


def brakechain(*args):
    return commands.brakechain(*args, code=None)


HEAVY = {"skfem", "pyvista", "exudyn", "numba", "matplotlib", "SurfaceTopography", "pypardiso"}


def loaded_by(*args, modules):
    """Those of ``modules`` that are loaded once a command has run."""
    script = ("import sys, pipeline.cli.main as c\nfrom click.testing import CliRunner\n"
              f"done = CliRunner().invoke(c.cli, {args})\n"
              f"print(sorted({modules} & set(sys.modules))); sys.exit(done.exit_code)")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return ast.literal_eval(done.stdout)


def test_help_lists_every_stage_and_imports_none():
    done = brakechain("--help")
    assert done.returncode == 0
    for name in stages.NAMES:
        assert name.replace("_", "-") in done.stdout and stages.summary(name)[:30] in done.stdout
    assert not loaded_by("--help", modules=HEAVY | {"scipy"})


@pytest.mark.parametrize("command", [("chain", "configs/disc_brake_quick.yaml"), ("schema",),
                                     ("run", "configs/disc_brake_quick.yaml", "--dry-run")], ids=lambda c: c[0])
def test_what_computes_nothing_loads_nothing_heavy(command, tmp_path):
    folder = ("--run", str(tmp_path)) if "schema" not in command else ()
    assert not loaded_by(*command, *folder, modules=HEAVY | {"scipy.signal", "scipy.linalg", "scipy.sparse", "pint"})


@pytest.mark.parametrize("name", stages.NAMES)
def test_every_stage_command_has_the_same_form(name):
    done = brakechain(name.replace("_", "-"), "--help")
    assert done.returncode == 0
    for option in ("CONFIG", "--run", "--set", "--force", "--dry-run", "--workers", "--scheduler", "--debug"):
        assert option in done.stdout


@pytest.mark.parametrize("text, code, message", [
    ("chain: disc_brake\nmultibdy: {}", 2, "multibdy: unknown section; did you mean 'multibody'?"),
    ("chain: disc_brake\nmultibody: {duratoin: 1 s}", 2, "multibody.duratoin: unknown key; did you mean 'duration'?"),
    ("chain: disc_brake\nmultibody: {duration: 3 kg}", 2, "multibody.duration: expected a quantity in s"),
    ("chain: disc_brake\nmultibody: {pressures: [4 MPa]}", 2, "multibody.pressures: expected pressures among"),
    ("chain: disc_brake\nresponse: {settling: 3 s}", 2, "response.settling: expected less than multibody.duration"),
    ("chain: disc_brake\nresponse: {highest_frequency: 24 kHz}", 2, "expected at most structure.frequency_max"),
    ("chain: disc_brake\nsqueal: {highest_frequency: 24 kHz}", 2, "expected at most response.highest_frequency"),
    ("chain: none", 2, "chain: expected one of disc_brake"),
])
def test_bad_cases_are_one_sentence_without_traceback(tmp_path, text, code, message):
    (tmp_path / "bad.yaml").write_text(text)
    done = brakechain("run", tmp_path / "bad.yaml", "--run", tmp_path / "run")
    assert done.returncode == code and message in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "run").exists(), "nothing is made before the case is understood"


def test_surface_fits_a_generator_to_a_scan(tmp_path):
    """What it prints is a section that the stage reads; without a scan it needs a case."""
    rows = np.random.default_rng(1).standard_normal((40, 40)) * 1e-6
    head = "# Channel: Topography\n# Width: 40 um\n# Height: 40 um\n# Value units: m\n"
    (tmp_path / "scan.txt").write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in rows))
    done = brakechain("surface", "--fit", tmp_path / "scan.txt", "--set", "seeds=1", "--set", "body=disc")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("# scan.txt: patches of") and "Sdq" in done.stdout
    (tmp_path / "case.yaml").write_text("chain: disc_brake\n" + done.stdout)
    case = brakechain("surface", tmp_path / "case.yaml", "--run", tmp_path / "run", "--workers", "1")
    assert case.returncode == 0, case.stderr
    for wrong in ((), (tmp_path / "case.yaml", "--fit", tmp_path / "scan.txt")):
        done = brakechain("surface", *wrong)
        assert done.returncode == 2 and "expected either CONFIG or --fit SCAN" in done.stderr
    done = brakechain("surface", "--fit", tmp_path / "scan.txt", "--set", "sedes=1")
    assert done.returncode == 2 and "sedes: unknown key; did you mean 'seeds'?" in done.stderr


def test_plan_prints_and_writes_the_table(tmp_path):
    """Before the bench: the recording that the case names does not exist yet."""
    done = brakechain("plan", "docs/practice/rig.yaml", "--csv", tmp_path / "plan.csv", "--set",
                      "recording.files.0.file=not_yet.h5", "--set", "diagnosis.effects=[cubic_stiffness]",
                      "--set", "diagnosis.plan.wanted=[cubic_stiffness]")
    assert done.returncode == 0, done.stderr
    assert "cheapest set: soft (cost 1)" in done.stdout
    head, first, *_ = (tmp_path / "plan.csv").read_text().splitlines()
    assert head == "effect,soft,loud,tone,all,chosen" and first.startswith("cubic_stiffness at guide,")


def test_a_plan_of_another_chain_is_refused():
    done = brakechain("plan", "configs/belt.yaml")
    assert done.returncode == 2 and "chain: expected lumped_bench, whose runs can be planned" in done.stderr


def test_debug_shows_the_traceback(tmp_path):
    done = brakechain("run", tmp_path / "none.yaml", "--debug")
    assert "Traceback" in done.stderr and done.returncode == 2


def test_files_have_their_own_exit_code(tmp_path):
    assert brakechain("inspect", tmp_path / "none.h5").returncode == 4
    (tmp_path / "half.h5").write_bytes(b"\x89HDF\r\n\x1a\nhalf")
    done = brakechain("inspect", tmp_path / "half.h5")
    assert done.returncode == 4 and "truncated or damaged" in done.stderr


def test_schema_is_json_and_knows_units_and_origins():
    schema = json.loads(brakechain("schema", "disc_brake").stdout)
    assert schema["properties"]["multibody"] == {"$ref": "#/$defs/multibody"}
    duration = schema["$defs"]["multibody"]["properties"]["duration"]
    assert '"x-unit": "s"' in json.dumps(duration) and "origin" in json.dumps(duration)
    assert schema["additionalProperties"] is False
    assert brakechain("schema", "none").returncode == 2


def test_completion_is_told():
    assert "_BRAKECHAIN_COMPLETE=bash_source" in brakechain("completion").stdout


def test_public_data_are_listed_and_their_form_is_told(tmp_path):
    told = brakechain("data", "list").stdout
    assert "recordings/emps/DATA_EMPS.mat" in told and "licence: MIT" in told
    assert "channels/NAME" in brakechain("data", "format").stdout
    done = brakechain("data", "path", "none")
    assert done.returncode == 2 and "an unregistered name" in done.stderr


def test_a_run_ends_with_what_the_first_screen_says(tmp_path):
    (tmp_path / "verdict.json").write_text('{"headline": "Coulomb is missing; takes 97\\u202f%"}', encoding="utf-8")
    assert _headline(tmp_path / "verdict.json") == "verdict: Coulomb is missing; takes 97 %"

"""A finished case computes nothing; a change reruns what it touches, and says so beforehand."""

import shutil
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.contract.integrity import seen
from pipeline.products import FrictionMap
from stages import CHAINS
from tests.chain.conftest import QUICK, contents
from tests.commands import ROOT, brakechain

NAMES = CHAINS["disc_brake"]
TABLES = {f"friction_map.{kind}" for kind in ("csv", "inp", "adm", "txt")}


#: a chain whose stages and page take a second or less, and how it is run
BELT, SHORT = ROOT / "configs" / "belt.yaml", ("--set", "transient.duration=3 s", "--set", "transient.window=2 s")


@pytest.fixture(scope="module")
def whole_belt(tmp_path_factory):
    """Folder of a run of the block on a belt finished by two processes, others go with one; read only."""
    folder = tmp_path_factory.mktemp("belt") / "run"
    brakechain("run", BELT, "--run", folder, *SHORT, "--workers", 2)
    return folder


@pytest.fixture
def belt(whole_belt, tmp_path):
    """A copy of it that a test may change."""
    return Path(shutil.copytree(whole_belt, tmp_path / "belt"))


def test_every_product_is_there(finished):
    assert set(contents(finished)) == {*NAMES, *TABLES, "report.html", "verdict.json"}
    assert (finished / "report.html").stat().st_size > 50_000 and all((finished / name).exists() for name in TABLES)
    assert not [p.name for p in finished.glob(".*") if p.name not in (".lock", seen.LIST)]


def test_a_second_run_computes_nothing_and_says_so(finished):
    assert "nothing to compute" in brakechain("run", QUICK, "--run", finished).stdout
    assert "up to date" in brakechain("chain", QUICK, "--run", finished).stdout


def test_a_changed_setting_reruns_its_stage_and_what_follows(copy):
    change = ("--run", copy, "--set", "multibody.duration=0.025 s")
    planned = brakechain("run", QUICK, *change, "--dry-run").stdout
    before = contents(copy)
    told = brakechain("run", QUICK, *change, "--until", "comparison").stdout
    for name in NAMES[:NAMES.index("multibody")]:
        assert f"{name:<16} up to date" in planned and f"\n{name} " not in f"\n{told}"
    assert "multibody        would run: setting duration: " in planned and "-> 0.025" in planned
    for name in NAMES[NAMES.index("multibody"):]:
        assert f"{name:<16} would run" in planned and (name == "report" or f"\n{name} " in f"\n{told}")
    changed = {name for name, content in contents(copy).items() if content != before[name]}
    assert {"multibody", "response", "squeal"} <= changed


def test_a_changed_setting_rewrites_the_page(belt):
    before = contents(belt)
    told = brakechain("run", BELT, "--run", belt, *SHORT, "--set", "transient.friction_at_rest=0.25").stdout
    assert {line.split()[0] for line in told.splitlines() if " s   " in line} == {"transient", "comparison", "report"}
    changed = {name for name, content in contents(belt).items() if content != before[name]}
    assert {"transient", "report", "report.html"} <= changed and "complex_modes" not in changed


def test_a_report_of_products_that_are_gone_is_refused_and_the_old_one_stays(copy):
    (copy / "effects.h5").unlink()
    told = brakechain("report", QUICK, "--run", copy, code=4).stderr
    assert "effects.h5: expected the product effects, found no file; run 'brakechain effects' first" in told
    assert (copy / "report.html").exists()


def test_one_step_is_one_command(copy):
    (copy / "squeal.h5").unlink()
    assert "squeal" in brakechain("squeal", QUICK, "--run", copy).stdout
    assert "nothing to compute" in brakechain("squeal", QUICK, "--run", copy).stdout
    assert "forced" in brakechain("squeal", QUICK, "--run", copy, "--force").stdout


def test_until_and_from(copy):
    told = brakechain("run", QUICK, "--run", copy, "--until", "friction_map", "--force", "surface").stdout
    assert "surface" in told and "squeal" not in told
    told = brakechain("run", QUICK, "--run", copy, "--from", "squeal", "--force", "squeal").stdout
    assert "squeal" in told and "multibody" not in told
    assert "expected one of" in brakechain("run", QUICK, "--run", copy, "--from", "nothing", code=2).stderr


def test_a_damaged_product_is_told_by_a_step_and_mended_by_a_run(belt, whole_belt, monkeypatch):
    """A stage that takes long enough for a page of its own, which the whole page then replaces."""
    monkeypatch.setattr(main, "_WORTH_A_PAGE", 0.0)
    damaged = belt / "complex_modes.h5"
    damaged.write_bytes(damaged.read_bytes()[:3000])
    told = brakechain("report", BELT, "--run", belt, *SHORT, "--force", code=4).stderr
    assert "complex_modes.h5" in told and "truncated or damaged" in told and "Traceback" not in told
    told = brakechain("run", BELT, "--run", belt, *SHORT).stdout
    assert "its file is damaged" in told and "\nreport " in told
    assert contents(belt) == contents(whole_belt)


@pytest.mark.parametrize("name", ["surface", "friction_map", "structure", "complex_modes", "multibody", "squeal"])
def test_xarray_shows_named_dimensions_and_units(finished, name):
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(finished / f"{name}.h5", engine="h5netcdf", group="data") as data:
        assert data.sizes and all("units" in data[v].attrs for v in data.data_vars if data[v].dtype.kind in "fi")
        assert not any(str(d).startswith("phony") for d in data.sizes)


def test_inspect_tells_dimensions_units_and_provenance(finished):
    told = brakechain("inspect", finished / "friction_map.h5").stdout
    assert f"friction_map version {FrictionMap.version}" in told and "friction (pressure: " in told
    assert "provenance" in told and "Pa" in told and "settings" in told

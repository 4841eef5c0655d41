"""The cases of the bimaterial rupture: every one is checked, the quick one runs."""

import signal

import pytest

from pipeline.contract import store
from pipeline.contract.case import load
from pipeline.products import Comparison, Rupture
from stages import CHAINS
from stages import load as stage_of
from tests.chain.conftest import contents
from tests.chain.test_kill import killed_while_computing, killed_while_writing
from tests.commands import ROOT, brakechain

QUICK = ROOT / "configs" / "bimaterial_rupture_quick.yaml"
#: a third of the frames: the animation of them takes longer than the rupture
FEW = ("--set", "rupture.frames=4")


@pytest.mark.parametrize("path", sorted(ROOT.glob("configs/bimaterial_rupture*.yaml")), ids=lambda p: p.stem)
def test_a_case_is_well_formed(path):
    case = load(path, CHAINS, stage_of)
    assert case.sections["rupture"].stress_ratio == 0.94


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of an undisturbed run of the quick case, read only."""
    folder = tmp_path_factory.mktemp("rupture")
    brakechain("run", QUICK, "--run", folder, *FEW)
    return folder


def test_the_quick_case_runs_and_computes_nothing_twice(whole):
    found, compared = (store.read(cls, whole / f"{cls.name}.h5") for cls in (Rupture, Comparison))
    assert found.study.size == 11 and found.frame_time.size == 4
    assert compared.ours_known.sum() > 10
    page = (whole / "report.html").read_text()
    assert '<section id="rupture">' in page and len(page) < 5e6
    assert "nothing to compute" in brakechain("run", QUICK, "--run", whole, *FEW).stdout


def test_a_killed_run_goes_on_to_the_content_of_an_undisturbed_one(whole, tmp_path):
    """Killed while computing, then in the middle of writing every product."""
    assert killed_while_computing(0.2, tmp_path / "killed", QUICK, *FEW) == -signal.SIGKILL
    for product in CHAINS["bimaterial_rupture"]:
        assert killed_while_writing(product, tmp_path / "killed", QUICK, *FEW) == -signal.SIGKILL
        assert not (tmp_path / "killed" / f"{product}.h5").exists()
    brakechain("run", QUICK, "--run", tmp_path / "killed", *FEW)
    assert contents(tmp_path / "killed") == contents(whole)
    assert not list((tmp_path / "killed").glob(".*.partial"))


@pytest.mark.parametrize("change, first", [("rupture.run_in=0.3 mm", 0), ("comparison.tuned=null", 1)])
def test_a_changed_setting_reruns_its_stage_and_what_follows(whole, change, first):
    told = brakechain("run", QUICK, "--run", whole, *FEW, "--set", change, "--dry-run").stdout
    again = [line.split()[0] for line in told.splitlines() if "would run" in line]
    assert again == list(CHAINS["bimaterial_rupture"][first:])


@pytest.mark.parametrize("override, message", [
    ("rupture.stress_ratio=1", "rupture.stress_ratio: expected shear over pressure from 0 to below the static"),
    ("rupture.nucleation_length=60 um", "rupture.nucleation_length: expected 2 or more elements"),
    ("rupture.step_share=1.5", "rupture.step_share: input should be less than or equal to 1"),
    ("rupture.upper.poisson_ratio=0.5", "rupture.upper.poisson_ratio: input should be less than 0.5"),
    ("rupture.lower_spacing=30 um", "expected two or more whole elements of 3e-05 m"),
])
def test_bad_input_is_refused_before_anything_is_made(tmp_path, override, message):
    told = brakechain("run", QUICK, "--run", tmp_path / "run", "--set", override, code=2).stderr
    assert message in told and "Traceback" not in told
    assert not (tmp_path / "run").exists()

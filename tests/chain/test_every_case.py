"""Every case of the project runs as it stands; those that take minutes are slow studies."""

import os
from pathlib import Path

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Comparison
from tests.chain.conftest import ROOT, brakechain

#: cases in full resolution; disc_brake_scanned needs recordings as well
SLOW = {**dict.fromkeys(("disc_brake", "bimaterial_rupture", "bimaterial_rupture_fine", "pin_on_disc",
                          "pin_on_disc_paper_step", "beam_geometry"), [pytest.mark.slow]),
        "disc_brake_scanned": [pytest.mark.slow, pytest.mark.measured], "emps_recording": [pytest.mark.measured]}
CASES = [pytest.param(path, marks=SLOW.get(path.stem, ()), id=path.stem)
         for path in sorted((ROOT / "configs").glob("*.yaml")) if not path.stem.endswith("_quick")]
DATA = Path(os.environ.get("BRAKECHAIN_DATA", ROOT.parent / "shared" / "data"))
MEASURED = ("disc_brake_scanned", "emps_recording")
CLOSED_FORM = ("belt", "two_mode_flutter", "wobbling_disc")
#: beam on beam: chaotic, and its median lies nearer to its bound than it wanders (data/reference/beam_geometry.yaml)
ON_THE_EDGE = {"largest normal contact force"}


@pytest.mark.parametrize("case", CASES)
def test_a_case_runs_to_its_report(case, tmp_path, monkeypatch):
    """Lumped systems meet every closed form, the two beams what is printed; quick variants have tests of their own."""
    if case.stem in MEASURED:
        if not DATA.is_dir():
            pytest.skip(f"no public recordings at {DATA}; set BRAKECHAIN_DATA")
        monkeypatch.setenv("BRAKECHAIN_DATA", str(DATA.resolve()))
    brakechain("run", case, "--run", tmp_path / "run")
    assert (tmp_path / "run" / "report.html").stat().st_size > 10_000
    if case.stem in CLOSED_FORM:
        found = store.read(Comparison, tmp_path / "run" / "comparison.h5")
        assert len(found.row) and set(found.verdict) == {"within"}
    if case.stem == "beam_on_beam":
        found = store.read(Comparison, tmp_path / "run" / "comparison.h5")
        outside = set(np.array(found.row, str)[np.array(found.verdict, str) == "outside"])
        assert outside <= ON_THE_EDGE, "one geometry meets coalescences, modes and motion"

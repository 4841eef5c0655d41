"""Every case of the project runs as it stands; those that take minutes are slow studies."""

import json
import os

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Comparison, Convergence, LockIn
from pipeline.views.pages import facts
from tests.commands import ROOT, brakechain
from tests.studies import brake, brake_stops, self_excited, worn

#: cases in full resolution; disc_brake_scanned needs recordings as well
SLOW = {**dict.fromkeys(("disc_brake", "bimaterial_rupture", "pin_on_disc", "pin_on_disc_paper_step"),
                        [pytest.mark.slow]),
        **dict.fromkeys(("disc_brake_paper_joints", "disc_brake_matrix", "pin_on_disc_bench", "disc_brake_bench",
                         "squealing_brake_bench", "worn_pad", "disc_table1", "disc_brake_lines", "pin_on_disc_lines",
                         "bimaterial_rupture_fine", "beam_geometry"), [pytest.mark.slow, pytest.mark.study]),
        **dict.fromkeys(("emps", "silverbox", "tribometer", "disc_brake_scanned"),
                        [pytest.mark.slow, pytest.mark.study, pytest.mark.measured]),
        **dict.fromkeys(("brake_matrices", "tribometer_map"),
                        [pytest.mark.slow, pytest.mark.measured]),
        "emps_recording": [pytest.mark.measured]}
CASES = [pytest.param(path, marks=SLOW.get(path.stem, ()), id=path.stem)
         for path in sorted((ROOT / "configs").glob("*.yaml")) if not path.stem.endswith("_quick")]
PRACTICE = ROOT / "data" / "runs" / "practice"
#: a fifth of the draws go the same ways in a fifth of the time; closed forms of the wobble are of modes, not of motion
FEWER = {"disc_brake": ("--set", "probability.draws=100"), "wobbling_disc": ("--set", "transient.duration=1 s")}
CLOSED_FORM = ("belt", "two_mode_flutter", "wobbling_disc", "brake_matrices")
#: case -> facts that may be outside. The motion of the beams is chaotic: the median force varies between processors by
#: more than its distance from the bound (data/reference/beam_geometry.yaml). The rocking mode was measured below the
#: frequency range of the paper's model update.
NOT_MET = {"beam_on_beam": {"peak_force"}, "pin_on_disc": {"disc_rocking_test"}}


@pytest.mark.parametrize("case", CASES)
def test_a_case_runs_to_its_report(case, tmp_path):
    """Lumped systems meet every closed form, beams and pin what is printed; numbers are those that README shows.

    Quick variants have tests of their own.
    """
    for bench, first, study in (("pin_on_disc_bench", "bench_0.h5", self_excited), ("worn_pad", "worn_0.h5", worn),
                                ("disc_brake_bench", "brake_0.h5", brake),
                                ("squealing_brake_bench", "squealing_brake_0.h5", brake_stops)):
        if case.stem == bench and not (PRACTICE / first).exists():
            study.practice(PRACTICE)
    brakechain("run", case, "--run", tmp_path / "run", "--workers", os.cpu_count() if case.stem in SLOW else 1,
               *FEWER.get(case.stem, ()))
    assert (tmp_path / "run" / "report.html").stat().st_size > 10_000
    recorded = ROOT / "data" / "reference" / "computed" / f"{case.stem}.json"
    if recorded.exists():
        fresh = facts.record([store.read(Comparison, tmp_path / "run" / "comparison.h5")], [])["facts"]
        assert not facts.deviations(json.loads(recorded.read_text())["facts"], fresh)
    if case.stem == "disc_brake":
        refined = store.read(Convergence, tmp_path / "run" / "convergence.h5")
        assert refined.converged and len(refined.root) and np.all(refined.held), refined
        assert not refined.added and not len(refined.left_out), refined
    if case.stem not in (*CLOSED_FORM, *NOT_MET):
        return
    found = store.read(Comparison, tmp_path / "run" / "comparison.h5")
    verdict = np.array(found.verdict, str)
    assert len(verdict) and set(np.array(found.key, str)[verdict == "outside"]) <= NOT_MET.get(case.stem, set())
    if case.stem in CLOSED_FORM:
        assert set(verdict) == {"within"}
    if case.stem == "pin_on_disc":
        roots = store.read(LockIn, tmp_path / "run" / "lock_in.h5").root[:2]
        assert np.all(np.abs(abs(roots.imag) / (2 * np.pi) - 2217.5) < 27.5), "golden: 2190 to 2245 Hz"

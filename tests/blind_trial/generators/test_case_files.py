"""Files of a case: neutral, readable by the tool, without a trace of the truth."""

import numpy as np

from pipeline.blind_trial.generators.case_files import truth, write
from pipeline.blind_trial.generators.spring_mass.rig_case import LEVELS, made
from pipeline.recordings.neutral import read_neutral


def test_files_hold_the_case_and_only_the_truth_tells_what_is_hidden(tmp_path):
    case = made(3, "coulomb", 1, 0.01, 2)
    write(case, tmp_path)
    runs = read_neutral(tmp_path / "recordings.h5")
    assert list(runs) == [f"run_{k}" for k in range(len(LEVELS))]
    np.testing.assert_array_equal(runs["run_1"].channels["x_1"].samples, case.runs[1][1][1])
    np.testing.assert_array_equal(runs["run_1"].channels["force"].samples, case.runs[1][0])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["nominal.yaml", "recordings.h5"]
    told = truth(case)
    assert told["parameters"]["joints.link_1.stiffness"] == case.truth.links[1].stiffness
    assert told["class"] == "effect" and [(e["name"], e["place"]) for e in told["effects"]] == [("coulomb", "link_1")]
    text = (tmp_path / "nominal.yaml").read_text()
    assert "coulomb" not in text and not any(f"{m:.6g}" in text for m in case.truth.mass)

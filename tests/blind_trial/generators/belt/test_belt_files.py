"""Files of a case on a belt: neutral, with loads and belts of the runs, without a trace of the truth."""

import numpy as np

from pipeline.blind_trial.generators.belt.belt import LOADS, made
from pipeline.blind_trial.generators.belt.belt_files import nominal, truth, write
from pipeline.recordings.neutral import read_neutral


def test_files_hold_the_case_and_only_the_truth_tells_what_is_hidden(tmp_path):
    case = made(3, ("falling_friction",))
    write(case, tmp_path)
    runs = read_neutral(tmp_path / "recordings.h5")
    assert [float(np.ravel(r.conditions["normal_load"].value)[0]) for r in runs.values()] == list(LOADS)
    np.testing.assert_array_equal(runs["run_1"].channels["belt"].samples, case.runs[1][1])
    np.testing.assert_array_equal(runs["run_2"].channels["x_0"].samples, case.runs[2][2][0])
    told = truth(case)
    assert [(e["name"], e["place"]) for e in told["effects"]] == [("falling_friction", "contact")]
    assert told["effects"][0]["parameters"]["rise"] > 0 and told["left"] > 10 and told["class"] == "effect"
    text = (tmp_path / "nominal.yaml").read_text()
    assert "falling" not in text and f"{case.belt.friction:.6f}" not in text
    assert nominal(case)["diagnosis"]["held_out"] == ["run_3"]

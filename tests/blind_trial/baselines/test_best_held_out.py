"""The law that predicts best: right where something is large, and it needs a run that was kept."""

import pytest
import yaml

from pipeline.blind_trial.baselines.best_held_out import answer
from pipeline.contract.errors import ConfigError


def test_it_names_what_is_large_and_something_where_nothing_is_missing(hidden, control):
    assert [(e["name"], e["place"]) for e in answer(hidden)["effects"]] == [("cubic_stiffness", "link_0")]
    assert answer(control)["verdict"] == "missing", "without a null test the best of many is better than none"


def test_without_a_held_out_run_it_refuses(control, tmp_path):
    case = yaml.safe_load((control / "nominal.yaml").read_text())
    del case["diagnosis"]["held_out"]
    (tmp_path / "nominal.yaml").write_text(yaml.safe_dump(case))
    (tmp_path / "recordings.h5").write_bytes((control / "recordings.h5").read_bytes())
    with pytest.raises(ConfigError, match="held_out"):
        answer(tmp_path)

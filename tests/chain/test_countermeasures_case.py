"""Countermeasures of a brake on coarse grids: a remedy is told as such, a change without effect as none."""

import csv

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Countermeasures
from tests.commands import brakechain

DAMPED = """based_on: my_brake_quick.yaml
title: damping shims
structure:
  pad: {lining_loss_factor: 0.1, backplate_loss_factor: 0.1}
  joints: {finger_loss_factor: 0.2, piston_loss_factor: 0.2}
countermeasures: {cost: {mass: 0.1 kg}}
"""
#: of the free disc alone, whose modes are computed for themselves
SAME = "based_on: my_brake_quick.yaml\nstructure: {free_frequency_max: 2.1 kHz}\n"


@pytest.mark.slow
@pytest.mark.study
def test_damping_lowers_the_probability_of_squeal_and_no_change_leaves_it(tmp_path):
    brakechain("new", tmp_path / "my_brake", "--quick")
    files = [tmp_path / "damped.yaml", tmp_path / "same.yaml"]
    for file, text in zip(files, (DAMPED, SAME), strict=True):
        file.write_text(text)
    command = ("compare", tmp_path / "my_brake_quick.yaml", *files, "--run", tmp_path / "run", "--workers", "1")
    done = brakechain(*command)
    assert "Damped lowers the probability of squeal most" in done.stdout and "at mass 0.1 kg" in done.stdout
    made = store.read(Countermeasures, tmp_path / "run" / "countermeasures.h5")
    damped, same = (made.mode_variant == k for k in range(2))
    assert list(made.variant) == ["damped", "same"] and made.note[0] == "damping shims"
    assert {"gone"} <= set(made.state[damped]) <= {"gone", "weaker", "unchanged"}
    assert made.overall_change_interval[0, 1] < 0 and made.paired.all()
    assert set(made.state[same]) == {"unchanged"} and made.clear[same].all() and (made.mac[same] > 1 - 1e-6).all()
    np.testing.assert_allclose(made.after[same], made.before[same], rtol=1e-6)
    assert made.overall_change[1] == 0 and not made.probability_change[1].any()
    page = (tmp_path / "run" / "report.html").read_text()
    assert 'id="countermeasures"' in page and "What helps" in page
    rows = list(csv.DictReader((tmp_path / "run" / "countermeasures.csv").read_text().splitlines()))
    assert len(rows) == len(made.state) + 2 and rows[0]["mass / kg"] == "0.1"
    assert "nothing to compute" in brakechain(*command).stdout

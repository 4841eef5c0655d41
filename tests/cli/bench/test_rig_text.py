"""The YAML of a first case: what only a user knows is marked, and the program takes it as it stands."""

import numpy as np
import pytest

import stages
from pipeline.cli.bench.rig import rig
from pipeline.cli.bench.rig_text import text
from pipeline.contract import case
from tests.cli.bench.rigs import decays, driven


def written(folder, *files):
    file = folder / "mine.yaml"
    file.write_text(text(rig(files), file))
    return file


def test_the_case_of_a_driven_shaft_is_a_balance_without_a_step(tmp_path):
    file = written(tmp_path, driven(tmp_path))
    sections = case.load(file, stages.CHAINS, stages.load).sections
    assert sections["bench"].forward == "equation" and "step" not in file.read_text()
    assert sections["recording"].files[0].columns["angle"].measures == "angle"
    assert list(sections["diagnosis"].parameters) == ["masses.shaft", "joints.bearing.damping", "inputs.torque.offset"]
    unit = next(line for line in file.read_text().splitlines() if "column: angle" in line)
    assert "<- the file states no unit" in unit and "deg" in unit


def test_the_case_of_decays_is_simulated_from_fitted_starts(tmp_path):
    file = written(tmp_path, decays(tmp_path))
    sections = case.load(file, stages.CHAINS, stages.load).sections
    assert sections["bench"].forward == "simulation" and sections["bench"].start == "fitted"
    assert sections["lumped"].springs["support"].stiffness > 0 and "masses" not in str(sections["diagnosis"].parameters)


def test_a_reversed_force_is_written_with_its_sign(tmp_path):
    file = written(tmp_path, driven(tmp_path, sign=-1))
    assert "shaft.rotation: -1" in file.read_text() and "the motion needs the opposite" in file.read_text()


def test_two_joints_that_gravity_couples_have_a_spring_along_their_sum(tmp_path):
    """Angles against the arm before: the second weight feels the sum of both."""
    time = np.arange(4000) / 200
    one, two = (0.3 * np.sin(w * time) + 0.2 * np.sin(2.3 * w * time + 1) for w in (3.0, 4.7))
    speeds = [np.gradient(q, 1 / 200) for q in (one, two)]
    bends = [np.gradient(v, 1 / 200) for v in speeds]
    torques = [0.2 * bends[0] + 0.05 * bends[1] + 0.3 * speeds[0] + 2.0 * one + 0.5 * (one + two),
               0.05 * bends[0] + 0.1 * bends[1] + 0.2 * speeds[1] + 0.5 * (one + two)]
    np.savetxt(tmp_path / "arm.csv", np.column_stack((time, one, two, *torques)), delimiter=",",
               header="time,pos1,pos2,tau1,tau2", comments="", fmt="%.9g")
    lumped = case.load(written(tmp_path, tmp_path / "arm.csv"), stages.CHAINS, stages.load).sections["lumped"]
    link = lumped.springs["link_12"]
    assert link.along == {"shaft_1.rotation": 1, "shaft_2.rotation": 1}
    held = lumped.springs["bearing_1"]
    assert (link.torsional_stiffness, held.torsional_stiffness) == pytest.approx((0.5, 2), rel=0.05)
    assert lumped.inertias["coupling_12"].inertia == pytest.approx(0.05, rel=0.05)


def test_beside_a_base_that_moves_laws_have_a_joint_to_the_ground(tmp_path):
    time = np.arange(2000) / 100
    np.savetxt(tmp_path / "rig.csv", np.column_stack((time, np.sin(6 * time), 1.5 * np.sin(6 * time - 0.2))),
               delimiter=",", header="t,base [mm],top position [mm]", comments="", fmt="%.9g")
    sections = case.load(written(tmp_path, tmp_path / "rig.csv"), stages.CHAINS, stages.load).sections
    assert sections["lumped"].inputs["base"].displaces == "support" and "surroundings" in sections["lumped"].springs
    assert sections["bench"].inputs["base"].channel == "base"


def test_what_falls_has_its_weight_in_every_run(tmp_path):
    time = np.arange(60) / 15
    np.savetxt(tmp_path / "ball.csv", np.column_stack((time, 80 - 9.81 / 2 * time**2)), delimiter=",",
               header="Time (s),Height (m)", comments="", fmt="%.9g")
    sections = case.load(written(tmp_path, tmp_path / "ball.csv"), stages.CHAINS, stages.load).sections
    assert sections["bench"].corrections == {"inputs.weight_1.offset": "-9.81 N"}
    assert list(sections["diagnosis"].parameters) == ["inputs.weight_1.offset"]
    assert not sections["lumped"].springs["support"].stiffness

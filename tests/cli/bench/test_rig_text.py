"""The YAML of a first case: what only a user knows is marked, and the program takes it as it stands."""

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

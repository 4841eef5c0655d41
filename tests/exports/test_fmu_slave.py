"""What a functional mock-up unit runs, without an importer: the same numbers as the modal form, and where it ends."""

import json
from importlib import import_module

import numpy as np
import pytest

from pipeline.exports.fmu import unit_of

FORCE = 3.0


@pytest.fixture
def slave(rig, tmp_path):
    """(the slave, the Unit that it holds)."""
    pytest.importorskip("pythonfmu", reason="the extra 'fmu' is not installed")
    unit = unit_of(rig)
    np.savez(tmp_path / "model.npz", root=unit.form.root, drive=unit.form.drive, rows=unit.form.rows)
    about = {"name": "rig", "description": "a rig", "version": "1", "guid": "0" * 32, "inputs": unit.inputs,
             "outputs": unit.outputs}
    (tmp_path / "interface.json").write_text(json.dumps(about))
    made = import_module("pipeline.exports.fmu_slave").SteadySliding(instance_name="a", resources=str(tmp_path))
    made.exit_initialization_mode()
    return made, unit


@pytest.mark.exact
def test_its_steps_are_those_of_the_modal_form(slave):
    made, unit = slave
    made.set_real([1], [FORCE])
    state, force = np.zeros(len(unit.form.root), complex), np.array([0.0, FORCE, 0.0])
    for length in (1e-4, 3e-4):
        assert made.do_step(0.0, length)
        state = unit.form.step(state, force, length)
        motion = np.ravel(unit.form.motion(state, force))
        np.testing.assert_allclose(made.get_real([3, 4, 5]), motion, rtol=1e-14)


def test_its_description_has_units_and_unknowns(slave):
    root = slave[0].to_xml()
    assert [e.tag for e in root][:2] == ["CoSimulation", "UnitDefinitions"]
    assert [e.find("Real").get("unit") for e in root.find("ModelVariables")] == ["Pa", "N", "N", "m", "m/s", "m/s2"]
    assert [e.get("index") for e in root.find("ModelStructure").find("InitialUnknowns")] == ["4", "5", "6"]


def test_a_motion_beyond_all_numbers_is_an_error_and_changes_nothing(slave):
    made, _ = slave
    made.set_real([1], [FORCE])
    assert made.do_step(0.0, 1e-3)
    before = made.get_real([3])
    with np.errstate(over="ignore", invalid="ignore"):
        assert not made.do_step(1e-3, 1e3)
    assert made.get_real([3]) == before and "grew beyond all numbers" in made.log_queue[0].msg


def test_its_state_can_be_kept(slave):
    made, _ = slave
    made.set_real([1], [FORCE])
    made.do_step(0.0, 1e-4)
    kept, seen = made._fmu_state_to_bytes(made._get_fmu_state()), made.get_real([3, 4, 5])
    made.do_step(1e-4, 1e-4)
    made._set_fmu_state(made._fmu_state_from_bytes(kept))
    assert made.get_real([3, 4, 5]) == seen

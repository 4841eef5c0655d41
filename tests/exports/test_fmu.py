"""The reduced sliding model as a functional mock-up unit, run by FMPy beside our own integrator."""

import sys

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.exports.contact_motion import ContactMotion
from pipeline.exports.fmu import contact_unit_of, unit_of, write_fmu
from pipeline.exports.run_products import sliding_products
from tests.exports.stepped import deviation

MISSING = "the extra 'fmu' and fmpy are not installed"


@pytest.fixture(scope="session")
def fmpy():
    """The importer, where it and the writer are installed."""
    pytest.importorskip("pythonfmu", reason=MISSING)
    return pytest.importorskip("fmpy", reason=MISSING)


def run(fmpy, path, steps, step, **forces):
    """(names, outputs (n, o) after each step) of a unit under held ``forces``."""
    found = fmpy.simulate_fmu(str(path), stop_time=steps * step, step_size=step, output_interval=step,
                              start_values=forces)
    return found.dtype.names[1:], np.array(found.tolist())[1:, 1:]


def test_inputs_and_outputs(brake):
    unit = unit_of(brake, 1)
    assert [name for name, *_ in unit.inputs] == ["pressure", "force.piston_1", "force_at.rim"]
    assert [(name, size) for name, _, size in unit.outputs] == [
        ("rim.displacement", "m"), ("rim.velocity", "m/s"), ("rim.acceleration", "m/s2")]
    area = sliding_products(brake)[1].input_area[0]
    np.testing.assert_allclose(unit.form.drive[:, 0], area * unit.form.drive[:, 1], rtol=1e-12)
    with pytest.raises(ConfigError, match="--state: expected one of"):
        unit_of(brake, 9)


def test_without_the_extra_it_says_what_to_install(rig, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pythonfmu.builder", None)
    with pytest.raises(ConfigError, match=r"found no such package; install the extra: pip install 'brakechain\[fmu\]'"):
        write_fmu(unit_of(rig), tmp_path / "rig.fmu", "a test")
    (tmp_path / "rig.fmu").write_text("")
    with pytest.raises(ConfigError, match="a name that is free, found a file"):
        write_fmu(unit_of(rig), tmp_path / "rig.fmu", "a test")


@pytest.mark.exact
@pytest.mark.parametrize(("which", "operating", "force", "name", "step"), [
    ("rig", 0, "force.press", "along", 2e-8), ("brake", 3, "force_at.rim", "rim", 1e-7)])
def test_a_unit_steps_as_our_own_integrator(request, fmpy, tmp_path, which, operating, force, name, step):
    """Unstable systems under a held force, 2 ms: within 1e-6 of the largest motion as the step of the integrator, of
    second order, goes to zero; of the rig, whose motion is slow, at that step as well."""
    folder, steps, duration = request.getfixturevalue(which), 40, 2e-3
    unit = unit_of(folder, operating)
    write_fmu(unit, tmp_path / "unit.fmu", "a test")
    names, found = run(fmpy, tmp_path / "unit.fmu", steps, duration / steps, **{force: 1.0})
    number = [each for each, *_ in unit.inputs].index(force)
    coarse, fine = (deviation(folder, operating, number, 1.0, h, duration, steps) for h in (2 * step, step))
    for k, seen in enumerate(("displacement", "velocity")):
        ours, size = found[:, names.index(f"{name}.{seen}")], abs(fine[k]).max()
        errors = [abs(ours - each).max() / size for each in (coarse[k], fine[k], (4 * fine[k] - coarse[k]) / 3)]
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05) and errors[2] <= 1e-6
        assert errors[1] <= (1e-6 if which == "rig" else 2e-5)
    assert unit.form.root.real.max() > 100


def test_a_unit_is_valid_and_goes_back_to_a_state(rig, fmpy, tmp_path):
    """By the rules of FMI 2.0; its state can be kept, and steps may have any length."""
    path, known = tmp_path / "2 rigs.fmu", list(sys.path)
    write_fmu(unit_of(rig, 1), path, "a test")
    assert sys.path == known and not [name for name in sys.modules if name.startswith("model_2_rigs")]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["2 rigs.fmu"]
    assert fmpy.validation.validate_fmu(str(path)) == []
    description = fmpy.read_model_description(str(path))
    assert description.modelName == "model_2_rigs" and "operating point 1 (2 Pa" in description.description
    assert {v.name: v.unit for v in description.modelVariables}["along.velocity"] == "m/s"
    _, once = run(fmpy, path, 1, 1e-3, **{"force.press": 2.0})
    _, often = run(fmpy, path, 10, 1e-4, **{"force.press": 2.0})
    np.testing.assert_allclose(often[-1], once[-1], rtol=1e-9)
    folder = fmpy.extract(str(path))
    unit = fmpy.instantiate_fmu(folder, description, "CoSimulation")
    unit.setupExperiment()
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    number = [v.valueReference for v in description.modelVariables if v.name == "along.velocity"]
    unit.setReal([v.valueReference for v in description.modelVariables if v.name == "force.press"], [2.0])
    unit.doStep(0.0, 1e-4)
    kept, seen = unit.getFMUstate(), unit.getReal(number)
    unit.doStep(1e-4, 1e-4)
    assert unit.getReal(number) != seen
    unit.setFMUstate(kept)
    assert unit.getReal(number) == seen
    unit.freeFMUstate(kept)
    unit.terminate()
    unit.freeInstance()


def test_a_unit_with_contacts_steps_as_our_own_integrator(rig, fmpy, tmp_path):
    """In ten communication steps as in one run, to the rounding; under a force that lifts the contact."""
    write_fmu(contact_unit_of(rig, 1, 1e-6), tmp_path / "rig.fmu", "a test")
    names, found = run(fmpy, tmp_path / "rig.fmu", 10, 1e-4, **{"force.press": -300.0})
    motion = ContactMotion.of(rig, 1, 1e-6)
    assert motion.outputs[-2:] == pytest.approx(sliding_products(rig)[0].operating_force[1].sum() * np.array([1, 0.4]))
    motion.step(np.array([0.0, -300.0, 0.0]), 1e-3)
    assert names == ("along.displacement", "along.velocity", "contacts.normal_force", "contacts.friction_force")
    np.testing.assert_allclose(found[-1], motion.outputs, rtol=1e-9)
    assert (found[:, 2] == 0).any() and (found[:, 2] > 0).any()

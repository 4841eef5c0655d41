"""Stage lumped: from the YAML of a system to its rows, loads and histories, and on through the chain."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.lumped import Settings, lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from stages.transient import Settings as Motion
from stages.transient import transient

BLOCK = {"masses": {"block": {"mass": "2 kg", "moves": ["x"]}}}
TIED = {**BLOCK, "springs": {"tie": {"between": ["block.x", "ground"], "stiffness": "800 N/m", "damping": "4 N s/m"}},
        "sensors": {"block": {"along": {"block.x": 1}}}}


def built(document):
    return lumped(settings=fill(Settings, document, "case.yaml: lumped"))


def moved(document, **settings):
    chosen = {"step": "0.1 ms", "record_every": 5, "duration": "1 s", "window": "0.5 s", "start": "rest",
              "kick": "0 m/s", "lowest_frequency": "1 Hz", "highest_frequency": "10 kHz", **settings}
    return transient(reduced_model(built(document), settings=Reduction()), settings=Motion.model_validate(chosen))


def test_rows_of_springs_contacts_and_sensors():
    wheel = {"masses": {"wheel": {"mass": "1 kg", "inertia": "0.1 kg m^2", "moves": ["x", "rotation"]}},
             "springs": {"rim": {"along": {"wheel.x": 1, "wheel.rotation": "-30 mm"}, "stiffness": "5 N/mm"}},
             "contacts": {"brake": {"tangent": {"wheel.rotation": "50 mm"}, "normal_force": "10 N"}},
             "load_factors": ["1 Pa", "3 Pa"]}
    found = built(wheel)
    np.testing.assert_allclose(found.joint_rows, [[1.0, -0.03]])
    np.testing.assert_allclose(found.contact_tangent, [[0.0, 0.05]])
    np.testing.assert_allclose(found.preload, [[10.0], [30.0]])
    assert list(found.coordinate_name) == ["wheel.x", "wheel.rotation"] and not found.contact_normal.any()


def test_contact_forces_are_those_of_statics_and_go_with_the_load():
    pressed = {"masses": {"pin": {"mass": "1 kg", "moves": ["x", "y"]}},
               "springs": {"tie": {"between": ["pin.x", "ground"], "stiffness": "1 N/mm"}},
               "contacts": {"tip": {"tangent": {"pin.x": 1}, "normal": {"pin.y": 1}, "stiffness": "1 N/um"}},
               "inputs": {"weight": {"along": {"pin.y": -1}, "force": "20 N"}}, "load_factors": ["1 Pa", "2 Pa"]}
    found = built(pressed)
    np.testing.assert_allclose(found.preload, [[20.0], [40.0]])
    np.testing.assert_allclose(found.contact_stiffness, 1e6)
    assert found.law_pressure[1] / found.law_closure[1] * found.contact_area[0] == pytest.approx(1e6)


@pytest.mark.exact
def test_a_free_mass_under_a_force_step_accelerates():
    """No spring, no contact: x'' = F / m from 0.2 s on."""
    free = {**BLOCK, "inputs": {"motor": {"along": {"block.x": 1}, "force": "3 N",
                                          "history": {"kind": "step", "begin": "0.2 s"}}},
            "sensors": {"block": {"along": {"block.x": 1}}}}
    found = moved(free)
    np.testing.assert_allclose(found.velocity[0, 0], 1.5 * np.clip(found.time - 0.2, 0, None), atol=1e-3)


@pytest.mark.exact
def test_a_moved_end_drives_the_mass_through_spring_and_damper():
    """Steady response of m x'' + c x' + k x = c u' + k u to u = U sin(w t)."""
    shaken = {**TIED, "inputs": {"shaker": {"displaces": "tie", "displacement": "1 mm", "history": {
        "kind": "harmonic", "frequency": "4 Hz"}}}, "histories": {"interval": "0.2 ms", "duration": "12 s"}}
    found, angular = moved(shaken, duration="12 s", window="2 s"), 2 * np.pi * 4
    gain = abs((800 + 4j * angular) / (800 - 2 * angular**2 + 4j * angular))
    late = found.displacement[0, 0, found.time > 10]
    assert np.ptp(late) / 2 == pytest.approx(1e-3 * gain, rel=2e-3)


@pytest.mark.exact
def test_a_recorded_force_with_its_gain(tmp_path):
    """A column in volts at 2.5 N/V, equal intervals: the ramp 4 V/s moves the free mass by 10 t^3 / (6 m)."""
    time = np.arange(0, 1.01, 0.01)
    (tmp_path / "log.csv").write_text("t, volt\n" + "\n".join(f"{t:.2f}, {4 * t:.6f}" for t in time))
    recorded = {"kind": "file", "file": str(tmp_path / "log.csv"), "column": "volt", "interval": "10 ms"}
    free = {**BLOCK, "inputs": {"motor": {"along": {"block.x": 1}, "force": "2.5 N", "history": recorded}},
            "sensors": {"block": {"along": {"block.x": 1}}}}
    found = moved(free)
    np.testing.assert_allclose(found.displacement[0, 0], 10 * found.time**3 / 12, atol=1e-6)
    timed = {**recorded, "time": "t"}
    np.testing.assert_allclose(built({**free, "inputs": {"motor": {**free["inputs"]["motor"], "history": timed}}})
                               .input_history, built(free).input_history, atol=1e-9)


def test_a_recorded_force_that_lacks_a_sample_is_refused(tmp_path):
    (tmp_path / "log.csv").write_text("volt\n" + "\n".join(["1"] * 60 + ["nan"] + ["1"] * 60))
    recorded = {"kind": "file", "file": str(tmp_path / "log.csv"), "column": "volt", "interval": "10 ms"}
    motor = {"along": {"block.x": 1}, "force": "2.5 N", "history": recorded}
    with pytest.raises(ConfigError, match="history.column: expected a number in every row, found none in 1 rows"):
        built({**BLOCK, "inputs": {"motor": motor}})
    motor = {**motor, "history": {**recorded, "column": "vold"}}
    with pytest.raises(ConfigError, match="did you mean 'volt'"):
        built({**BLOCK, "inputs": {"motor": motor}})


def test_a_reversing_drive_turns_friction_round():
    """A soft mass is carried along, at the limit of friction, one way and the other."""
    rubbed = {**TIED, "contacts": {"belt": {"tangent": {"block.x": 1}, "normal_force": "10 N"}},
              "drive": {"history": {"kind": "harmonic", "frequency": "1 Hz"}}}
    found = moved(rubbed, speeds=["5 rad/s"], friction=0.3, friction_at_rest=0.3)
    force = found.friction_force[0, 0]
    assert np.median(force[(found.time > 0.1) & (found.time < 0.4)]) == pytest.approx(3.0, rel=1e-6)
    assert np.median(force[(found.time > 0.6) & (found.time < 0.9)]) == pytest.approx(-3.0, rel=1e-6)


@pytest.mark.parametrize(("change", "said"), [
    ({"springs": {"tie": {"between": ["blok.x", "ground"]}}}, "lumped.springs.tie.between: expected a coordinate"),
    ({"springs": {"tie": {"between": ["blok.x", "ground"]}}}, "did you mean 'block.x'?"),
    ({"springs": {"tie": {"between": ["block.x", "block.x"]}}}, "two different ends"),
    ({"springs": {"tie": {"stiffness": "1 N/m"}}}, "expected either between or along, found neither"),
    ({"springs": {"tie": {"betwen": ["block.x", "ground"]}}}, "did you mean 'between'?"),
    ({"springs": {"tie": {"between": ["block.x"]}}}, "springs.tie.between"),
    ({"masses": {"block": {"mass": "-2 kg", "moves": ["x"]}}}, "lumped.masses.block.mass: expected above 0 kg"),
    ({"masses": {"block": {"moves": ["x"]}}}, "found 0 kg"),
    ({"sensors": {"block": {"along": {"block.y": 1}}}}, "lumped.sensors.block.along"),
    ({"sensors": {"block": {"along": {"block.x": "2 mm"}}}}, "along.block.x: expected a number"),
    ({"inputs": {"shaker": {"displaces": "tye", "displacement": "1 mm"}}}, "did you mean 'tie'?"),
    ({"inputs": {"motor": {"along": {"block.x": 1}}}}, "lumped.inputs.motor.force: expected a value"),
    ({"inputs": {"motor": {"force": "1 N"}}}, "either along, for a force, or displaces"),
    ({"contacts": {"belt": {"tangent": {"block.x": 1}}}}, "either normal, where it can open, or normal_force"),
    ({"contacts": {"belt": {"tangent": {}, "normal_force": "1 N"}}}, "lumped.contacts.belt.tangent"),
    ({"drive": {"history": {"kind": "harmonic", "frequency": "5 kHz"}}},
     "lumped.histories.interval: expected at most 2e-05 s, 10 samples a period at 5000 Hz, found 0.0001 s"),
    ({"drive": {"history": {"kind": "chirp", "first": "1 Hz", "last": "2 kHz", "sweep": "1 s"}}}, "at most 5e-05 s"),
])
def test_what_does_not_fit_together_is_refused(change, said):
    with pytest.raises(ConfigError) as error:
        lumped.check({"lumped": fill(Settings, {**TIED, **change}, "case.yaml: lumped")})
    assert said in str(error.value)


def test_settings_are_compared_with_those_of_the_transient():
    short = {**TIED, "drive": {"history": {"kind": "step"}}}
    soft = {**TIED, "contacts": {"tip": {"tangent": {"block.x": 1}, "normal": {"block.x": 1}, "stiffness": "1 N/mm"}}}
    for document, motion, said in ((short, {"duration": "2 s"}, "histories.duration"), (soft, {}, "transient.contact")):
        sections = {"lumped": fill(Settings, document, "case"), "transient": Motion.model_validate(motion)}
        with pytest.raises(ConfigError, match=said):
            lumped.check(sections)


@pytest.mark.exact
def test_a_carriage_reaches_its_terminal_speed():
    """Free mass, viscous and Coulomb joint friction on a rail at rest, motor force and offset: v = (F - Fc) / d."""
    carriage = {**BLOCK, "springs": {"viscous": {"between": ["block.x", "ground"], "damping": "40 N s/m"}},
                "contacts": {"rail": {"tangent": {"block.x": 1}, "normal_force": "100 N"}},
                "inputs": {"motor": {"along": {"block.x": 1}, "force": "35 N", "history": {"kind": "step"}},
                           "offset": {"along": {"block.x": 1}, "force": "-3 N"}},
                "sensors": {"block": {"along": {"block.x": 1}}}}
    found = moved(carriage, speeds=["0 rad/s"], friction=0.2, friction_at_rest=0.2)
    speed = (35.0 - 3.0 - 20.0) / 40.0
    np.testing.assert_allclose(found.velocity[0, 0], speed * (1 - np.exp(-40.0 / 2.0 * found.time)), atol=2e-4)
    stuck = moved(carriage, speeds=["0 rad/s"], friction=0.4, friction_at_rest=0.4)
    assert abs(stuck.velocity).max() < 1e-9


@pytest.mark.exact
def test_an_electric_oscillator_needs_no_contact():
    """Charge as displacement: 1 H, 200 ohm, 1 uF; complex modes and transient have its damped frequency."""
    circuit = {"masses": {"charge": {"mass": "1 kg", "moves": ["x"]}},
               "springs": {"circuit": {"between": ["charge.x", "ground"], "stiffness": "1e6 N/m",
                                       "damping": "200 N s/m"}},
               "sensors": {"current": {"along": {"charge.x": 1}, "unit": "A"}}}
    model = reduced_model(built(circuit), settings=Reduction())
    modes = complex_modes(model, None, settings=Modes(friction=0.0, speeds=("0 rad/s",)))
    assert modes.operating_root[0, 0] == pytest.approx(-100 + 1j * np.sqrt(1e6 - 1e4), rel=1e-9)

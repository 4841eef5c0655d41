"""Angles, torques, weights and coupled masses of lumped systems, against closed forms."""

import numpy as np
import pytest

from pipeline.case_models import corrections
from pipeline.case_models.lumped.connections import is_angle, sees_angle, weights
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.sliding.model import sliding_model
from stages.lumped import Settings, lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model

ARM = {"masses": {"arm": {"moves": ["rotation"], "inertia": "0.02 kg m^2"}},
       "springs": {"bar": {"between": ["arm.rotation", "ground"], "torsional_stiffness": "8 N m/rad",
                           "torsional_damping": "0.01 N m s/rad"}},
       "inputs": {"motor": {"along": {"arm.rotation": 1}, "torque": "3 N m"}},
       "sensors": {"angle": {"along": {"arm.rotation": 1}, "quantity": "displacement", "unit": "rad"}}}


def model(document):
    return sliding_model(reduced_model(lumped(settings=fill(Settings, document, "case.yaml: lumped")),
                                       settings=Reduction()), 0, 0.0)


def frequencies(document):
    """Natural frequencies (n,) in rad/s."""
    mass, _, stiffness = model(document).supported()
    return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))


def refused(change):
    with pytest.raises(ConfigError) as error:
        model({**ARM, **change})
    return str(error.value)


@pytest.mark.exact
def test_a_torsional_oscillator_in_its_own_units():
    """w = sqrt(k / J), static angle T / k."""
    found = model(ARM)
    np.testing.assert_allclose(frequencies(ARM), np.sqrt(8 / 0.02), rtol=1e-12)
    _, _, stiffness = found.supported()
    np.testing.assert_allclose(np.linalg.solve(stiffness, found.input_rows[0] * 3.0), 3 / 8)
    assert found.turning == {"joints.bar", "inputs.motor", "masses.arm"}


@pytest.mark.exact
@pytest.mark.parametrize("lever", [0.3, 1.7])
def test_a_pendulum_swings_at_the_root_of_gravity_over_length(lever):
    """w = sqrt(g / l) of a point mass, whatever it weighs; upright it falls at that rate."""
    arm = {"masses": {"arm": {"moves": ["rotation"], "inertia": f"{2.5 * lever**2} kg m^2"}},
           "pendulums": {"weight": {"swings": {"arm.rotation": 1}, "mass": "2.5 kg", "length": f"{lever} m"}}}
    np.testing.assert_allclose(frequencies(arm), np.sqrt(9.80665 / lever), rtol=1e-12)
    arm["pendulums"]["weight"]["length"] = f"{-lever} m"
    assert model(arm).supported()[2] == pytest.approx(-2.5 * 9.80665 * lever)


@pytest.mark.exact
def test_a_mass_off_the_axis_couples_slide_and_rotation():
    """Cart M with a pendulum of point mass m, length l, and no spring: w^2 = g (M + m) / (M l), and a free motion."""
    cart, bob, lever = 3.0, 1.2, 0.4
    document = {"masses": {"cart": {"moves": ["x"], "mass": f"{cart} kg"},
                           "arm": {"moves": ["rotation"], "inertia": "1e-12 kg m^2"}},
                "inertias": {"bob": {"along": {"cart.x": 1, "arm.rotation": f"{lever} m"}, "mass": f"{bob} kg"}},
                "pendulums": {"bob": {"swings": {"arm.rotation": 1}, "mass": f"{bob} kg", "length": f"{lever} m"}}}
    found = frequencies(document)
    assert abs(found[0]) < 1e-5
    assert found[1] == pytest.approx(np.sqrt(9.80665 * (cart + bob) / (cart * lever)), rel=1e-9)


def test_numbers_are_told_in_the_units_of_angles():
    units = corrections.known(bench())
    assert {units[n] for n in ("joints.bar.stiffness", "joints.bar.damping", "masses.arm", "inputs.motor.offset")} == {
        "N m/rad", "N m s/rad", "kg m^2", "N m"}
    assert corrections.read(bench(), {"joints.bar.stiffness": "9 N m/rad"}, "bench")["joints.bar.stiffness"] == 9.0
    with pytest.raises(ConfigError, match="a quantity in N m/rad"):
        corrections.read(bench(), {"joints.bar.stiffness": "9 N/m"}, "bench")


def bench():
    """A Bench of ARM without sensors."""
    from pipeline.physics.virtual_rig.response import Bench

    return Bench(model(ARM), None, None, 1e-3, ())


def test_what_is_an_angle():
    assert is_angle({"arm.rotation": 1, "lid.tilt_x": -1.0}) and not is_angle({"arm.rotation": "1 m"})
    assert not is_angle({"arm.rotation": 1, "cart.x": 1}) and not is_angle({})
    assert sees_angle({"arm.rotation": 2}) and sees_angle({"arm.rotation": "1 m"})
    assert not sees_angle({"arm.rotation": "30 mm"}) and not sees_angle({"cart.x": 1})
    assert weights({"arm.rotation": "30 mm", "cart.x": 2}, "here") == {"arm.rotation": 0.03, "cart.x": 2.0}
    with pytest.raises(ConfigError, match="here.arm.rotation: expected a quantity in m"):
        weights({"arm.rotation": 1}, "here", angles=False)


@pytest.mark.parametrize(("change", "said"), [
    ({"springs": {"bar": {"along": {"arm.rotation": "1 m"}, "torsional_stiffness": "8 N m/rad"}}},
     "springs.bar: expected rotations alone with numbers as weights"),
    ({"springs": {"bar": {"along": {"arm.rotation": 1}, "stiffness": "8 N/m"}}},
     "springs.bar: expected values of torques and angles"),
    ({"springs": {"bar": {"between": ["arm.rotation", "ground"], "stiffness": "8 N/m",
                          "torsional_damping": "1 N m s/rad"}}}, "springs.bar: expected torsional_stiffness and"),
    ({"inputs": {"motor": {"along": {"arm.rotation": 1}, "force": "3 N"}}}, "inputs.motor: expected values of torques"),
    ({"inputs": {"motor": {"along": {"arm.rotation": 1}}}}, "inputs.motor.force: expected a value, or torque"),
    ({"inputs": {"motor": {"displaces": "bar", "displacement": "3 mm"}}}, "inputs.motor: expected an angle of a"),
    ({"inertias": {"bob": {"along": {"arm.rotation": 1}}}}, "inertias.bob: expected either mass, or inertia"),
    ({"inertias": {"bob": {"along": {"arm.rotation": 1}, "mass": "1 kg"}}}, "inertias.bob: expected values of torques"),
    ({"pendulums": {"bar": {"swings": {"arm.rotation": 1}, "mass": "1 kg", "length": "1 m"}}},
     "pendulums.bar: expected a name that no spring has")])
def test_what_does_not_fit_is_refused(change, said):
    assert said in refused(change)

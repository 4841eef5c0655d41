"""Stage complex_modes with the block of effects, against closed forms."""

from dataclasses import fields

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from stages.complex_modes import Settings, complex_modes
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis.small_rig import LUMPED, effects
from tests.diagnosis.small_rig import model as mounted
from tests.stages.small_oscillator import DAMPING, MASS, NORMAL_FORCE, STIFFNESS, small_oscillator
from tests.stages.small_structure import small_friction_map, small_structure

#: block on a tie and on a yielding belt, pressed by 20 N on 10 cm^2
PRESSED = {"masses": {"block": {"mass": "2 kg", "moves": ["x", "y"]}},
           "springs": {"tie": {"between": ["block.x", "ground"], "stiffness": "0.5 kN/m"},
                       "mixed": {"along": {"block.x": 0.6, "block.y": -0.8}, "stiffness": "0.3 kN/m"}},
           "contacts": {"belt": {"tangent": {"block.x": 1}, "normal": {"block.y": 1}, "stiffness": "10 kN/m",
                                 "area": "10 cm^2"}},
           "inputs": {"press": {"along": {"block.y": -1}, "force": "20 N"}},
           "sensors": {"along": {"along": {"block.x": 1}}}}


def modes(model, block, **settings):
    chosen = {"speeds": ("1 rad/s",), "friction": 0.0, "friction_steps": 2, "damping_speed": "1e12 m/s", **settings}
    return complex_modes(model, None, effects(block), settings=Settings(**chosen))


def pressed():
    return reduced_model(lumped(settings=fill(LumpedSettings, PRESSED, "lumped")), settings=ReductionSettings())


def upper(roots):
    """Of roots those above the real axis, by frequency."""
    return np.sort_complex(roots[roots.imag > 0] * -1j) * 1j


@pytest.mark.exact
def test_friction_that_falls_feeds_the_oscillator():
    """m s^2 + (d - N r mu / v_s exp(-v / v_s)) s + k = 0, to the interpolation of the table."""
    found = modes(small_oscillator(on_belt=True), {"falling_friction": {"contact": {"rise": 0.5, "decay_speed":
                                                                                   "0.8 m/s"}}}, friction=0.4)
    drag = DAMPING - NORMAL_FORCE * 0.4 * 0.5 / 0.8 * np.exp(-1 / 0.8)
    assert found.operating_root[0, 0].real == pytest.approx(-drag / MASS / 2, abs=0.01 * abs(DAMPING - drag) / MASS)
    assert abs(found.operating_root[0, 0]) == pytest.approx(np.sqrt(STIFFNESS / MASS))
    assert found.operating_friction[0] == pytest.approx(0.4 * (1 + 0.5 * np.exp(-1 / 0.8)), rel=1e-4)


@pytest.mark.exact
@pytest.mark.parametrize("friction", [0.2, 0.9])
def test_flutter_of_two_modes_with_a_friction_slope(friction):
    """s^2 M + s N mu' t t^T + K + mu k t n^T: mode coupling, and what friction that rises with speed adds."""
    slope, normal, speed = 0.3, 20.0, 1.0
    found = modes(pressed(), {"viscous": {"contact": {"slope": f"{slope} s/m"}}}, friction=friction)
    mu = friction * (1 + slope * speed)
    mixed = np.array([0.6, -0.8])
    stiffness = np.diag([500.0, 1e4]) + 300 * np.outer(mixed, mixed)
    # friction tilts the block: what presses the contact in sliding
    x, y = np.linalg.solve(stiffness + 1e4 * np.array([[0, mu], [0, 0]]), [0.0, -normal])
    load = -1e4 * y
    stiffness[0, 1] += mu * 1e4
    exact = quadratic_roots(2 * np.eye(2), np.diag([load * friction * slope, 0.0]), stiffness)
    np.testing.assert_allclose(upper(found.operating_root[0]), upper(exact), rtol=1e-9)


@pytest.mark.exact
def test_a_pad_that_relaxes_has_the_poles_of_a_maxwell_branch():
    """(m s^2 + d s + k) (1 + s tau) + share k s tau = 0; the real pole is no mode."""
    m, d, k, share, tau = 1.0, 1.2, 400.0, 0.4, 0.03
    found = modes(mounted(), {"viscoelastic_pad": {"mount": {"share": share, "time": f"{tau} s"}}})
    exact = upper(np.roots([m * tau, m + d * tau, d + k * tau * (1 + share), k]))
    np.testing.assert_allclose(found.operating_root[0], exact, rtol=1e-9)
    np.testing.assert_allclose(found.root[0], [exact, exact], rtol=1e-9)


@pytest.mark.exact
def test_a_shim_has_its_loss_factor():
    """s^2 + k (1 + i h) = 0 near the frequency of the shim."""
    mount = {"between": ["block.x", "ground"], "stiffness": "400 N/m"}
    free = reduced_model(lumped(settings=fill(LumpedSettings, {**LUMPED, "springs": {"mount": mount}}, "lumped")),
                         settings=ReductionSettings())
    found = modes(free, {"shim_damping": {"mount": {"loss_factor": 0.02, "frequency": f"{20 / 2 / np.pi} Hz"}}})
    assert found.operating_root[0, 0].real == pytest.approx(-0.02 * 20 / 2, rel=0.02)
    assert found.operating_root[0, 0].imag == pytest.approx(20.0, rel=1e-3)


@pytest.mark.exact
def test_structure_of_effects_is_that_of_the_matrices():
    """A mass carried along, and a base of its own mass and spring behind the mount."""
    carried = modes(mounted(), {"attached_mass": {"block": {"mass": "0.3 kg"}}}).operating_root[0, 0]
    assert carried == pytest.approx(upper(np.roots([1.3, 1.2, 400.0]))[0])
    k, f = 900.0, 3.0
    base = k / (2 * np.pi * f) ** 2
    found = modes(mounted(), {"moving_base": {"mount": {"compliance": f"{1 / k!r} m/N", "frequency": f"{f} Hz"}}})
    exact = quadratic_roots(np.diag([1.0, base]), 1.2 * np.array([[1, -1], [-1, 1.0]]),
                            np.array([[400.0, -400], [-400, 400 + k]]))
    np.testing.assert_allclose(np.sort_complex(found.operating_root[0]), np.sort_complex(exact[exact.imag > 0]))
    squared = eigh(np.array([[400.0, -400], [-400, 400 + k]]), np.diag([1.0, base]), eigvals_only=True)
    np.testing.assert_allclose(found.real_frequency[0], np.sqrt(squared) / 2 / np.pi)


@pytest.mark.exact
def test_laws_of_the_contact():
    """(1 + a) k at the reference pressure, which it does not move; the loss of a damped contact is N s."""
    def across(block):
        found = modes(reduced_model(lumped(settings=fill(LumpedSettings, {**PRESSED, "springs": {
            "tie": PRESSED["springs"]["tie"]}}, "lumped")), settings=ReductionSettings()), block)
        return found.operating_root[0, 1]

    assert across({}) == pytest.approx(1j * np.sqrt(1e4 / 2))
    stiffer = across({"contact_stiffness_law": {"contact": {"exponent": 0.5, "pressure": "20 kPa"}}})
    assert abs(stiffer) == pytest.approx(np.sqrt(1.5e4 / 2), rel=0.01)
    damped = across({"contact_damping": {"contact": {"loss": "0.4 s/m", "length": "1 mm"}}})
    assert damped.real == pytest.approx(-20 * 0.4 / 2 / 2)


def test_the_friction_sweep_has_effects_on_top_of_each_coefficient():
    """Friction of 0.2 halved by fog is friction of 0.1."""
    damp = {"moisture": {"contact": {"slope": -1.0}}, "conditions": {"humidity": 1.0}}
    foggy = modes(pressed(), damp, friction_max=0.2)
    np.testing.assert_allclose(foggy.root, modes(pressed(), {}, friction_max=0.1).root, rtol=1e-9)


@pytest.fixture(scope="module")
def brake():
    return reduced_model(small_structure(), settings=ReductionSettings(fixed_below="20 kHz"))


def braking(model, block):
    settings = Settings(friction_steps=2, speeds=("8 rad/s",), frequency_max="8 kHz")
    return complex_modes(model, small_friction_map(), effects(block), settings=settings)


def test_the_disc_brake_takes_effects_too(brake):
    """At a null bit for bit as without; a mistuned disc parts its doublet, one pad may fall in friction alone."""
    plain, split = "doublet_split", {"along": 0.05, "across": 0.0}
    without = braking(brake, {})
    null = braking(brake, {plain: {"disc 1": dict.fromkeys(split, 0.0)}})
    assert all(np.array_equal(getattr(null, f.name), getattr(without, f.name)) for f in fields(null))
    for block in ({plain: {"disc 1": split}},
                  {"falling_friction": {"pad_outer": {"rise": 0.3, "decay_speed": "0.5 m/s"}}},
                  {"contact_stiffness_law": {"pad_inner": {"exponent": 0.3, "pressure": "1 MPa"}}},
                  {"viscoelastic_pad": {str(brake.joint_name[-1]): {"share": 0.3, "time": "0.1 ms"}}}):
        found = braking(brake, block)
        assert found.operating_root.shape == without.operating_root.shape
        assert abs(found.operating_root - without.operating_root).max() > 1.0


def test_friction_that_remembers_its_load_needs_a_contact_that_yields():
    hard = {**PRESSED, "contacts": {"belt": {"tangent": {"block.x": 1}, "normal": {"block.y": 1}}}}
    model = reduced_model(lumped(settings=fill(LumpedSettings, hard, "lumped")), settings=ReductionSettings())
    with pytest.raises(ConfigError, match="contacts that yield"):
        modes(model, {"contact_memory": {"contact": {"length": "1 mm"}}}, friction=0.3)

"""Values of a brake that may be off, with priors that may hang together."""

import numpy as np
import pytest

from pipeline.case_models.bodies.brake_bodies import Disc
from pipeline.case_models.bodies.brake_joints import Joints
from pipeline.case_models.bodies.declared_values import Value, declared, known_values, named, refuse_unknown
from pipeline.contract import ConfigError

SECTIONS = {"disc": Disc(), "joints": Joints()}
KNOWN = known_values(SECTIONS)


def of(**values):
    return {name.replace("__", "."): Value(**given) for name, given in values.items()}


def test_bodies_have_sizes_and_materials_and_joints_have_stiffnesses():
    assert KNOWN["disc.young"] == (120e9, "Pa") and KNOWN["joints.finger_stiffness"] == (400e6, "N/m")
    assert not {"disc.damping_ratio", "joints.loss_time", "joints.clamping_radius", "disc.web_cells"} & set(KNOWN)


def test_values_are_laid_over_the_sections():
    values = declared(of(disc__young={"spread": 0.1}, joints__finger_stiffness={"spread": 0.5}), KNOWN, "update")
    latent = np.array([1.0, -2.0])
    np.testing.assert_allclose(values.values(latent), [120e9 * np.exp(0.1), 400e6 * np.exp(-1.0)])
    laid = values.laid_over(SECTIONS, values.values(latent))
    assert laid["disc"].young == pytest.approx(120e9 * np.exp(0.1))
    assert laid["joints"].finger_stiffness == pytest.approx(400e6 * np.exp(-1))
    assert laid["disc"].density == 7200 and SECTIONS["disc"].young == 120e9


def test_correlations_make_the_prior_and_come_back_from_a_covariance():
    """Without data the posterior is the prior: spreads and correlation as stated."""
    values = declared(of(disc__young={"spread": 0.1}, disc__density={"spread": 0.02, "correlation": {"young": 0.9}}),
                      KNOWN, "update")
    spread, correlation = values.spread_of(np.eye(2))
    np.testing.assert_allclose(spread, [0.1, 0.02])
    np.testing.assert_allclose(correlation, [[1, 0.9], [0.9, 1]], atol=1e-12)
    draws = np.log(np.array([values.values(u) / values.stated for u in
                             np.random.default_rng(1).standard_normal((4000, 2))]))
    assert np.corrcoef(draws.T)[0, 1] == pytest.approx(0.9, abs=0.01)


def test_a_name_without_a_section_is_one_of_the_part():
    values = named(of(young={"spread": 0.1}, joints__finger_stiffness={"spread": 0.3}), "disc")
    assert list(values) == ["disc.young", "joints.finger_stiffness"]
    assert list(named(of(young={"spread": 0.1}))) == ["young"]


@pytest.mark.parametrize(("values", "message"), [
    (of(joints__fingers={"spread": 0.1}), r"joints.abutment_stiffness, .* found joints.fingers"),
    (of(young={"spread": 0.1}), "disc.ring_inner_radius, .* found young"),
    (of(disc__young={"spread": 0.1, "correlation": {"dnesity": 0.1}}), "found disc.dnesity"),
    (of(disc__young={"spread": 0.1, "correlation": {"density": 1.1}}), "sizes from -1 to 1, found 1.1")])
def test_unknown_names_and_impossible_correlations_are_refused(values, message):
    with pytest.raises(ConfigError, match=message):
        refuse_unknown(values, KNOWN, "update")


def test_correlations_that_contradict_are_refused():
    values = of(disc__young={"spread": 0.1, "correlation": {"density": 0.9, "web_thickness": 0.9}},
                disc__density={"spread": 0.1, "correlation": {"web_thickness": -0.9}},
                disc__web_thickness={"spread": 0.1})
    with pytest.raises(ConfigError, match="correlations that can hold together"):
        declared(values, KNOWN, "update")

"""Sources of scatter: what is refused, how they are drawn, what they change."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.case_models.scatter import (
    DEFAULT,
    FrictionErrors,
    Source,
    check_sources,
    draw_values,
    factors_of,
    family,
    fitting,
    friction_errors,
    standard_deviation,
)
from pipeline.contract import ConfigError
from tests.stages.small_brake import small_brake, small_map, stiffening_brake


def sources(*given):
    return tuple(Source.model_validate(each) for each in given)


@pytest.mark.parametrize(("given", "message"), [
    ([{"kind": "damping_speed"}], "either variation or range"),
    ([{"kind": "damping_speed", "variation": 0.1, "range": (0.5, 2)}], "either variation or range"),
    ([{"kind": "damping_speed", "range": (2, 0.5)}], "rising"),
    ([{"kind": "damping_speed", "variation": 0.1, "distribution": "uniform"}], "uniform"),
    ([{"kind": "friction", "range": (0.5, 2)}], "variation, or nothing"),
    ([{"kind": "lining_stiffness", "part": "pad", "variation": 0.1}], "none for lining_stiffness"),
    ([{"kind": "friction"}, {"kind": "friction"}], "each source once")])
def test_contradictions_are_refused(given, message):
    with pytest.raises(ConfigError, match=message):
        check_sources(sources(*given), "probability.sources")


def test_defaults_are_consistent():
    check_sources(sources(*DEFAULT), "probability.sources")


@pytest.mark.exact
def test_the_standard_deviation_is_that_of_the_draws():
    """Of the logarithm of lognormal factors, of uniform ones, and of what is added to friction."""
    given = sources({"kind": "damping_speed", "range": (0.5, 2)}, {"kind": "joint_loss", "variation": 0.5},
                    {"kind": "contact_stiffness", "range": (0.7, 1.3), "distribution": "uniform"},
                    {"kind": "friction", "variation": 0.02}, {"kind": "friction_over_speed"})
    errors = FrictionErrors({"friction_over_speed": 0.01})
    drawn = draw_values(given, errors, 100_000, np.random.default_rng(3))
    drawn[:, :2] = np.log(drawn[:, :2])
    np.testing.assert_allclose([standard_deviation(s, errors) for s in given], drawn.std(axis=0), rtol=0.01)


@pytest.mark.parametrize("kind", ["joint_stiffness", "joint_loss", "body_loss"])
def test_unknown_parts_are_refused_with_what_exists(kind):
    with pytest.raises(ConfigError, match="caliper" if kind == "body_loss" else "finger_0"):
        factors_of(sources({"kind": kind, "part": "fingre", "variation": 0.1}), [1.0], small_brake())


def test_values_reach_the_joints_and_bodies_that_they_name():
    model = small_brake()
    drawn = factors_of(sources({"kind": "joint_stiffness", "part": "finger", "variation": 0.3},
                               {"kind": "joint_stiffness", "variation": 0.1},
                               {"kind": "body_loss", "part": "pad", "variation": 0.3},
                               {"kind": "damping_speed", "variation": 0.3}, {"kind": "friction_over_speed"}),
                       [2.0, 3.0, 4.0, 5.0, 6.0], model)
    fingers = np.array(["finger" in str(name) for name in model.joint_name])
    np.testing.assert_array_equal(drawn.joint_stiffness, np.where(fingers, 6.0, 3.0))
    np.testing.assert_array_equal(drawn.body_loss, [1.0, 4.0, 4.0, 1.0])
    assert drawn.damping_speed == 5.0 and drawn.speed_slope == 6.0 and drawn.friction == 0.0


@pytest.mark.exact
def test_draws_have_the_stated_distributions():
    given = sources({"kind": "lining_stiffness", "variation": 0.3}, {"kind": "damping_speed", "range": (0.25, 4)},
                    {"kind": "contact_stiffness", "range": (0.5, 2), "distribution": "uniform"},
                    {"kind": "friction"}, {"kind": "friction_over_speed", "variation": 0.2})
    values = draw_values(given, FrictionErrors({"friction": 0.03}), 4000, np.random.default_rng(1))
    width = np.sqrt(np.log(1 + 0.3**2))
    laws = [scipy.stats.lognorm(width), scipy.stats.lognorm(np.log(4) / 1.96), scipy.stats.uniform(0.5, 1.5),
            scipy.stats.norm(0, 0.03), scipy.stats.norm(0, 0.2)]
    for column, law in zip(values.T, laws, strict=True):
        assert scipy.stats.kstest(column, law.cdf).pvalue > 1e-3
    assert values[:, 0].std() / values[:, 0].mean() == pytest.approx(0.3, abs=0.02)


def test_friction_scatters_by_the_standard_errors_of_the_map():
    found = friction_errors(small_map(), 5e-3)
    assert found.std == {"friction": 0.0, "friction_over_pressure": 0.01, "friction_over_speed": 0.01}
    np.testing.assert_array_equal(found.correlation, np.eye(3))


@pytest.mark.exact
def test_errors_of_the_map_go_together_as_it_says_and_stated_ones_alone():
    """Of two pairs level and slope differ by one pattern alone: a correlation of rank one."""
    together = FrictionErrors({"friction": 0.03, "friction_over_pressure": 0.01, "friction_over_speed": 0.002},
                              np.array([[1.0, -1.0, 0.6], [-1.0, 1.0, -0.6], [0.6, -0.6, 1.0]]))
    given = sources({"kind": "friction"}, {"kind": "lining_stiffness", "variation": 0.3},
                    {"kind": "friction_over_pressure"}, {"kind": "friction_over_speed"})
    values = draw_values(given, together, 4000, np.random.default_rng(1))
    np.testing.assert_allclose(values[:, 2], -values[:, 0] / 3, atol=1e-9)
    assert np.corrcoef(values[:, 0], values[:, 3])[0, 1] == pytest.approx(0.6, abs=0.04)
    assert abs(np.corrcoef(values[:, 0], values[:, 1])[0, 1]) < 0.05
    np.testing.assert_allclose(values[:, [0, 2, 3]].std(axis=0), list(together.std.values()), rtol=0.05)
    stated = sources({"kind": "friction", "variation": 0.2}, {"kind": "friction_over_pressure"})
    values = draw_values(stated, together, 4000, np.random.default_rng(1))
    assert abs(np.corrcoef(values.T)[0, 1]) < 0.05


def test_without_a_friction_map_friction_is_that_of_the_settings_and_its_scatter_must_be_stated():
    assert friction_errors(None, 0.01).std == {}
    with pytest.raises(ConfigError, match="friction.variation"):
        draw_values(sources({"kind": "friction"}), FrictionErrors(), 3, np.random.default_rng(1))
    settings = SimpleNamespace(
        speeds=[8.0], sliding_distance=0.01, damping_speed=1.0, friction=0.4, friction_at_rest=0.6, decay_speed=0.5,
        friction_slopes=True, friction_damping=True, gyroscopic=True, centrifugal=True)
    speed = np.array([0.5, 1.5])
    state = family(small_brake(), 0, None, settings).friction(np.full(2, 1e6), speed)
    np.testing.assert_allclose(state.coefficient, 0.4 + 0.2 * np.exp(-speed / 0.5))
    np.testing.assert_allclose(state.speed_slope, -0.4 * np.exp(-speed / 0.5))
    settings.friction_at_rest = None
    np.testing.assert_allclose(family(small_brake(), 0, None, settings).friction(np.ones(2), speed).coefficient, 0.4)


def test_linings_of_a_state_scatter_about_what_its_pressure_makes_them():
    settings = SimpleNamespace(
        speeds=[8.0], sliding_distance=0.01, damping_speed=1.0, friction=0.4, friction_at_rest=None, decay_speed=0.5,
        friction_slopes=True, friction_damping=True, gyroscopic=True, centrifugal=True)
    made, plain = (family(each, 1, None, settings) for each in
                   (stiffening_brake(1.0), replace(stiffening_brake(np.sqrt(3.0)), lining_exponent=0.0)))
    for name in ("lining", "loss"):
        np.testing.assert_allclose(getattr(made, name), getattr(plain, name), rtol=1e-14)
    np.testing.assert_allclose(made.model.stiffness, plain.model.stiffness, rtol=1e-14)


def test_sources_of_the_program_fit_the_brake():
    """Bolts of a fixed caliper stand for guide pins, absent fingers are left out; what a case states stays."""
    def with_joints(*names):
        return SimpleNamespace(joint_name=[f"{name}_leading_axial" for name in names])

    def parts(found):
        return [source.part for source in found if source.kind == "joint_stiffness"]

    default = sources(*DEFAULT)
    assert fitting(default, with_joints("abutment", "finger", "piston", "guide_pin")) == default
    assert parts(fitting(default, with_joints("abutment", "piston", "bolt", "mount"))) == ["abutment", "piston", "bolt"]
    assert parts(fitting(default, with_joints("abutment", "piston", "mount"))) == ["abutment", "piston"]
    assert fitting(default, with_joints("spring")) == default
    assert fitting(default[:2], with_joints("piston")) == default[:2]

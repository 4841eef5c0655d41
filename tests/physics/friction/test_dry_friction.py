"""Characteristics and descriptions of dry friction against closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.cattaneo_mindlin import tangential_load
from pipeline.physics.friction.dry_friction import (
    READ_AT,
    Friction,
    at_one_distance,
    characteristic,
    coefficient,
    constant,
    elastic_stick,
    evolution_curve,
    evolution_rule,
    falling,
    kernel,
    tabulated,
)
from pipeline.physics.friction.friction_table import FrictionLaw


@pytest.mark.exact
def test_falling_characteristic():
    friction, speed = falling(0.5, 0.2, 0.03), np.linspace(-0.3, 0.3, 1001)
    exact = 0.2 + 0.3 * np.exp(-abs(speed) / 0.03)
    np.testing.assert_allclose(friction.at_speed(speed), exact, atol=2e-5 * 0.3)
    compiled = [coefficient(kernel(friction, 1), 0, 0.0, v, v) for v in speed]
    np.testing.assert_allclose(compiled, friction.at_speed(speed), rtol=1e-14)


def test_one_coefficient_at_all_states():
    assert coefficient(kernel(constant(0.4), 1), 0, 3e6, -7.0, -1.0) == 0.4


@pytest.mark.parametrize("distance", [-1.0, 0.0, 0.3, 1.0, 1.7, 2.0, 9.0])
def test_tables_at_one_distance_hold_what_all_of_them_hold_there(distance):
    """Within, at and beyond the ends of the axis."""
    axes, rng = ([1e6, 2e6, 4e6], [0.0, 1.0], [0.0, 1.0, 2.0]), np.random.default_rng(3)
    whole = kernel(Friction(FrictionLaw(*axes, rng.random((3, 2, 3))), distance=distance), 2)
    short = at_one_distance(whole)
    assert short.table.shape == (3, 2, 1)
    for pressure, speed in ((0.5e6, 0.3), (1.2e6, 0.3), (3e6, 2.0)):
        expected, seen = (characteristic.py_func(each, 1, pressure, speed, each.contact[1, READ_AT], speed)[:3]
                          for each in (whole, short))
        np.testing.assert_allclose(seen, expected, rtol=1e-14)


def test_tables_stay_whole_where_contacts_read_them_at_different_distances():
    whole = kernel(Friction(FrictionLaw([1e6], [0.0], [0.0, 1.0], [[[0.3, 0.4]]]), distance=0.5), 2)
    whole.contact[1, READ_AT] = 0.7
    assert at_one_distance(whole) is whole


@pytest.mark.exact
def test_friction_that_does_not_fall_is_one_value():
    """Tables of effects over pressure and distance multiply its size."""
    friction = falling(0.4, 0.4, 0.01, static_factor=1.2)
    assert friction.law.friction.size == 1 and friction.at_speed([0.0, 0.3]).tolist() == [0.4, 0.4]
    assert friction.static_factor == 1.2


@pytest.mark.exact
@pytest.mark.parametrize("exponent", [1.0, 2.0, 3.5])
def test_evolution_rule_solves_its_equation(exponent):
    """From a force on the other side of zero, far into sliding and back, against DOP853."""
    limit, stiffness, force, reference = 3.0, 2e6, -1.0, -1.0
    for slip in (1e-6, 8e-6, -5e-6, 2e-7):
        sign = np.sign(slip)
        force, slope = evolution_rule(force, slip, limit, stiffness, exponent)
        reference = solve_ivp(lambda s, t, sign=sign: sign * stiffness * (1 - sign * t / limit) ** exponent,
                              (0, abs(slip)), [reference], "DOP853", rtol=1e-12, atol=1e-12).y[0, -1]
        assert force == pytest.approx(reference, rel=1e-9)
        assert slope == pytest.approx(stiffness * (1 - sign * force / limit) ** exponent, rel=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("exponent", [0.7, 1.0, 2.0])
def test_the_curve_from_rest_solves_the_equation_of_the_evolution_rule(exponent):
    slip = np.linspace(0, 1e-6, 20001)
    force = evolution_curve(slip, 1e5, 1e12, exponent)
    expected = 1e12 * np.maximum(1 - force[1:-1] / 1e5, 0) ** exponent
    assert np.gradient(force, slip)[1:-1] == pytest.approx(expected, abs=2e-3 * 1e12)


@pytest.mark.exact
def test_one_hertz_contact_slips_by_the_evolution_rule_of_one_third():
    sliding, limit = 2e-6, 5.0
    for share in (0.1, 0.5, 0.9, 1.0, 1.5):
        found = evolution_rule(0.0, share * sliding, limit, 1.5 * limit / sliding, 1 / 3)[0]
        assert found == pytest.approx(tangential_load(min(share, 1) * sliding, sliding, limit), rel=1e-12)


def test_the_limit_is_never_exceeded():
    assert elastic_stick(0.0, 1.0, 2.0, 10.0) == (2.0, 0.0)
    assert elastic_stick(1.0, -0.05, 2.0, 10.0) == (0.5, 10.0)
    assert evolution_rule(5.0, 1e-9, 2.0, 1e6, 1.0)[0] == 2.0
    assert evolution_rule(5.0, 1.0, 0.0, 1e6, 1.0) == (0.0, 0.0)


@pytest.mark.parametrize("build, said", [
    (lambda: constant(-0.1), "coefficient"), (lambda: constant(0.1, static_factor=0.9), "static_factor"),
    (lambda: constant(0.1, description="soft"), "description"), (lambda: constant(0.1, description="elastic"), "stiff"),
    (lambda: tabulated([0.0, 0.0], [0.1, 0.2]), "rising"), (lambda: falling(0.3, 0.2, 0.0), "decay_speed"),
    (lambda: constant(0.1, exponent=0.0), "exponent")])
def test_bad_friction_is_refused(build, said):
    with pytest.raises(ConfigError, match=said):
        build()

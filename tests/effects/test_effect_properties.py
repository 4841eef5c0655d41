"""Properties of laws of joints over values and motions: odd, dissipative, elastic, nothing at the null.

Each is what the equation of its module says. The force of a law is what it adds to the equation of motion of one mass.
"""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.effects import CATALOGUE, named
from pipeline.effects.effect import null_values
from pipeline.physics.virtual_rig.force_residual import equation_residual
from tests.drawn import FEW
from tests.effects.benches import RATE, let_go, sprung

BENCH, RUN, FREE = sprung(), let_go(0.0, 0.0, 1.0), let_go(3e-3, 0.0, 1.0)
#: F(-q) = -F(q): the law knows no direction
ODD = (
    "coulomb",
    "joint_damping",
    "cubic_stiffness",
    "quadratic_damping",
    "hysteretic_joint",
    "bouc_wen",
    "backlash",
    "attached_mass",
    "added_stiffness",
    "compliant_arm",
    "viscoelastic_pad",
    "shim_damping",
    "logarithmic_friction",
    "rate_state_ageing",
    "rate_state_slip",
    "dahl",
    "jenkins",
    "lugre",
    "series_stiffness",
    "stribeck_joint",
)
#: over a cycle of a periodic motion the law takes energy from the joint
DISSIPATIVE = (
    "coulomb",
    "joint_damping",
    "quadratic_damping",
    "hysteretic_joint",
    "bouc_wen",
    "logarithmic_friction",
    "rate_state_ageing",
    "rate_state_slip",
    "dahl",
    "jenkins",
    "lugre",
    "series_stiffness",
    "stribeck_joint",
    "viscoelastic_pad",
    "shim_damping",
    "position_friction",
)
#: over such a cycle it takes none
ELASTIC = ("cubic_stiffness", "quadratic_stiffness", "attached_mass", "added_stiffness", "backlash")
QUANTILES, AMPLITUDES = st.floats(0.05, 0.95), st.tuples(st.floats(0.2, 1.0), st.floats(-0.5, 0.5), st.floats(0.0, 6.0))
#: cycles in the run; the first ones are left to laws that remember
_BASE, _CYCLES, _LEFT = 5.0, 5, 2
#: energy in J that is none, beside the 2e-3 J that the joint of the bench stores
_ROUNDING = 1e-14


def motion(shape):
    """Displacement (sample,) in m of two harmonics."""
    first, second, phase = shape
    angle = 2 * np.pi * _BASE * RUN.time
    return 3e-3 * (first * np.sin(angle) + second * np.sin(2 * angle + phase))


def force(effect, values, x):
    """What a law of these values adds to the force (sample,) in N on the mass that moves by ``x``."""
    changed = effect.on(BENCH, effect.locations(BENCH)[0], values)
    return (equation_residual(changed, RUN, {"x": x}) - equation_residual(BENCH, RUN, {"x": x}))[0]


@cache
def priors(effect):
    """Parameters of a law at its first location."""
    return effect.at(BENCH, effect.locations(BENCH)[0], (FREE,))


def drawn(effect, quantiles):
    """Values of a law at quantiles of its priors, drawn one by one."""
    parameters = priors(effect)
    return {p.name: float(p.prior.quantile(quantiles.draw(QUANTILES))) for p in parameters}, parameters


def work(effect, values, x):
    """(energy in J that the law takes over whole cycles, the size of what it moves to and fro)."""
    cycle = round(RATE / _BASE)
    part = slice(_LEFT * cycle, _CYCLES * cycle)
    power = force(effect, values, x)[part] * np.gradient(x, RUN.time)[part]
    return power.sum() / RATE, np.abs(power).sum() / RATE


def each(names):
    return pytest.mark.parametrize("name", names)


def test_every_law_of_a_joint_is_odd_or_says_why_not():
    """A new law of a joint joins a list above, or this one."""
    other = {
        "asymmetric_friction",
        "quadratic_stiffness",
        "position_friction",
        "thermal_softening",
        "parametric_stiffness",
        "moving_base",
        "base_shake",
        "viscous",
        "velocity_strengthening",
        "micro_slip",
        "clearance",
        "cogging",
    }
    assert {e.name for e in CATALOGUE if e.location == "joint" and e.locations(BENCH)} <= {*ODD, *other}


@each(ODD)
@FEW
@given(st.data(), AMPLITUDES)
def test_odd_laws_are_odd(name, quantiles, shape):
    values, _ = drawn(named(name), quantiles)
    x = motion(shape)
    forth, back = force(named(name), values, x), force(named(name), values, -x)
    np.testing.assert_allclose(back, -forth, rtol=0, atol=1e-9 * np.abs(forth).max())


@each(DISSIPATIVE)
@FEW
@given(st.data(), AMPLITUDES)
def test_dissipative_laws_take_energy(name, quantiles, shape):
    values, _ = drawn(named(name), quantiles)
    taken, moved = work(named(name), values, motion(shape))
    assert taken >= -5e-3 * moved - _ROUNDING


@each(ELASTIC)
@FEW
@given(st.data(), AMPLITUDES)
def test_elastic_laws_take_none(name, quantiles, shape):
    values, _ = drawn(named(name), quantiles)
    taken, moved = work(named(name), values, motion(shape))
    assert abs(taken) <= 5e-3 * moved + _ROUNDING


@each(ODD)
@FEW
@given(st.data(), AMPLITUDES)
def test_at_the_null_nothing_is_added_whatever_the_other_values_are(name, quantiles, shape):
    """Every parameter that has a null vanishes alone where it is the only one; the rest keep values that were drawn."""
    values, parameters = drawn(named(name), quantiles)
    null = {
        **values,
        **{
            p.name: value
            for p, value in zip(parameters, null_values(parameters).values(), strict=True)
            if p.null is not None
        },
    }
    assert not force(named(name), null, motion(shape)).any()

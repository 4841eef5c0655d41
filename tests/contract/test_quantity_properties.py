"""Properties of quantities and settings: sizes are exact, whatever text is given ends in a number or one sentence."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import stages
from pipeline.contract import units
from pipeline.contract.errors import ConfigError
from pipeline.contract.received.unit_grammar import NoUnitError, checked_unit
from pipeline.contract.settings import fill, leaves, restored, stored
from tests.drawn import FEW, MANY

NUMBERS = st.floats(-1e12, 1e12, allow_subnormal=False)
PREFIXES = {"n": -9, "u": -6, "m": -3, "c": -2, "": 0, "k": 3, "M": 6, "G": 9}
BASES = ("m", "s", "N", "Pa", "W", "J", "Hz", "V", "A")
#: prefixes with which channels have these units
OF_CHANNELS = st.sampled_from([(prefix, unit) for unit, prefixes in (("m", "numck"), ("s", "num"), ("N", "numckM"),
                                                                     ("Pa", "numkMG")) for prefix in ("", *prefixes)])
#: what has the letters of units, and what has any
GRAMMAR = st.text("mskgNPa*/^()-0123456789.² ⁻¹%°µ_e+'\"x\t", max_size=24) | st.text(max_size=12)


@MANY
@given(NUMBERS, st.sampled_from(sorted(PREFIXES)), st.sampled_from(("m", "s", "N", "Pa")))
def test_a_prefix_is_its_power_of_ten(number, prefix, unit):
    assert units.to_si(f"{number!r} {prefix}{unit}", unit, "x") == pytest.approx(
        number * 10.0 ** PREFIXES[prefix], rel=1e-14
    )


@MANY
@given(NUMBERS, OF_CHANNELS, OF_CHANNELS, st.sampled_from(("/", " ", "*")))
def test_products_and_quotients_multiply(number, first, second, joint):
    """As measured values, in a unit that a channel can have: the last factor leaves the first one's."""
    sign, last = (-1, " ") if joint == "/" else (1, "/")
    size = 10.0 ** (PREFIXES[first[0]] + sign * PREFIXES[second[0]])
    value, name = units.in_si(number, f"{''.join(first)}{joint}{''.join(second)}{last}{second[1]}", "x")
    assert value == pytest.approx(number * size, rel=1e-13, abs=1e-300)
    assert name == first[1] and units.in_si(1.0, name, "x")[0] == pytest.approx(1.0)


@MANY
@given(NUMBERS, OF_CHANNELS, OF_CHANNELS)
def test_the_order_of_factors_and_the_way_a_power_is_written_count_for_nothing(number, first, second):
    a, b = "".join(first), "".join(second)
    a, b = f"{a}/{first[1]}", f"{b}/{second[1]}"
    spelt = [f"({a})^2 ({b})^-1 m", f"({a})**2/({b}) m", f"({a})²·({b})⁻¹ m", f"({b})^(-1) * ({a})^(2) * m",
             f"m ({a} {a})/({b})"]
    values = [units.in_si(number, unit, "x")[0] for unit in spelt]
    assert values == pytest.approx(values[:1] * 5, rel=1e-12, abs=1e-300)


@MANY
@given(GRAMMAR)
def test_any_text_is_a_unit_or_refused(text):
    """And what is one is read, or refused, in one sentence; a finite size is positive where the unit is no level."""
    try:
        checked_unit(text)
    except NoUnitError as error:
        assert str(error)
    for reader in (lambda: units.in_si(1.0, text, "x")[0], lambda: units.quotient_in_si(1.0, text, "x")[0]):
        try:
            assert not math.isnan(reader())
        except ConfigError as error:
            assert error.expected and len(str(error)) <= 2000


@MANY
@given(
    GRAMMAR | st.tuples(NUMBERS, GRAMMAR).map(lambda pair: f"{pair[0]!r} {pair[1]}"), st.sampled_from(sorted(units.SI))
)
def test_any_text_is_a_finite_quantity_or_refused(text, unit):
    try:
        assert math.isfinite(units.to_si(text, unit, "x"))
    except ConfigError as error:
        assert error.expected and len(str(error)) <= 2000


QUANTITIES = sorted(
    (stage, leaf.key, leaf.unit)
    for stage in stages.NAMES
    for leaf in leaves(stages.load(stage).settings())
    if leaf.unit and isinstance(leaf.value, float) and not any(s.isdigit() for s in leaf.key.split("."))
)


@FEW
@given(st.data())
def test_settings_come_back_from_what_they_are_stored_as(data):
    """A quantity of any stage, in its unit, is held to the bit, and survives storing and restoring."""
    stage, key, unit = data.draw(st.sampled_from(QUANTITIES))
    number = data.draw(NUMBERS.map(abs) | NUMBERS)
    values = f"{number!r} {unit}" if unit != "1" else number
    for step in reversed(key.split(".")):
        values = {step: values}
    try:
        section = fill(stages.load(stage).settings, values, "case.yaml: x")
    except ConfigError as error:
        assert f"x.{key.split('.')[0]}" in str(error) or "x: " in str(error)
        return
    again = restored(type(section), stored(section))
    assert again == section
    assert {k: v for k, v, *_ in leaves(again)}[key] == number

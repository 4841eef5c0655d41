"""The grammar of units: what people write is read, what computes without end is refused at once."""

import time

import pytest

from pipeline.contract import ConfigError, units
from pipeline.contract.received.unit_grammar import NoUnitError, checked_unit


@pytest.mark.parametrize("unit", ["m/s", "N s/m", "m^2/s^2/Hz", "kg^(-0.5)", "1/kg^0.5", "(mm/s)/(N)", "°C", "%", "g_0",
                                  "m^(1/2)", "m**-1", "((m))", "(m^3)^3", "µm", "1"])
def test_units_as_they_are_written(unit):
    assert checked_unit(unit) == unit


def test_superscripts_and_dots():
    assert checked_unit("m/s²") == "m/s^(2)" and checked_unit("s⁻¹") == "s^(-1)" and checked_unit("N·m") == "N*m"


@pytest.mark.parametrize("unit", [
    "", "m/", "*m", "m^0", "N^0", "m⁰", "m^(0/2)",
    "m^10", "m^99", "m⁹⁹", "(m^9)^9", "m**9**9", "9**9**9**9 m/s", "2 m", "m 3", "m^(1/0)", "(m", "m)",
    "m^m", "m(", "1e-3 m", "m" * 121, "(" * 20 + "m" + ")" * 20, "m " * 30, "__import__('os')", "m;s", "3"])
def test_what_is_no_unit(unit):
    with pytest.raises(NoUnitError):
        checked_unit(unit)


@pytest.mark.parametrize("text", ["9**9**9**9 m/s", "2**2**9 m/s", "1 (((km^9)^9)^9)^9 m/s", "3 " + "Gm^3 " * 20 + "/s",
                                  "1e400 m/s", "3 m^9^9/s"])
def test_quantities_that_never_ended_are_refused_in_no_time(in_time, text):
    begin = time.perf_counter()
    with pytest.raises(ConfigError, match="expected a quantity in m/s"):
        units.to_si(text, "m/s", "belt.speed")
    if "**" in text:
        with pytest.raises(ConfigError, match="expected a unit such as mm/s or kN"):
            units.in_si(1.0, text, "channel")
        with pytest.raises(ConfigError):
            units.in_si(1.0, f"dB re 1 {text}", "channel")
        with pytest.raises(ConfigError):
            units.quotient_in_si(1.0, f"{text}/N", "response")
    assert time.perf_counter() - begin < 2.0


def test_a_whole_number_beyond_any_float():
    with pytest.raises(ConfigError, match="a number that is too large"):
        units.to_si(10**400, "1", "factor")


def test_quantities_without_a_number_before_the_unit_alone():
    assert units.to_si("5 /s", "1/s", "x") == 5.0 and units.to_si("3 mm²", "m^2", "x") == pytest.approx(3e-6)

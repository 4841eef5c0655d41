"""Units: coherent SI inside, pint at the edge."""

import numpy as np
import pint
import pytest

from pipeline.contract import ConfigError, units
from pipeline.contract.units import SI, in_si, makes_other_numbers, quotient_in_si, to_si

#: spelt -> unit: what is read without pint
PLAIN = {**{f"{prefix}{unit}": unit for unit in ("m", "s", "rad", "Hz", "N", "Pa", "J", "W", "K", "V", "A")
            for prefix in ("", "G", "M", "k", "c", "m", "u", "n")},
         "g": "kg", "deg": "rad", "rpm": "rad/s", "mm^2": "m^2", "um^2": "m^2", "mm^3": "m^3", "mm^2/N": "m^2/N",
         "N/mm": "N/m", "kN/mm": "N/m", "1/um": "1/m", "km/s": "m/s", "mm/s": "m/s", "N s/mm": "N s/m",
         "um/MPa": "m/Pa",
         "1/GPa": "1/Pa", "MPa/mm": "Pa/m", "N mm": "N m", "mm/s^2": "m/s^2", "kg/m^3": "kg/m^3", "1/ms": "1/s"}


@pytest.fixture(scope="module")
def registry():
    return pint.UnitRegistry()


def test_plain_quantities_are_read_with_the_bits_of_pint(registry, monkeypatch):
    monkeypatch.setattr(units, "_convert", None)        # pint is not asked
    for spelt, unit in PLAIN.items():
        for number in ("1", "3", "12", "0.1", "0.3", "17.25", "210", "1e-3", "7.1e9", "-4"):
            exact = registry.Quantity(f"{number} {spelt}").to(unit).magnitude
            assert to_si(f"{number} {spelt}", unit, "x") == float(exact), f"{number} {spelt}"


@pytest.mark.parametrize("unit", sorted(SI - {"1"}))
def test_every_unit_is_coherent_si(unit, registry):
    quantity = registry.Quantity(1.0, unit.replace("1/kg^0.5", "kg^(-0.5)"))
    assert quantity.to_base_units().magnitude == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize("text, unit, value", [
    ("12 mm", "m", 0.012), ("2 MPa", "Pa", 2e6), ("3.3e-6 mm^2/N", "m^2/N", 3.3e-12), ("40 %", "1", 0.4),
    ("0.3", "1", 0.3), (0.3, "1", 0.3), ("600 rpm", "rad/s", 62.83185307179586),
    ("4 degrees", "rad", 0.06981317007977318), ("2 g", "m/s^2", 19.6133), ("2 g", "kg", 0.002),
    ("5 mg", "m/s^2", 0.04903325), ("50 degC", "K", 323.15), ("-5 °C", "K", 268.15),
    ("5 N*s/m", "N s/m", 5.0), ("1e3 1/s", "1/s", 1000.0),
])
def test_conversion(text, unit, value):
    assert to_si(text, unit, "x") == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("text, unit", [("60 rpm", "Hz"), ("100 rad/s", "Hz"), ("2 Hz", "rad/s"), ("2 kHz", "rad/s")])
def test_turns_and_angles_are_not_mixed(text, unit):
    with pytest.raises(ConfigError, match="expected a quantity in"):
        to_si(text, unit, "x")


@pytest.mark.parametrize("text, unit", [
    ("1,5 mm", "m"), ("0,35", "1"), ("1,000 mm", "m"), ("1 2 mm", "m"), ("5 m 3", "m"), ("1 mm ± 2", "m"),
    ("2 * 3 mm", "m"), ("1 mm + 2 mm", "m")])
def test_a_second_number_or_a_decimal_comma_is_refused(text, unit):
    """pint would read 15 mm, 0, 1 m, 2 mm, 15 m, 2 mm, 6 mm and 3 mm."""
    with pytest.raises(ConfigError, match="write one number, with a decimal point, and its unit"):
        to_si(text, unit, "x")


@pytest.mark.parametrize("text, value", [("2 mm^2", 2e-6), ("2 mm**2", 2e-6), ("2e4 cm^(2)", 2.0), ("3 1/mm^-2", 3e-6)])
def test_numbers_of_the_unit_belong_to_it(text, value):
    assert to_si(text, "m^2", "x") == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("value", ["3 kg", "3", 3, "three mm", "12 mn mm", True, None, [1], "mm"])
def test_refuses_what_is_no_length(value):
    with pytest.raises(ConfigError, match="a.yaml: disc.thickness: expected a quantity in m"):
        to_si(value, "m", "a.yaml: disc.thickness")


@pytest.mark.parametrize("measures, unit, value, name", [
    ("acceleration", "g", 9.80665, "m/s^2"), ("acceleration", "mg", 9.80665e-3, "m/s^2"), ("mass", "g", 1e-3, "kg"),
    ("acceleration", "deg/s^2", np.pi / 180, "rad/s^2"), ("angle", "deg", np.pi / 180, "rad"),
    ("displacement", "deg", np.pi / 180, "rad"), ("speed", "rpm", np.pi / 30, "rad/s"),
    ("velocity", "mm/s", 1e-3, "m/s"), ("torque", "N mm", 1e-3, "N m"), ("", "g", 1e-3, "kg"),
    ("", "deg/s^2", np.pi / 180, "rad/s^2")])
def test_units_of_samples_follow_what_is_measured(measures, unit, value, name):
    values, found = in_si(np.array([1.0, -2.0]), unit, "x", measures)
    assert found == name
    np.testing.assert_allclose(values, [value, -2 * value], rtol=1e-15)


def test_levels_are_effective_values():
    """94 dB re 20 uPa are 1.0024 Pa (ISO 1683); 20 dB more are ten times the pressure."""
    values, name = in_si(np.array([93.9794, 113.9794, 0.0]), "dB re 20 uPa", "x", "sound pressure")
    assert name == "Pa"
    np.testing.assert_allclose(values, [1.0, 10.0, 20e-6], rtol=1e-6)


@pytest.mark.parametrize("measures, unit", [
    ("acceleration", "V"), ("velocity", "g"), ("force", "mm"), ("angle", "mm"), ("speed", "Hz"), ("torque", "N")])
def test_a_unit_that_contradicts_the_quantity_is_one_error(measures, unit):
    with pytest.raises(ConfigError, match=f"x: expected a unit of {measures}, such as .*found '{unit}'.*what the"):
        in_si(np.ones(2), unit, "x", measures)


@pytest.mark.parametrize("written, unit, factor", [
    ("Nm", "N m", 1.0), ("kNm", "N m", 1e3), ("Nmm", "N m", 1e-3), ("m/s2", "m/s^2", 1.0), ("mm/s2", "m/s^2", 1e-3)])
def test_units_are_read_as_people_write_them(written, unit, factor):
    """In files and in settings, alone and as part of a unit; nanometres are none of them."""
    assert in_si(2.0, written, "here") == (pytest.approx(2 * factor), unit)
    assert to_si(f"2 {written}", unit, "here") == pytest.approx(2 * factor)
    assert quotient_in_si(2.0, f"rad/({written})", "here")[0] == pytest.approx(2 / factor)
    assert quotient_in_si(2.0, f"{written}/V", "here")[0] == pytest.approx(2 * factor)
    assert in_si(2.0, "nm", "here")[0] == pytest.approx(2e-9)


@pytest.mark.parametrize("unit, factor, name", [
    ("m/s2/N", 1.0, "m/s^2/N"), ("g_0/N", 9.80665, "m/s^2/N"), ("mm/kN", 1e-6, "m/N"), ("(mm/s)/(N)", 1e-3, "m/s/N"),
    ("m/s^2", 1.0, "m/s^2"), ("(N)/(N m/rad)", 1.0, "rad/m"), ("m/Nm", 1.0, "m/N m"), ("V", 1.0, "V"),
    ("ms^-2/kN", 1e-3, "m/s^2/N"), ("mms-1/N", 1e-3, "m/s/N"), ("N/ms-1", 1.0, "N/m/s"), ("[mm]/N", 1e-3, "m/N")])
def test_parts_of_a_quotient_keep_their_names(unit, factor, name):
    """An accelerance is no inverse mass to its reader."""
    assert quotient_in_si(3.0, unit, "here") == (pytest.approx(3 * factor), name)


@pytest.mark.parametrize("text, unit", [("1e400 degC", "K"), ("1e400 °C", "K"), ("１２ mm", "m"), ("12 m²０", "m^2"),
                                        ("１２degrees", "rad"), ("3 N^0", "N")])
def test_what_is_not_finite_or_of_other_digits_is_refused(text, unit):
    with pytest.raises(ConfigError, match="expected a quantity in"):
        to_si(text, unit, "x")


@pytest.mark.parametrize("one, other, measures, told", [
    ("kN", "N", "force", True), ("m/s2", "m/s^2", "acceleration", False), ("G", "g", "acceleration", False),
    ("degC", "K", "temperature", True), ("kg", "kgf", "force", False), ("EU", "N", "force", False),
    ("mm", "kN", "force", True), ("bar(g)", "bar", "pressure", False)])
def test_units_that_make_other_numbers(one, other, measures, told):
    assert makes_other_numbers(one, other, measures) == told

"""Units of channels as people write them, against what is meant; and what no channel has."""

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.received.channel_units import hint, plain, readings
from pipeline.contract.received.unit_grammar import NoUnitError
from pipeline.contract.units import in_si, measured_in, quotient_in_si, read_as

G, LBF, INCH, TURN = 9.80665, 4.4482216152605, 0.0254, 6.283185307179586

#: SI unit -> {what is written: its size}
WRITTEN = {
    "m/s^2": {"G": G, "g's": G, "gn": G, "g_n": G, "g_0": G, "M/S^2": 1, "m/s2": 1, "m/s/s": 1, "ms-2": 1, "m s-2": 1,
              "m·s⁻²": 1, "m/s²": 1, "m/sec^2": 1, "M/SEC2": 1, "m/s**2": 1, "[m/s²]": 1, "m per s^2": 1, "mm/s2": 1e-3,
              "in/s^2": INCH, "FT/S^2": 12 * INCH, "mÂ²/m s²": 1},
    "Pa": {"PA": 1, "Pascals": 1, "bar(g)": 1e5, "barg": 1e5, "bar (a)": 1e5, "BAR": 1e5, "bar abs": 1e5, "mbar": 100,
           "MPA": 1e6, "KPA": 1e3, "kPa(g)": 1e3, "hPa": 100, "N/mm2": 1e6, "N/mm²": 1e6, "psig": 6894.757293,
           "PSI": 6894.757293, "ksi": 6894757.293, "[bar(g)]": 1e5, "(bar (a))": 1e5,
           "lb/in2": 6894.757293, "kg/cm2": 98066.5, "kgf/cm²(g)": 98066.5, "inHg": 3386.38864,
           "mm H2O": 9.80665, "dB re 20 uPa": 20e-6 * 10 ** 0.05, "dB SPL": 20e-6 * 10 ** 0.05, "mPa": 1e-3},
    "K": {"deg C": 274.15, "°C": 274.15, "℃": 274.15, "DEGC": 274.15, "Deg. C": 274.15, "degrees Celsius": 274.15,
          "Celsius": 274.15, "Â°C": 274.15, "º C": 274.15, "deg F": 255.9277778, "Kelvin": 1},
    "m": {"mils": 25.4e-6, "mil": 25.4e-6, "MM": 1e-3, "M": 1, "Inches": INCH, "in.": INCH, "µm": 1e-6, "μm": 1e-6,
          "um": 1e-6, "UM": 1e-6, "microns": 1e-6, "Millimeters": 1e-3, "uin": 1e-6 * INCH, "mm pk": 1e-3},
    "m/s": {"km/h": 1 / 3.6, "KM/H": 1 / 3.6, "kph": 1 / 3.6, "kmh": 1 / 3.6, "mph": 0.44704, "IPS": INCH, "m.s-1": 1,
            "mm/s rms": 1e-3, "mm/sec": 1e-3},
    "N m": {"Nm": 1, "NM": 1, "N·m": 1, "N*m": 1, "N.m": 1, "N-m": 1, "N m": 1, "KNM": 1e3, "daNm": 10, "kgf.m": G,
            "Ncm": 0.01,
            "lbf.ft": 12 * INCH * LBF, "ft-lb": 12 * INCH * LBF, "FT*LBS": 12 * INCH * LBF, "in-lbs": INCH * LBF},
    "N": {"Newtons": 1, "KN": 1e3, "daN": 10, "kgf": G, "kp": G, "LBF": LBF, "N rms": 1},
    "rad/s": {"RPM": TURN / 60, "1/min": TURN / 60, "min-1": TURN / 60, "U/min": TURN / 60, "Upm": TURN / 60,
              "rev/min": TURN / 60, "Rev./min": TURN / 60, "tr/min": TURN / 60, "°/s": TURN / 360,
              "deg/sec": TURN / 360},
    "rad": {"°": TURN / 360, "Degrees": TURN / 360, "rev": TURN, "mrad": 1e-3},
    "1": {"%": 0.01, "-": 1, "V/V": 1, "mV/V": 1e-3, "counts": 1, "µε": 1e-6, "um/m": 1e-6, "ustrain": 1e-6,
          "%RH": 0.01, "[-]": 1, "microstrain": 1e-6, "": 1},
    "V": {"Volts": 1, "VOLT": 1, "MV": 1e-3, "Vrms": 1, "mV": 1e-3}, "A": {"Amps": 1, "MA": 1e-3},
    "Hz": {"HZ": 1, "KHZ": 1e3, "1/s": 1, "Hertz": 1}, "s": {"SEC": 1, "MS": 1e-3, "msec": 1e-3, "µs": 1e-6, "S": 1},
    "W": {"HP": 745.6998716, "PS": 735.49875, "kW": 1e3}, "ohm": {"Ω": 1, "kOhm": 1e3}, "C": {"pC": 1e-12},
    "m^3/s": {"l/min": 1e-3 / 60, "L/MIN": 1e-3 / 60, "cfm": 0.028316846592 / 60},
    "W/m/K": {"W/m K": 1, "W/(m·K)": 1}, "K/s": {"°C/s": 1}, "N/m": {"N/mm": 1e3}, "kg m^2": {"kgm2": 1, "kg·m²": 1}}


@pytest.mark.parametrize("si", WRITTEN)
def test_units_as_they_are_written(si):
    for written, size in WRITTEN[si].items():
        assert in_si(1.0, written, written) == (pytest.approx(size, rel=1e-8), si)


@pytest.mark.parametrize("written", [
    "EU", "C", "F", "kg^0.5/m^0.5/s", "kg^2", "N kg", "mol/s", "gauss", "arb", "a.u.", "U", "mic", "x", "grad",
    "ton", "dB", "dB(A)", "mn", "V/N", "V p-p", "?C", "degree of wear", "1e-3 m", "2 m", "m^0.5", "m/", "(m", "m)",
    "kG", "nM", "furlong", "m" * 200, "((((m))))", "m 3", "PPa", "\N{REPLACEMENT CHARACTER}m", "mg/V", "Pa^2"])
def test_what_no_channel_has_is_refused_with_the_line_to_write(written):
    with pytest.raises(ConfigError, match=r"x: expected a .*; add units: \{x: \.\.\.\}$"):
        in_si(1.0, written, "x", line="add units: {x: ...}")


def test_what_a_letter_means_depends_on_the_quantity():
    assert in_si(20.0, "C", "x", "temperature") == (pytest.approx(293.15), "K")
    assert in_si(2.0, "kg", "x", "force") == (pytest.approx(2 * G), "N") and in_si(2.0, "kg", "x") == (2.0, "kg")
    assert in_si(2.0, "lbs", "x", "force")[0] == pytest.approx(2 * LBF)
    assert in_si(2.0, "g", "x", "acceleration")[0] == 2 * G and in_si(2.0, "g", "x")[1] == "kg"
    assert [measured_in(unit, "x") for unit in ("g", "G", "[g]", "NM", "deg C")] == [
        "acceleration", "acceleration", "acceleration", "torque", "temperature"]
    with pytest.raises(ConfigError, match="found 'C'; write degC where it is a temperature"):
        in_si(20.0, "C", "x")
    with pytest.raises(ConfigError, match="found 'mn'; write MN or mN"):
        in_si(20.0, "mn", "x")


def test_guesses_are_told_and_nothing_else():
    told = {unit: read_as(unit) for unit in ("G", "MPA", "MV", "1/min", "ms-2", "kg/cm2", "ft-lb")}
    assert told["G"] == "9.80665 m/s^2" and told["MPA"] == "1e+06 Pa" and told["MV"] == "0.001 V" and all(told.values())
    assert not any(read_as(unit) for unit in ("m/s^2", "RPM", "deg C", "Volts", "bar(g)", "g", "N.m", "EU"))
    assert read_as("lbs", "force") == "4.44822 N" and not read_as("lbs")


@pytest.mark.parametrize("written, size, name", [
    ("G/N", G, "m/s^2/N"), ("g/N", G, "m/s^2/N"), ("g/lb", G / LBF, "m/s^2/N"), ("M/S^2/N", 1, "m/s^2/N"),
    ("mils/lbf", 25.4e-6 / LBF, "m/N"), ("m/N m", 1, "m/N m"), ("PA/N", 1, "Pa/N"), ("mg per N", 1e-3 * G, "m/s^2/N"),
    ("(in/s)/(lbf)", INCH / LBF, "m/s/N"), ("N/mm", 1e3, "N/m"), ("°/Nm", TURN / 360, "rad/N m"), ("%", 0.01, "1")])
def test_units_of_responses(written, size, name):
    assert quotient_in_si(1.0, written, "x") == (pytest.approx(size, rel=1e-8), name)


@pytest.mark.parametrize("written", ["EU/N", "m/s^2/EU", "mol/N", "kg^2/N", "N^3/m", "dB"])
def test_responses_that_there_are_none_of(written):
    with pytest.raises(ConfigError, match="x: expected a unit such as mm/s or kN"):
        quotient_in_si(1.0, written, "x")


def test_labels_are_made_plain_and_hints_say_what_to_write():
    assert plain(" [µm/s²] ") == "um/s2" and plain("(mm/s)/(N)") == "(mm/s)/(N)" and plain("Deg. C") == "degC"
    assert "EU" in hint("eu") and hint("m") == ""
    with pytest.raises(NoUnitError):
        readings("EU")

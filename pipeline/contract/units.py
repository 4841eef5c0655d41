"""SI everywhere; other units occur only in YAML and recordings, and are converted once, here."""

import math
import numbers
import re
import tokenize
from collections import Counter
from functools import cache

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received import channel_units
from pipeline.contract.received.unit_grammar import NoUnitError, checked_unit

#: every unit a product or a setting may carry (each is coherent SI; a test asks pint)
SI = frozenset({
    "1", "m", "m^2", "m^3", "m^4", "1/m", "1/m^2", "rad/m", "s", "1/s", "Hz", "rad", "rad/s", "kg", "kg m^2",
    "1/kg^0.5", "kg/m^3", "m/s", "m/s^2", "N", "N m", "N/m", "N m/rad", "N m s/rad", "N s/m", "N s^2/m",
    "Pa", "Pa/m", "m/Pa", "1/Pa", "K", "J", "J/m", "W", "J/K/kg", "W/m/K", "1/K", "m^2/s", "m^2/s^2/Hz", "m^2/N",
})


#: SI units that measured samples are kept in
MEASURED = ("1", "m", "m/s", "m/s^2", "N", "N m", "Pa", "V", "A", "K", "s", "Hz", "kg", "W", "m^3/s", "m^3", "m/s^3")
#: and those of what is measured more rarely, or stated as a condition; a channel has none but these and angular ones
_RARE = ("m^2", "m^2/s", "1/m", "kg/s", "kg/m^3", "kg m^2", "N/m", "N m s", "N/s", "Pa s", "Pa/s", "K/s", "K/m",
         "W/m^2", "W/m/K", "J/kg", "J/K", "J/K/kg", "1/K", "V/s", "V/m", "A/s", "C", "ohm", "F", "H", "T", "lx")
#: SI units whose quotients responses per reference have
_ABOVE = ("1", "m", "m/s", "m/s^2", "m/s^3", "N", "N m", "Pa", "V", "A", "W", "m^3/s")
_BELOW = ("1", "m", "m/s", "m/s^2", "N", "N m", "Pa", "V", "A", "m^3/s")

#: SI units that a measured quantity can have, by its name; of any other quantity every unit is believed
QUANTITIES = {"displacement": ("m", "rad"), "position": ("m", "rad"), "velocity": ("m/s", "rad/s"),
              "speed": ("m/s", "rad/s"), "acceleration": ("m/s^2", "rad/s^2"), "angle": ("rad",),
              "angular_velocity": ("rad/s",), "angular_acceleration": ("rad/s^2",), "force": ("N",), "torque": ("N m",),
              "moment": ("N m",), "pressure": ("Pa",), "sound_pressure": ("Pa",), "voltage": ("V",),
              "current": ("A",), "temperature": ("K",)}
#: accelerations as accelerometers state them, in m/s^2: g is standard gravity there, and no gram
GRAVITIES = {"g": 9.80665, "mg": 9.80665e-3, "ug": 9.80665e-6}

#: units as people and programs write them, which pint reads as something else, or not at all
AS_WRITTEN = {"U/min": "rpm", "°": "deg"}
#: and the same of parts of a unit: torques, accelerations
_PARTS = ((re.compile(r"(?<![A-Za-z])([kM]?N)(m{1,2})(?![A-Za-z])"), r"(\1 \2)"),
          (re.compile(r"\b([mu]?m)/s2\b"), r"\1/s^2"))
#: a temperature as it is read; 0 degC in K
_CELSIUS, _ZERO_CELSIUS = ("degC", "°C"), 273.15
_UNSIGNED = r"([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?"
_LEVEL = re.compile(rf"dB\s*\(?\s*(?:(?:re|ref|rel)\b\.?:?|//)\s*(?P<value>{_UNSIGNED})?\s*(?P<unit>[^\s)][^)]*)\)?",
                    re.IGNORECASE)
#: references that levels have by their names
_REFERENCES = {"dbspl": (20e-6, "Pa"), "dbv": (1.0, "V")}

#: unit of a linear quantity -> that of its counterpart about an axis, at a radius of 1 m of one size
TURNED = {"m": "rad", "m/s": "rad/s", "m/s^2": "rad/s^2", "N": "N m", "N/m": "N m/rad", "N s/m": "N m s/rad",
          "kg": "kg m^2"}

_ANGULAR = {"radian", "degree", "turn", "revolution", "cycle", "revolutions_per_minute", "revolutions_per_second"}
_NUMBER = re.compile(rf"\s*[-+]?{_UNSIGNED}\s*(?P<unit>.*)")
#: what pint stumbles over in texts that are no quantity, beside its own errors
_STUMBLES = (ArithmeticError, AssertionError, AttributeError, TypeError, ValueError, tokenize.TokenError)
#: numbers that belong to a unit, as in mm^2, s**-1, kg^(-0.5) and 1/s; any other one beside it is a mistake
_OF_UNIT = re.compile(r"(\^|\*\*)\s*\(?\s*[-+]?\d+(\.\d+)?(\s*/\s*\d+)?\s*\)?|(?<![\w.])1\s*/")
_STRAY = re.compile(r"[,±]|(?<![A-Za-z_\d.])\d")


#: units and prefixes that are read without loading pint, with the same bits as pint gives
_PLAIN = frozenset({"m", "s", "kg", "rad", "Hz", "N", "Pa", "J", "W", "K", "V", "A"})
_EXPONENT = {"": 0, "G": 9, "M": 6, "k": 3, "c": -2, "m": -3, "u": -6, "n": -9}
_SPELT = {("deg", "rad"): math.pi / 180, ("rpm", "rad/s"): math.pi / 30,
          **{(name, "m/s^2"): value for name, value in GRAVITIES.items()}}
#: decimal exponents that a product of prefixes may have; characters shown of a quantity that is refused
_DECADES, _LONGEST = 300, 200
_ATOM = re.compile(r"(?P<name>[A-Za-z]+)(\^(?P<power>[23]))?")


def as_written(unit):
    """A unit as files and people write it, as it is read."""
    unit = AS_WRITTEN.get(unit, unit)
    for written, read in _PARTS:
        unit = written.sub(read, unit)
    return unit


def to_si(value, unit, where):
    """Convert ``"12 mm"`` (or a bare number, where ``unit`` is "1") to a float in ``unit``.

    Raises ConfigError that names ``where``, the unit expected and what was found.
    """
    expected = "a number" if unit == "1" else f'a quantity in {unit}, such as "{example(unit)}"'
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        if unit != "1":
            raise ConfigError(where, expected, f"{value!r} without a unit", "write the unit after the number")
        return _as_float(value, where, expected)
    spelt = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    if not spelt or (unit != "1" and not spelt["unit"]):
        raise ConfigError(where, expected, repr(value))
    if _STRAY.search(_OF_UNIT.sub("", spelt["unit"])):
        raise ConfigError(where, expected, repr(value), "write one number, with a decimal point, and its unit")
    number, written = value.removesuffix(spelt["unit"]), as_written(spelt["unit"])
    if written:
        written = _of_grammar(written, where, expected, value)
    celsius = unit == "K" and written in _CELSIUS
    result = float(number) + _ZERO_CELSIUS if celsius else _plainly(number, written, unit)
    if result is None:
        result = _convert(f"{number}{written}", unit, lambda: ConfigError(where, expected, repr(value)))
    if not math.isfinite(result):
        raise ConfigError(where, expected, f"{value!r}, which is not finite")
    return result


def _as_float(value, where, expected):
    try:
        return float(value)
    except OverflowError:
        raise ConfigError(where, expected, "a number that is too large") from None


def _of_grammar(written, where, expected, value):
    """A unit behind a number as pint may read it; ConfigError where it is of no grammar that is known."""
    lead = written[0] if written[0] in "*/" else ""
    try:
        return lead + checked_unit(written[len(lead):])
    except NoUnitError:
        raise ConfigError(where, expected, repr(value)[:_LONGEST], "write one number and a unit with powers up to"
                          " 9") from None


def _plainly(number, spelt, unit):
    """``number spelt`` in ``unit`` where both are products of plain units; None where pint has to read it."""
    if (spelt, unit) in _SPELT:
        return float(number) * _SPELT[spelt, unit]
    if spelt == "g" and unit == "kg":
        return float(number) / 1000
    given, wanted = _factors(spelt), _factors("" if unit == "1" else unit)
    if given is None or wanted is None or given[0] != wanted[0]:
        return None
    return float(number) * 10.0 ** given[1] if abs(given[1]) < _DECADES else None


@cache
def _factors(spelt):
    """({plain unit: power}, decimal exponent) of ``N s/m`` and the like; None where it is more than that."""
    powers, exponent = Counter(), 0
    numerator, *denominators = spelt.split("/")
    atoms = [(atom, 1) for atom in numerator.split() if atom != "1"] + [(atom, -1) for atom in denominators]
    for atom, sign in atoms:
        match = _ATOM.fullmatch(atom)
        name = match and _named(match["name"])
        if not name:
            return None
        power = sign * int(match["power"] or 1)
        powers[name[0]] += power
        exponent += power * name[1]
    return {name: power for name, power in powers.items() if power}, exponent


def _named(name):
    """(plain unit, decimal exponent of its prefix); None for any other name."""
    if name in _PLAIN:
        return name, 0
    prefix, base = name[0], name[1:]
    return (base, _EXPONENT[prefix]) if prefix in _EXPONENT and base in _PLAIN - {"kg"} else None


def in_si(values, unit, where, measures="", line=""):
    """(values in coherent SI, name of the SI unit) of ``values`` in a ``unit`` of a channel as it is written.

    ``measures``: name of what is measured; "g" of an acceleration is standard gravity. Levels have a reference, as
    "dB re 20 uPa", and become effective values. Raises ConfigError, also for a unit that one of QUANTITIES cannot have;
    ``line``: what to write in the case, for its remedy.
    """
    if unit.strip()[:2] in ("dB", "DB", "db"):
        return _from_level(np.asarray(values, float), unit, where, measures, line)
    reading, name = _chosen(unit, where, measures, line)
    return _registry().Quantity(values, reading.unit).to(_for_pint(name)).magnitude, name


def makes_other_numbers(unit, other, measures=""):
    """Whether a ``unit`` makes other numbers of what is measured than an ``other`` one; False where either is none."""
    ends = np.array([0.0, 1.0])
    try:
        wanted, name = in_si(ends, other, "unit", measures)
        made, si = in_si(ends, unit, "unit", measures if _can_have(unit, measures) else "")
    except ConfigError:
        return False
    return si != name or not np.allclose(made, wanted, rtol=1e-6, atol=0.0)


def _can_have(unit, measures):
    try:
        return bool(in_si(1.0, unit, "unit", measures))
    except ConfigError:
        return False


def read_as(unit, measures="", response=False):
    """What a ``unit``, of a ``response`` per reference or of samples, is taken for where that is a guess, as
    "9.80665 m/s^2" of "G"; '' otherwise, and of none."""
    try:
        reading, name = _chosen_quotient(unit, "unit") if response else _chosen(unit, "unit", measures)
    except ConfigError:
        return ""
    if not reading.guess:
        return ""
    return reading.unit if reading.unit in ("degC", "degF") else (
        f"{_registry().Quantity(1.0, reading.unit).to_base_units().magnitude:.6g} {name}")


def _chosen(unit, where, measures="", line=""):
    """(Reading of a unit, its SI unit): the first that the quantity can have, or that any channel can."""
    import pint

    wanted = QUANTITIES.get(measures, ())
    try:
        if channel_units.only_of(unit) not in ("", measures):
            raise NoUnitError(repr(unit))
        found = [(reading, _si_of(reading.unit)) for reading in channel_units.readings(unit)]
    except (NoUnitError, pint.PintError, *_STUMBLES) as error:
        raise _no_unit(unit, where, line, *error.args[1:2]) from None
    found = [(reading, name) for reading, name in found if name]
    if not found:
        raise _no_unit(unit, where, line)
    fitting = next((each for each in found if each[1] in wanted), None) if wanted else found[0]
    if fitting is None:
        raise ConfigError(where, f"a unit of {measures}, such as {' or '.join(wanted)}", repr(unit),
                          _remedy("correct the unit, or what the channel measures", line))
    return fitting


def _no_unit(unit, where, line, told=""):
    told = told or channel_units.hint(unit)
    if "\N{REPLACEMENT CHARACTER}" in unit:
        told = "" if line else "state the unit in the case"
    return ConfigError(where, "a unit such as mm/s or kN", f"{unit!r}{'' if told else ', which no channel has'}",
                       _remedy(told, line))


def _remedy(*parts):
    return "; ".join(filter(None, parts)) or None


@cache
def _si_of(unit):
    """Name of the SI unit of a ``unit`` of pint that a channel can have; '' of any other."""
    quantity = _registry().Quantity(1.0, unit)
    name = next((n for n in MEASURED if quantity.is_compatible_with(_for_pint(n))), "")
    if "radian" in map(str, quantity.to_base_units().units._units):
        name = {"1": "rad", "Hz": "rad/s"}.get(name, name)
        powers = ("1/s^2", "1/s^3") if not name else ()
        name = next((f"rad{power[1:]}" for power in powers if quantity.is_compatible_with(power)), name)
    return name or next((n for n in _RARE if quantity.is_compatible_with(_for_pint(n))), "")


def quotient_in_si(values, unit, where, line=""):
    """The same of a quotient such as ``mm/s^2/N``, whose parts keep their names: (values, ``m/s^2/N``)."""
    whole, name = _chosen_quotient(unit, where, line)
    return _registry().Quantity(values, whole.unit).to_base_units().magnitude, name


def _chosen_quotient(unit, where, line=""):
    """The same as of ``_chosen`` of a response per reference."""
    import pint

    try:
        found = [(reading, _registry().Quantity(1.0, reading.unit))
                 for reading in channel_units.readings(unit, response=True)]
    except (NoUnitError, pint.PintError, *_STUMBLES) as error:
        raise _no_unit(unit, where, line, *error.args[1:2]) from None
    found = [(reading, one, _parts_of(channel_units.plain(unit), one)) for reading, one in found
             if one.dimensionality in _quotients()]
    if not found:
        raise _no_unit(unit, where, line)
    whole, one, parts = next((each for each in found if each[2]), found[0])
    name = _si_of(whole.unit)
    return whole, name if name in MEASURED else parts or f"{one.to_base_units().units:~C}"


def _parts_of(unit, whole):
    """``m/s^2/N`` of a quotient that a quantity ``whole`` of pint measures; '' where it has no parts of channels."""
    above, _, below = unit.rpartition("/")
    if not above or below.count("(") != below.count(")"):
        return ""
    try:
        pairs = [(upper.unit, lower.unit) for upper in channel_units.readings(above, response=True)
                 for lower in channel_units.readings(below, response=True)]
    except NoUnitError:
        return ""
    return next((f"{_si_of(upper)}/{_si_of(lower)}" for upper, lower in pairs if _si_of(upper) and _si_of(lower)
                 and whole.is_compatible_with(f"({upper or 1})/({lower or 1})")), "")


@cache
def _quotients():
    """Dimensions of responses per reference."""
    def dimension(name):
        return _registry().Quantity(1.0, _for_pint(name)).dimensionality

    return frozenset(dimension(a) / dimension(b) for a in _ABOVE for b in _BELOW)


def measured_in(unit, where, line=""):
    """Name of what is usually measured in a ``unit`` as files write it; 'value' of any other. Errors as ``in_si``."""
    si = "m/s^2" if channel_units.plain(unit) in GRAVITIES else in_si(1.0, unit, where, line=line)[1]
    return next((name for name, (first, *_) in QUANTITIES.items() if first == si), "value")


def _from_level(values, unit, where, measures, line):
    """(values, SI unit) of levels in a unit such as 'dB re 20 uPa'."""
    stated, named = _LEVEL.fullmatch(unit.strip()), re.sub(r"[\s()]", "", unit).lower()
    if named in _REFERENCES:
        value, of = _REFERENCES[named]
    elif stated:
        value, of = float(stated["value"] or 1.0), stated["unit"]
    else:
        weighted = "" if named == "db" else "a weighted level is no pressure"
        raise ConfigError(where, "a level with its reference, such as dB re 20 uPa", repr(unit),
                          _remedy(weighted, line))
    reference, name = in_si(value, of, where, measures, line)
    return reference * 10.0 ** (values / 20.0), name


def _convert(text, unit, refusal):
    import pint

    try:
        quantity = _registry().Quantity(text)
        if _mixes_turns(quantity, unit):
            raise refusal()
        return float(quantity.to(_for_pint(unit) or "dimensionless").magnitude)
    except (pint.PintError, *_STUMBLES):
        raise refusal() from None


def _mixes_turns(quantity, unit):
    """True for hertz where rad/s is meant, or turns and angles where hertz is: pint ignores that factor of 2 pi."""
    named = set(map(str, quantity.units._units))
    if "rad" in unit:
        return any(name.endswith("hertz") for name in named)
    return unit == "Hz" and bool(named & _ANGULAR)


def _for_pint(unit):
    return {"1": "", "C": "coulomb"}.get(unit, unit.replace("1/kg^0.5", "kg^(-0.5)"))


@cache
def _registry():
    import pint

    return pint.UnitRegistry()


def example(unit):
    """A quantity in ``unit`` as a user may write it."""
    if unit == "1":
        return "0.4"
    return {"m": "12 mm", "Pa": "2 MPa", "s": "0.1 s", "m^2/N": "3e-6 mm^2/N", "m/s": "1 m/s"}.get(unit, f"1 {unit}")

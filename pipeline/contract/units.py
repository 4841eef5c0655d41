"""SI everywhere; other units exist only in YAML, and are converted once, here."""

import numbers
from functools import cache

from pipeline.contract.errors import ConfigError

#: every unit a product or a setting may carry (each is coherent SI; a test asks pint)
SI = frozenset({
    "1", "m", "m^2", "m^3", "m^4", "1/m", "rad/m", "s", "1/s", "Hz", "rad", "rad/s", "kg", "1/kg^0.5",
    "kg/m^3", "m/s", "m/s^2", "N", "N m", "N/m", "N m/rad", "N s/m", "N s^2/m", "Pa", "Pa/m", "m/Pa", "1/Pa",
    "K", "J", "W", "J/K/kg", "W/m/K", "1/K", "m^2/s", "m^2/s^2/Hz", "m^2/N",
})


@cache
def _registry():
    import pint

    return pint.UnitRegistry()


def to_si(value, unit, where):
    """Convert ``"12 mm"`` (or a bare number, where ``unit`` is "1") to a float in ``unit``.

    Raises ConfigError that names ``where``, the unit expected and what was found.
    """
    example = f"a quantity in {unit}, such as \"{_example(unit)}\"" if unit != "1" else "a number"
    if isinstance(value, bool) or not isinstance(value, (str, numbers.Real)):
        raise ConfigError(where, example, repr(value))
    if isinstance(value, numbers.Real):
        if unit != "1":
            raise ConfigError(where, example, f"{value!r} without a unit", "write the unit after the number")
        return float(value)
    try:
        return float(value) if unit == "1" else _convert(value, unit)
    except ValueError:
        pass
    try:
        return _convert(value, unit)
    except Exception as error:
        if type(error).__module__.split(".")[0] not in ("pint", "tokenize", "builtins"):
            raise
        raise ConfigError(where, example, repr(value)) from None


def _convert(text, unit):
    registry = _registry()
    quantity = registry.Quantity(text)
    if quantity.unitless and unit != "1" and not any(c.isalpha() or c == "%" for c in text):
        raise ArithmeticError("no unit")
    target = "dimensionless" if unit == "1" else unit.replace("1/kg^0.5", "kg^(-0.5)")
    return float(quantity.to(target).magnitude)


def _example(unit):
    return {"m": "12 mm", "Pa": "2 MPa", "s": "0.1 s", "m^2/N": "3e-6 mm^2/N", "m/s": "1 m/s"}.get(unit, f"1 {unit}")

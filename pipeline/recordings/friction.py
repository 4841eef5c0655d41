"""Tables of measured friction, in SI units."""

from dataclasses import fields

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.products import MeasuredFriction

#: what a table must say, the unit of each column, and what holds where a table says nothing
NEEDED = ("friction", "pressure", "speed")
UNITS = {"friction": "1", "friction_std": "1", "pressure": "Pa", "speed": "m/s", "distance": "m", "temperature": "K"}
SILENT = {"friction_std": 0.0, "distance": 0.0, "temperature": 293.15}


def measured_friction(given, where):
    """MeasuredFriction of ``given`` {name: (values (n,), unit, where it is stated)}. ConfigError at ``where``.

    Rows that lack a number are left out.
    """
    unknown, lacking = set(given) - set(UNITS), [name for name in NEEDED if name not in given]
    if unknown or lacking:
        raise ConfigError(where, f"columns or values among {', '.join(UNITS)}, {', '.join(NEEDED)} at least",
                          f"{', '.join(sorted(unknown)) or 'none'} beside them, no {', '.join(lacking) or 'other'}",
                          "name them under columns or values")
    filled = {name: _converted(*given[name], UNITS[name]) for name in UNITS if name in given}
    count = len(filled["friction"])
    filled |= {name: np.full(count, value) for name, value in SILENT.items() if name not in given}
    whole = np.isfinite([filled[f.name] for f in fields(MeasuredFriction)]).all(axis=0)
    if not whole.any():
        raise ConfigError(where, "a row without missing numbers", "none", "leave out columns that are empty")
    return MeasuredFriction(**{name: values[whole] for name, values in filled.items()})


def _converted(values, unit, where, wanted):
    converted, found = in_si(np.asarray(values, float), unit, f"{where}.unit")
    if found != wanted:
        raise ConfigError(f"{where}.unit", f"a unit of {wanted}", unit)
    return converted

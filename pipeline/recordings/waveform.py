"""One channel of a file as the file has it, before the case says what it means."""

import re
import unicodedata
from dataclasses import dataclass
from importlib import import_module

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import measured_in

#: what measurement systems write where they state no unit
_NO_UNIT = frozenset({"NONE", "none", "-", "?"})

#: 1990 in microseconds since 1970: earlier instants are those that programs begin to count at
_SET = 631_152_000_000_000

#: what to do with a channel that lacks more than a unit
_NAMED = "name it under 'columns'"
_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss"})


@dataclass(frozen=True)
class Waveform:
    """``values`` (sample,) in ``unit`` ('': none told), at ``rate`` in Hz (None: none told), from ``begin`` in s.

    ``times`` (sample,) in s: instants of samples that are not even; None of others. ``stamp``: (time 0 s in seconds
    since 1970, UTC; steps in s that it is written in), None where the file tells none. ``remark``: what the reader left
    out of it or took for granted; a channel without values is left out itself.
    """

    values: np.ndarray
    unit: str = ""
    rate: float | None = None
    begin: float = 0.0
    times: np.ndarray | None = None
    stamp: tuple | None = None
    remark: str = ""


def stamped(microseconds):
    """Stamp of a Waveform of an instant in whole microseconds since 1970, None of one before 1990: it was never set."""
    if microseconds < _SET:
        return None
    return microseconds / 1e6, next(step / 1e6 for step in (10**6, 10**3, 1) if microseconds % step == 0)


def unit_of(label):
    """The unit that a ``label`` of a file states, '' of one that states none."""
    return "" if label in _NO_UNIT else label


def self_told(found, units, rate, where, tell):
    """{channel: (name in the file, unit of the case or None)} of the Waveforms ``found`` that say enough of themselves.

    ``units``: name, of the file or plain -> unit, where the file states none or a wrong one; ``rate`` Hz: of those that
    state none. ``tell`` is called with what is left out, and why; one alone is left to its error. Raises ConfigError
    for ``units`` of others.
    """
    told, units = {}, dict(units)
    for name, one in found.items():
        key = free_name(plain_name(name), told)
        stated = units.pop(name, units.pop(key, None))
        unit = unit_of(one.unit) if stated is None else stated
        even = rate or one.rate or (one.times is not None and len(one.times) > 1)
        lacks = [what for what, there in (("unit", unit), ("sampling rate", even)) if not there]
        remark = f" ({one.remark})" if one.remark else ""
        line = f"add units: {{{key}: ...}}"
        why = _unreadable(unit, "unit", line) if unit and stated is None else ""
        if lacks:
            why = f"the file states no {' and no '.join(lacks)}{remark}; {line if lacks == ['unit'] else _NAMED}"
        if why and len(found) > 1:
            tell(f"{where}: {name} left out: {why}")
        else:
            told[key] = name, stated
    if units:
        raise ConfigError(f"{where}: units", f"channels among {', '.join(found)}", ", ".join(units))
    return told


def _unreadable(unit, where, line):
    """Why no channel can have this unit; '' where one can."""
    try:
        measured_in(unit, where, line)
    except ConfigError as error:
        return str(error)
    return ""


def held_as(dtype):
    """float32 where it holds numbers of this ``dtype`` exactly, else float."""
    return np.dtype(np.float32 if np.can_cast(dtype, np.float32, "safe") else float)


def plain_name(text, otherwise="channel"):
    """A name as runs and channels have them: ASCII letters, digits and _, umlauts written out."""
    written = unicodedata.normalize("NFKD", str(text).translate(_UMLAUTS)).encode("ascii", "ignore").decode()
    return re.sub(r"\W+", "_", written).strip("_") or otherwise


def free_name(name, taken):
    """``name``, or the first of name_2, name_3, ... that is not among ``taken``."""
    return next(n for n in (name if k == 1 else f"{name}_{k}" for k in range(1, len(taken) + 2)) if n not in taken)


def library(module, package, path):
    """The ``module`` of a ``package`` that reads files like ``path``; ConfigError where it is not installed."""
    try:
        return import_module(module)
    except ImportError:
        raise ConfigError(path, f"the package {package}, which reads such files", "none",
                          "install it: pip install 'brakechain[bench]'") from None

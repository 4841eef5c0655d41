"""The open convention SEP 005 of SDyPy for time signals: a list of dictionaries, as its readers return.

``save(read(path), "stop_3.h5")`` with the ``read`` of any package of the convention makes a recording of what it reads,
which a case then takes as ``kind: hdf5``.
"""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.names import checked
from pipeline.contract.units import measured_in
from pipeline.products import Run
from pipeline.recordings.neutral import write_neutral
from pipeline.recordings.samples import channel, even_rate, with_gaps


def run_of(signals, description="", where="signals"):
    """The product Run of ``signals``, dictionaries with data, name, unit_str, and fs in Hz or time in s.

    Raises ConfigError with the name of a signal that lacks one of these, holds another type than the convention says,
    has a name twice or times that are not even.
    """
    channels = {}
    for k, signal in enumerate(_dictionaries(signals, where)):
        at = f"{where}: {signal.get('name', k)}"
        missing = [name for name in ("data", "name", "unit_str") if signal.get(name) is None]
        if missing or (signal.get("fs") is None and signal.get("time") is None):
            raise ConfigError(at, "data, name, unit_str, and fs or time", f"no {', '.join(missing) or 'fs or time'}")
        name, unit, measures = (_text(signal, key, at) for key in ("name", "unit_str", "quantity"))
        if name in channels:
            raise ConfigError(at, "each name once", "it twice")
        rate, begin = ((_numbers(signal, "fs", 0, at), 0.0) if signal.get("time") is None
                       else even_rate(_numbers(signal, "time", 1, at), at))
        channels[checked(name, at)] = channel(_numbers(signal, "data", 1, at), unit or "1",
                                              measures or measured_in(unit or "1", at), rate, begin, at)
    if not channels:
        raise ConfigError(where, "at least one signal", "none")
    return Run(description=description, repeat_of="", channels=channels)


def _dictionaries(signals, where):
    if not isinstance(signals, list | tuple) or not all(isinstance(signal, dict) for signal in signals):
        raise ConfigError(where, "a list of dictionaries", "another one")
    return signals


def _text(signal, key, at):
    """The text under ``key``, '' where there is none."""
    value = signal.get(key)
    if value is not None and not isinstance(value, str):
        raise ConfigError(f"{at}: {key}", "a text", type(value).__name__)
    return value or ""


def _numbers(signal, key, dimensions, at):
    """What is under ``key`` as an array of so many dimensions."""
    try:
        values = np.asarray(signal[key], float)
    except (TypeError, ValueError, OverflowError) as error:
        raise ConfigError(f"{at}: {key}", "numbers", str(error)) from None
    if values.ndim != dimensions:
        raise ConfigError(f"{at}: {key}", "one number" if not dimensions else "numbers (sample,)",
                          f"{values.ndim} dimensions")
    return values


def signals_of(run):
    """The channels of a product Run as dictionaries of the convention; samples that are missing are NaN."""
    found = []
    for name, one in run.channels.items():
        samples, rate, begin = with_gaps(one), float(one.rate), float(one.begin)
        signal = {"name": name, "data": samples, "unit_str": str(one.unit), "fs": rate, "quantity": str(one.measures)}
        if begin:
            signal["time"] = begin + np.arange(len(samples)) / rate
        found.append(signal)
    return found


def save(signals, path, run="run", description=""):
    """Write ``signals`` of the convention as a recording of one ``run`` in plain HDF5."""
    made = run_of(signals, description, str(path))
    write_neutral(path, {run: {
        "description": description, "repeat_of": "", "conditions": {},
        "channels": {name: (with_gaps(one), str(one.unit), str(one.measures), float(one.rate), float(one.begin))
                     for name, one in made.channels.items()}}})

"""Recordings in plain HDF5 that any program can write; ``read_neutral`` documents the format."""

from dataclasses import fields

import h5py
import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.hdf5 import refuse_outside
from pipeline.contract.units import in_si, quotient_in_si, read_as
from pipeline.products import (
    Condition,
    FrequencyResponse,
    Lines,
    MeasuredFriction,
    MeasuredModes,
    Run,
    Topography,
)
from pipeline.recordings.friction import SILENT
from pipeline.recordings.samples import channel


def read_neutral(path, tell=None):
    """Run name -> Run of an HDF5 file of this form; a star marks optional items:

        /runs/RUN                          attributes description*, repeat_of*
            conditions/NAME*               number or series; attributes units, sample_rate (of a series), t0*
            channels/NAME*                 (sample,); attributes units, quantity, sample_rate, t0*, role*, point_name*,
                                           point* (x, y, z in m), direction*; NaN = missing
            frf/NAME*                      group: frequency (Hz), response (complex); attributes units, response*,
                                           reference*
            modes/NAME*                    group: frequency (Hz), frequency_std*, damping_ratio*, damping_ratio_std*,
                                           shape* (mode, place), place*
            lines/NAME*                    group: frequency (Hz), frequency_tolerance*, level* (dB), label*; attribute
                                           place*
            topography/NAME*               (y, x) heights; attributes units, pixel_size (m), body*, state*
            friction/NAME*                 group: friction, friction_std*, pressure, speed, distance*, temperature* (SI)

    ``tell`` is called with what labels of units are taken for. Raises ConfigError with the path in the file of anything
    that is missing or unreadable.
    """
    try:
        with h5py.File(path, "r") as h5:
            refuse_outside(h5, path)
            if not isinstance(h5.get("runs"), h5py.Group) or not len(h5["runs"]):
                raise ConfigError(path, "a group /runs with at least one run", f"{', '.join(h5) or 'an empty file'}")
            found = {name: _run(group, f"{path}: runs/{name}") for name, group in h5["runs"].items()}
            for name, group in h5["runs"].items() if tell else ():
                _tell_guesses(name, group.get("channels", {}), tell)
            return found
    except OSError as error:
        raise ConfigError(path, "a whole HDF5 file", str(error)) from None


def _tell_guesses(run, channels, tell):
    for name, node in channels.items():
        guess = read_as(_text(node, "units"), _text(node, "quantity"))
        if guess:
            tell(f"{run}, {name}: unit {_text(node, 'units')!r} is read as {guess}")


def write_neutral(path, runs):
    """Write {run: {description, repeat_of, conditions {name: (value, unit)}, channels {name: (samples, unit, quantity,
    rate in Hz, begin in s*)}, topography* {name: (heights in m, pixel in m, body, state)}, friction* {name: {column: SI
    values}}}} in this form."""
    with h5py.File(path, "w") as h5:
        for name, run in runs.items():
            group = h5.create_group(f"runs/{name}")
            group.attrs.update(description=run["description"], repeat_of=run["repeat_of"])
            for key, (value, unit) in run["conditions"].items():
                group.create_dataset(f"conditions/{key}", data=float(value)).attrs["units"] = unit
            for key, (samples, unit, quantity, rate, *begin) in run["channels"].items():
                node = group.create_dataset(f"channels/{key}", data=np.asarray(samples, np.float32), compression="gzip")
                node.attrs.update(units=unit, quantity=quantity, sample_rate=float(rate))
                if begin and begin[0]:
                    node.attrs["t0"] = float(begin[0])
            for key, (heights, pixel, body, state) in run.get("topography", {}).items():
                node = group.create_dataset(f"topography/{key}", data=heights, compression="gzip")
                node.attrs.update(units="m", pixel_size=pixel, body=body, state=state)
            for key, columns in run.get("friction", {}).items():
                for column, values in columns.items():
                    group.create_dataset(f"friction/{key}/{column}", data=values)


def _run(group, where):
    readers = {"conditions": _condition, "channels": _channel, "frf": _frf, "modes": _modes, "lines": _lines,
               "topography": _topography, "friction": _friction}
    if not isinstance(group, h5py.Group):
        raise ConfigError(where, f"a group of {', '.join(readers)}", str(group))
    unknown = set(group) - set(readers) | {kind for kind, node in group.items() if not isinstance(node, h5py.Group)}
    if unknown:
        raise ConfigError(where, f"groups among {', '.join(readers)}", ", ".join(sorted(unknown)))
    filled = {kind: {name: _checked(reader, node, f"{where}/{kind}/{name}")
                     for name, node in group.get(kind, {}).items()} for kind, reader in readers.items()}
    return Run(description=_text(group, "description"), repeat_of=_text(group, "repeat_of"), **filled)


def _checked(reader, node, where):
    """``reader(node, where)``; any error of an unreadable node becomes a ConfigError at ``where``."""
    try:
        return reader(node, where)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError, RuntimeError) as error:
        raise ConfigError(where, "data and attributes as printed by 'brakechain data format'",
                          f"unreadable data ({type(error).__name__}: {error})") from None


def _text(node, name, default=""):
    value = node.attrs.get(name, default)
    return value.decode() if isinstance(value, bytes) else str(value)


def _needed(node, name, where):
    if name not in node.attrs:
        raise ConfigError(where, f"the attribute {name}", f"{', '.join(node.attrs) or 'none'}")
    return node.attrs[name]


def _unit(node, where):
    _needed(node, "units", where)
    return _text(node, "units")


def _channel(node, where):
    if not isinstance(node, h5py.Dataset) or node.ndim != 1:
        raise ConfigError(where, "a dataset (sample,)", str(node))
    _needed(node, "quantity", where)
    return channel(node[()], _unit(node, where), _text(node, "quantity"), float(_needed(node, "sample_rate", where)),
                   float(node.attrs.get("t0", 0.0)), where, role=_text(node, "role", "response"),
                   place=_text(node, "point_name"), position=node.attrs.get("point", ()),
                   direction=node.attrs.get("direction", ()))


def _condition(node, where):
    values, unit = in_si(np.atleast_1d(np.asarray(node[()], float)), _unit(node, where), where)
    if len(values) == 1:
        return Condition(value=values, time=[0.0], unit=unit)
    rate = float(_needed(node, "sample_rate", where))
    return Condition(value=values, time=float(node.attrs.get("t0", 0.0)) + np.arange(len(values)) / rate, unit=unit)


def _frf(node, where):
    response, unit = quotient_in_si(_array(node, "response", where), _unit(node, where), where)
    return FrequencyResponse(frequency=_array(node, "frequency", where), response=response, unit=unit,
                             place=_text(node, "response"), reference=_text(node, "reference"))


def _modes(node, where):
    frequency = np.atleast_1d(_array(node, "frequency", where))
    filled = {name: node[name][()] if name in node else np.zeros(len(frequency))
              for name in ("frequency_std", "damping_ratio", "damping_ratio_std")}
    shape = node["shape"][()] if "shape" in node else np.empty((len(frequency), 0))
    points = node["place"].asstr()[()] if "place" in node else [str(k + 1) for k in range(shape.shape[1])]
    return MeasuredModes(frequency=frequency, **filled, place=points, shape=np.asarray(shape, complex))


def _lines(node, where):
    frequency = np.atleast_1d(_array(node, "frequency", where))
    level = np.asarray(node["level"][()], float) if "level" in node else np.full(len(frequency), np.nan)
    off = node["frequency_tolerance"][()] if "frequency_tolerance" in node else np.zeros(len(frequency))
    label = node["label"].asstr()[()] if "label" in node else [""] * len(frequency)
    return Lines(label=label, frequency=frequency, frequency_tolerance=off, level=np.nan_to_num(level),
                 level_known=np.isfinite(level).astype(int), partners=np.zeros(len(frequency), int),
                 diameters=np.full(len(frequency), -1), place=_text(node, "place"))


def _topography(node, where):
    heights, unit = in_si(np.asarray(node[()], float), _unit(node, where), where)
    if unit != "m" or heights.ndim != 2:
        raise ConfigError(where, "heights (y, x) in a unit of length", f"{heights.ndim} dimensions in {unit}")
    pixel = np.broadcast_to(np.asarray(_needed(node, "pixel_size", where), float), 2)
    y, x = (size * np.arange(count) for size, count in zip(pixel, heights.shape, strict=True))
    return Topography(y=y, x=x, height=heights, body=_text(node, "body"), state=_text(node, "state"))


def _friction(node, where):
    friction = np.atleast_1d(_array(node, "friction", where))
    filled = {name: np.full(len(friction), value) for name, value in SILENT.items()}
    names = [f.name for f in fields(MeasuredFriction) if f.name != "friction"]
    for name in names:
        if name in node or name not in filled:
            filled[name] = np.broadcast_to(_array(node, name, where), friction.shape)
    return MeasuredFriction(friction=friction, **filled)


def _array(node, name, where):
    if name not in node:
        raise ConfigError(where, f"the dataset {name}", f"{', '.join(node) or 'none'}")
    return node[name][()]

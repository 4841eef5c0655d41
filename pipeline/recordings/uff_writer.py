"""Universal files written: channels and frequency responses of a run as data sets 58b, by the definition."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.recordings.samples import with_gaps

#: codes of quantities in data set 58, by SI unit
_CODES = {"m": 8, "m/s": 11, "m/s^2": 12, "N": 13, "Pa": 15, "K": 5}
#: abscissas: code, label and unit
_TIME, _FREQUENCY = (17, "Time", "s"), (18, "Frequency", "Hz")
_REAL, _COMPLEX = 4, 6


def write_uff(path, run):
    """Write the channels and frequency responses of the product Run to a universal file, in SI units.

    The format holds ten characters of a name, and six digits of begin and interval; a whole name stands in the first
    title. Samples that are missing are written as NaN. Raises ConfigError for a run without either.
    """
    sets = [_channel(k, name, channel) for k, (name, channel) in enumerate(run.channels.items(), 1)]
    sets += [_response(k, name, frf) for k, (name, frf) in enumerate(run.frf.items(), 1)]
    if not sets:
        raise ConfigError(path, "a run with channels or frequency responses", "none")
    with open(path, "wb") as file:
        file.writelines(sets)


def _channel(number, name, channel):
    ends = _point(str(channel.place), number), _axis(channel.direction), 0, 0
    return _function(1, name, ends, with_gaps(channel), (float(channel.begin), 1.0 / float(channel.rate)), _TIME,
                     (str(channel.measures), str(channel.unit)), "NONE")


def _response(number, name, frf):
    step = np.diff(frf.frequency)
    if len(step) and np.abs(step - step[0]).max() > 1e-6 * step[0]:
        raise ConfigError(f"frf {name}", "an even frequency axis", "an uneven one")
    above, _, below = str(frf.unit).rpartition("/")
    ends = (above, below) if above in _CODES and below in _CODES else (str(frf.unit), "NONE")
    reference = str(frf.reference)
    return _function(4, name, (_point(str(frf.place), number), _code(str(frf.place)), _point(reference, 1),
                               _code(reference)), np.asarray(frf.response, complex),
                     (float(frf.frequency[0]), float(step[0]) if len(step) else 1.0), _FREQUENCY,
                     ("response", ends[0]), ends[1])


def _function(kind, name, ends, values, axis, abscissa, ordinate, denominator):
    """Bytes of one data set 58b; ``ordinate`` (label, unit) per unit ``denominator``."""
    node, direction, reference, reference_direction = ends
    data = np.ascontiguousarray(values, "<c16" if np.iscomplexobj(values) else "<f8").tobytes()
    heads = [name, "NONE", "NONE", "NONE", "NONE",
             f"{kind:5d}{0:10d}{0:5d}{0:10d} {name[:10]:<10}{node:10d}{direction:4d} {'NONE':<10}{reference:10d}"
             f"{reference_direction:4d}",
             f"{_COMPLEX if np.iscomplexobj(values) else _REAL:10d}{len(values):10d}{1:10d}{axis[0]:13.5e}"
             f"{axis[1]:13.5e}{0.0:13.5e}",
             _axis_line(*abscissa), _axis_line(_CODES.get(ordinate[1], 0), *ordinate),
             _axis_line(_CODES.get(denominator, 0), "NONE", denominator), _axis_line(0, "NONE", "NONE")]
    head = f"    -1\n    58b{1:6d}{2:6d}{11:12d}{len(data):12d}{0:6d}{0:6d}{0:12d}{0:12d}\n"
    return (head + "".join(f"{line:<80}\n" for line in heads)).encode() + data + b"    -1\n"


def _axis_line(code, label, unit):
    return f"{code:10d}{0:5d}{0:5d}{0:5d} {label[:20]:<20} {unit[:20]:<20}"


def _point(place, number):
    """Number of the node that a place names, else its number in the file."""
    words = place.split()
    return int(words[1]) if len(words) > 1 and words[0] == "node" and words[1].isdigit() else number


def _code(place):
    words = place.split()
    return int(words[3]) if len(words) > 3 and words[2] == "direction" else 0


def _axis(direction):
    """Direction code of a unit vector along an axis, 0 of any other."""
    at = np.flatnonzero(np.abs(direction) > 0.999)
    return int(np.sign(direction[at[0]]) * (at[0] + 1)) if len(at) == 1 else 0

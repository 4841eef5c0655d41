"""MDF files of measurement systems (ASAM, version 3 and 4). The door of asammdf."""

from collections import Counter

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.mapped import Growing
from pipeline.recordings.samples import even_rate
from pipeline.recordings.waveform import Waveform, free_name, held_as, library

#: bytes of a file that are decoded at once
_BLOCK = 1 << 22


def read_mdf(path, folder=None):
    """{name: Waveform} of the channels of numbers in an MDF file, converted as it says; a name that several groups have
    is 'name (group k)'.

    The rate is that of the time stamps; a channel whose stamps are not even, to 1 % of their interval, has none.
    ``folder``: for long channels, see ``Growing``. Raises ConfigError for a file that is none or damaged, and one
    without channels of numbers.
    """
    asammdf = library("asammdf", "asammdf", path)
    try:
        with open(path, "rb") as stream, asammdf.MDF(stream, raise_on_multiple_occurrences=False) as file:
            file.configure(read_fragment_size=_BLOCK)
            found = [(k, name, waveform) for k in range(len(file.groups))
                     for name, waveform in _group(file, k, path, folder)]
    except BrakechainError:
        raise
    except Exception as error:  # asammdf passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged MDF file", str(error) or type(error).__name__) from None
    if not found:
        raise ConfigError(path, "a channel of numbers", "none")
    often, named = Counter(name for _, name, _ in found), {}
    for k, name, waveform in found:
        named[free_name(name if often[name] == 1 else f"{name} (group {k + 1})", named)] = waveform
    return named


def _group(file, k, path, folder):
    """[(name, Waveform)] of the channels of numbers of a group, which have their time stamps in common."""
    found, clock = [], None
    for n in range(len(file.groups[k].channels)):
        channel = _channel(file, k, n, folder) if n != file.masters_db.get(k) else None
        if channel is None:
            continue
        name, unit, values, times = channel
        clock = clock or _clock(times, f"{path}: {name}")
        found.append((name, Waveform(values, unit, *clock)))
    return found


def _channel(file, k, n, folder):
    """(name, unit, values (sample,), time stamps (sample,)) of a channel, read block by block; None of no numbers."""
    values, times = None, Growing(float)
    for signal in file.iter_get(group=k, index=n):
        if signal.samples.ndim != 1 or signal.samples.dtype.kind not in "fiu":
            return None
        values = values or Growing(held_as(signal.samples.dtype), folder)
        values.append(signal.samples)
        times.append(signal.timestamps)
    stamps = times.array()
    return (signal.name, (signal.unit or "").strip(), values.array(), stamps) if len(stamps) else None


def _clock(times, where):
    """(rate in Hz, begin in s) of time stamps (sample,), (None, 0) of uneven ones."""
    try:
        return even_rate(times, where)
    except ConfigError:
        return None, 0.0

"""MDF files of measurement systems (ASAM, version 3 and 4). The door of asammdf."""

from collections import Counter

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.recordings.samples import even_rate
from pipeline.recordings.waveform import Waveform, free_name, library


def read_mdf(path):
    """{name: Waveform} of the channels of numbers in an MDF file, converted as it says; a name that several groups have
    is 'name (group k)'.

    The rate is that of the time stamps; a channel whose stamps are not even, to 1 % of their interval, has none. Raises
    ConfigError for a file that is none or damaged, and one without channels of numbers.
    """
    asammdf = library("asammdf", "asammdf", path)
    try:
        with asammdf.MDF(str(path), raise_on_multiple_occurrences=False) as file:
            found = [(k, signal) for k, group in enumerate(file.groups) for n, _ in enumerate(group.channels)
                     if n != file.masters_db.get(k) for signal in [file.get(group=k, index=n)]
                     if signal.samples.ndim == 1 and signal.samples.dtype.kind in "fiu" and len(signal.samples)]
    except ConfigError:
        raise
    except Exception as error:  # asammdf passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged MDF file", str(error) or type(error).__name__) from None
    if not found:
        raise ConfigError(path, "a channel of numbers", "none")
    often, named = Counter(signal.name for _, signal in found), {}
    for k, signal in found:
        name = signal.name if often[signal.name] == 1 else f"{signal.name} (group {k + 1})"
        named[free_name(name, named)] = _waveform(signal, path)
    return named


def _waveform(signal, path):
    values, unit = np.asarray(signal.samples, float), (signal.unit or "").strip()
    try:
        rate, begin = even_rate(np.asarray(signal.timestamps, float), f"{path}: {signal.name}")
    except ConfigError:
        return Waveform(values, unit)
    return Waveform(values, unit, rate, begin)

"""MDF files of measurement systems (ASAM, version 3 and 4). The door of asammdf."""

from collections import Counter
from dataclasses import replace
from datetime import UTC

import numpy as np

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.mapped import Growing
from pipeline.recordings.samples import even_rate
from pipeline.recordings.waveform import Waveform, free_name, held_as, library, stamped

#: bytes of a file that are decoded at once
_BLOCK = 1 << 22
#: kinds of conversion to text, by the version of the file: of single values, of ranges, of bits
_VALUES, _RANGES, _BITS = {3: 11, 4: 7}, {3: 12, 4: 8}, {4: 11}
#: kinds of master channels of MDF 4 that are not times
_OTHER_AXES = {2: "angles", 3: "distances", 4: "numbers of samples"}


def read_mdf(path, folder=None):
    """{name: Waveform} of the channels of an MDF file, converted as it says; a name that several groups have is
    'name (group k)'.

    The rate is that of the time stamps; a channel whose stamps are not even, to 1 % of their interval, has times in its
    place. Samples that the file marks as invalid, and values that its conversion turns to text, are missing (NaN).
    ``folder``: for long channels, see ``Growing``. Raises ConfigError for a file that is none or damaged, and one
    without channels of numbers.
    """
    asammdf = library("asammdf", "asammdf", path)
    try:
        with open(path, "rb") as stream, asammdf.MDF(stream, raise_on_multiple_occurrences=False) as file:
            file.configure(read_fragment_size=_BLOCK)
            file.get = _uncut(file.get)
            stamp = _stamp(file)
            found = [(k, name, waveform) for k in range(len(file.groups))
                     for name, waveform in _group(file, k, stamp, folder)]
    except BrakechainError:
        raise
    except Exception as error:  # asammdf passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged MDF file", str(error) or type(error).__name__) from None
    if not any(len(waveform.values) for _, _, waveform in found):
        raise ConfigError(path, "a channel of numbers", "none")
    often, named = Counter(name for _, name, _ in found), {}
    for k, name, waveform in found:
        named[free_name(name if often[name] == 1 else f"{name} (group {k + 1})", named)] = waveform
    return named


def _uncut(get):
    """The reader of asammdf that marks invalid samples, in place of leaving them and their instants out."""
    return lambda *given, **named: get(*given, **named | {"ignore_invalidation_bits": True})


def _stamp(file):
    start = file.start_time
    start = start if start.tzinfo else start.replace(tzinfo=UTC)
    return stamped(round(1e6 * start.timestamp()))


def _group(file, k, stamp, folder):
    """[(name, Waveform)] of the channels of a group, which have their time stamps in common."""
    found, clock, master = [], None, file.masters_db.get(k)
    axis = "numbers of samples" if master is None else _OTHER_AXES.get(
        getattr(file.groups[k].channels[master], "sync_type", 1), "")
    for n, channel in enumerate(file.groups[k].channels):
        if n == master:     # the clock of the others
            continue
        unit, values, times, remark = _channel(file, k, n, folder, clock is None)
        one = Waveform(values, unit, stamp=stamp, remark=remark)
        if len(values):
            clock = clock or _clock(times, axis)
            one = replace(one, **clock | {"remark": "; ".join(filter(None, (remark, clock["remark"])))})
        if len(values) or remark:
            found.append((channel.name, one))
    return found


def _channel(file, k, n, folder, timed):
    """(unit, values (sample,), time stamps (sample,) if ``timed``, remark) of a channel, read block by block."""
    values, times, unit, lost, count = None, Growing(float), "", Counter(), 0
    for signal in file.iter_get(group=k, index=n, raw=True):
        if not len(signal.samples):
            continue
        numbers, text, bare = _numbers(signal.conversion, signal.samples)
        if numbers is None:
            return "", np.empty(0), None, "it holds no numbers"
        invalid = np.zeros(len(numbers), bool) if signal.invalidation_bits is None else signal.invalidation_bits > 0
        lost.update(invalid=int(invalid.sum()), text=int((text & ~invalid).sum()), bare=int((bare & ~invalid).sum()))
        gone = invalid | text
        values = values or Growing(held_as(numbers.dtype), folder)
        values.append(np.where(gone, np.nan, numbers) if gone.any() else numbers)
        if timed:
            times.append(signal.timestamps)
        unit, count = (signal.unit or _unit_beside(signal.conversion)).strip(), count + len(numbers)
    if lost["invalid"] + lost["text"] == count:
        why = "it holds texts alone" if lost["text"] else "the file marks all of its samples as invalid"
        return "", np.empty(0), None, why if count else ""
    return unit, values.array(), times.array() if timed else None, _told(lost, count)


def _told(lost, count):
    told = {"invalid": "{} of {} samples are missing: the file marks them as invalid",
            "text": "{} of {} samples are missing: they stand for texts, such as an error",
            "bare": "{} of {} samples are taken as they stand: beside texts, the file states no conversion to numbers"
                    " (name the channel under 'columns' with its unit and factor)"}
    return "; ".join(sentence.format(lost[key], count) for key, sentence in told.items() if lost[key])


def _clock(times, axis):
    """Fields of a Waveform that time stamps (sample,) give: rate and begin, or times where they are not even."""
    if axis:
        return {"remark": f"it is recorded over {axis}, not over time"}
    try:
        rate, begin = even_rate(times, "time stamps")
    except ConfigError:
        return {"times": times, "remark": ""}
    return {"rate": rate, "begin": begin, "remark": ""}


def _numbers(conversion, raw):
    """(numbers (sample,), where these are texts, where they are ``raw`` ones beside texts) of samples before their
    ``conversion``; numbers None of samples that are none."""
    none = np.zeros(len(raw), bool)
    if raw.ndim != 1 or raw.dtype.kind not in "fiu":
        raw = conversion.convert(raw) if conversion is not None and raw.ndim == 1 and raw.dtype.kind == "S" else raw
        return (raw if raw.ndim == 1 and raw.dtype.kind in "fiu" else None), none, none
    if conversion is None:
        return raw, none, none
    numbers, text, bare = _converted(conversion, raw)
    return (numbers if numbers.dtype.kind in "fiu" else None), text, bare


def _converted(conversion, raw):
    """(numbers (sample,), where they are texts, where they are taken as they stand beside texts) of ``raw`` samples."""
    kind, none = conversion.conversion_type, np.zeros(len(raw), bool)
    version = 3 if type(conversion).__module__.endswith("v2_v3_blocks") else 4
    if kind == _BITS.get(version):
        return raw, ~none, none
    if kind not in (_VALUES[version], _RANGES[version]):
        return conversion.convert(raw), none, none
    numbers, text, bare, left = np.array(raw, float), none.copy(), none.copy(), ~none
    for meant, other in _entries(conversion, raw, kind == _VALUES[version], version):
        hit = meant & left
        left &= ~hit
        if isinstance(other, bytes) and version == 3 and b"{X}" in other:      # a formula, in the place of the default
            numbers[hit] = conversion.convert(raw[hit])
        elif not other or (isinstance(other, bytes) and not other.strip(b"\0 ")):
            bare |= hit
        elif isinstance(other, bytes):
            text |= hit
        elif hit.any():
            numbers[hit], text[hit], bare[hit] = _converted(other, raw[hit])
    return numbers, text, bare


def _entries(conversion, raw, single, version):
    """(samples (sample,) that are meant, text or conversion of these) by the entries of a table, the default last.

    A range of floats ends before its upper end, unless no other one begins there.
    """
    blocks, ends = conversion.referenced_blocks or {}, []
    count = conversion.ref_param_nr - (not single) if version == 3 else conversion.val_param_nr // (2 - single)
    for i in range(count):
        other = conversion[f"text_{i}"] if single and version == 3 else blocks.get(f"text_{i}")
        if single:
            yield raw == conversion[f"param_val_{i}" if version == 3 else f"val_{i}"], other
            continue
        low, high = conversion[f"lower_{i}"], conversion[f"upper_{i}"]
        yield (raw >= low) & (raw < high), other
        ends.append((raw == high, other))
    yield from (*ends, (np.ones(len(raw), bool), blocks.get("default_addr")))


def _unit_beside(conversion):
    """Unit of the conversion that holds beside the texts of a partial one."""
    other = (getattr(conversion, "referenced_blocks", None) or {}).get("default_addr")
    return getattr(other, "unit", "") or ""

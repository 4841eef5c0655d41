"""Planted facts in TDMS files by npTDMS, and in MDF files by asammdf: starts, rates, units, scalings, gaps, sign."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from tests.fuzz.mutation import draw
from tests.fuzz.semantics.planted import Meant, column, cut, gaps, is_line
from tests.fuzz.trial import Trial

_T0 = np.datetime64("2026-03-02T10:20:30.250000", "us")
_RATES = (8.0, 50.0, 100.0, 256.0, 1000.0, 2048.0, 12800.0, 25600.0, 44100.0, 51200.0, 3333.0)
_TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
#: what a remark says of times without a unit
UNSTATED = "states no unit"


def written(write):
    """Bytes that ``write(path)`` leaves."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        write(path)
        return path.read_bytes()


def scaled(rng, one):
    """(Column as a converter of 16 bits has it, raw numbers, slope, intercept): a negative slope turns the sign."""
    span = np.ptp(one.numbers)
    slope = float(f"{span / 40000 * draw(rng, (1, -1)):.4g}")
    intercept = float(f"{one.numbers.mean():.4g}")
    raw = np.rint((one.numbers - intercept) / slope).astype("i2")
    numbers = slope * raw + intercept
    fit = np.polyfit(one.numbers, one.true, 1) if not one.asked else (1.0, 0.0)
    return replace(one, numbers=numbers, true=fit[0] * numbers + fit[1]), raw, slope, intercept


def _settings(kind, name, columns, rng, alone, runs):
    """Section of a case for {name in the file: Column}, {name of the channel: Column}."""
    file = {"kind": kind, "file": name, "runs": runs}
    if alone:
        return file, {plain(key): one for key, one in columns.items()}
    named = {f"c{k}": (key, one) for k, (key, one) in enumerate(columns.items())}
    file["columns"] = {k: one.stated(key, False) for k, (key, one) in named.items()}
    return file, {k: one for k, (_, one) in named.items()}


def plain(name):
    return name.replace("/", "_").replace(" ", "_")


def tdms(rng):
    """Groups of one file, each with its start, offset, rate and channels, or times beside them."""
    from nptdms import ChannelObject

    alone = bool(rng.random() < 0.5)
    objects, columns, clocks, starts = [], {}, {}, []
    told_rate = None if alone or rng.random() < 0.7 else float(draw(rng, _RATES))   # groups without any timing
    for g in range(int(rng.integers(1, 4))):
        count, rate = int(rng.integers(40, 300)), float(draw(rng, _RATES))
        start = None if rng.random() < 0.15 else _T0 + np.timedelta64(int(rng.integers(0, 4_000_000)), "us")
        starts.append(start)
        common = {} if start is None else {"wf_start_time": start}
        timed, offset = rng.random() < 0.3, float(draw(rng, (0.0, 0.0, 0.5, -0.25, 1.125)))
        if told_rate and rng.random() < 0.5:
            rate, begin, assumed = told_rate, 0.0, ()
        elif timed:
            made, begin, assumed = _times(rng, count, rate, f"bench{g}", common)
            objects.append(made)
        else:
            axis = draw(rng, ("", "s", "ms", "us"))
            size, assumed, begin = _TIMES[axis or "s"], (), offset
            common |= {"wf_increment": 1 / rate / size, "wf_start_offset": offset / size, "wf_samples": count}
            common |= {"wf_xunit_string": axis} if axis else {}
        for c in range(int(rng.integers(1, 4))):
            one = column(rng, count, not alone, (1.0,) if alone else (1.0, -1.0, 2.5))
            one, values, more = _stored(rng, one)
            name = f"bench{g}/ch{c}"
            objects.append(ChannelObject(f"bench{g}", f"ch{c}", values,
                                         properties=common | more | {"unit_string": one.label}))
            columns[name], clocks[name] = one, (rate, begin, start, assumed, values.dtype == np.float32)
    first = min((s for s in starts if s is not None), default=None)
    file, named = _settings("tdms", "a.tdms", columns, rng, alone, {"a": {}})
    meant = {}
    for (key, one), (rate, begin, start, assumed, single) in zip(named.items(), clocks.values(), strict=True):
        later = 0.0 if start is None else float((start - first) / np.timedelta64(1, "s"))
        meant[key] = one.planted(rate, begin + later, exact=1e-5 if single else 1e-6, assumed=assumed)
    file |= {"sample_rate": f"{told_rate!r} Hz"} if told_rate else {}
    file, meant = cut(rng, file, meant)
    return Trial("a.tdms", written(lambda path: _save(path, objects)), "starts, rates, units, scalings of TDMS",
                 {"files": [file]}, Meant({"a": meant}), _must(meant))


def _must(meant):
    return "either" if any(one.asked or one.assumed for one in meant.values()) else "read"


def _save(path, objects):
    from nptdms import TdmsWriter

    with TdmsWriter(str(path)) as writer:
        writer.write_segment(objects)


def _times(rng, count, rate, group, common):
    """(channel of times, begin in s, what may be assumed) of a group without an interval."""
    from nptdms import ChannelObject

    begin, unit = float(draw(rng, (0.0, 0.5, 2.0))), draw(rng, ("s", "ms", "us", "s"))
    how = draw(rng, ("unit", "unit", "name", "none"))
    name = draw(rng, ("Time", "time", "t", "Zeit")) + (f" [{unit}]" if how == "name" else "")
    times = (begin + np.arange(count) / rate) / _TIMES[unit]
    assumed = (("rate", UNSTATED), ("begin", UNSTATED)) if how == "none" and unit != "s" else ()
    return ChannelObject(group, name, times, properties=dict(common) | (
        {"unit_string": unit} if how == "unit" else {})), begin, assumed


def _stored(rng, one):
    """(Column, values as stored, properties) of a channel: floats, single floats, or integers with a scaling."""
    from nptdms.types import Uint32

    if rng.random() < 0.3 and is_line(one):
        one, raw, slope, intercept = scaled(rng, one)
        return one, raw, {"NI_Number_Of_Scales": 1, "NI_Scaling_Status": "unscaled", "NI_Scale[0]_Scale_Type": "Linear",
                          "NI_Scale[0]_Linear_Slope": slope, "NI_Scale[0]_Linear_Y_Intercept": intercept,
                          "NI_Scale[0]_Linear_Input_Source": Uint32(0xFFFFFFFF)}
    one = gaps(rng, one)[0] if rng.random() < 0.2 else one
    return one, one.numbers.astype(draw(rng, ("f8", "f8", "f4"))), {}


def mdf(rng):
    """Groups of one file, each on its clock: conversions, invalid samples, codes for texts, a bus that jitters."""
    import asammdf

    alone, version = bool(rng.random() < 0.5), draw(rng, ("4.10", "4.10", "4.20", "3.30"))
    groups, columns, clocks = [], {}, {}
    for g in range(int(rng.integers(1, 4))):
        count, rate = int(rng.integers(40, 200)), float(draw(rng, _RATES))
        begin = float(draw(rng, (0.0, 0.0, 1.0, 2.5, 0.125)))
        times, jitters = begin + np.arange(count) / rate, rng.random() < 0.2
        if jitters:
            times = np.concatenate([times[:1], times[1:] + rng.uniform(-0.2, 0.2, count - 1) / rate])
        signals = []
        for c in range(int(rng.integers(1, 4))):
            one = column(rng, count, not alone, (1.0,) if alone else (1.0, -1.0, 2.5), 0.0 if jitters else 0.06)
            if version == "3.30":       # asammdf leaves out what Latin 1 does not have
                one = replace(one, label=one.label.replace("\u03bc", "\u00b5"))
            if jitters and not is_line(one):
                one = replace(one, label="V", si="V", measured="voltage", true=one.factor * one.numbers)
            if jitters:     # a ramp: straight lines between its samples are right
                one = _ramp(rng, one, times)
            one, given, single = _raw(rng, one, version, jitters)
            signals.append(asammdf.Signal(timestamps=times, name=f"g{g}c{c}", unit=one.label, **given))
            columns[f"g{g}c{c}"], clocks[f"g{g}c{c}"] = one, (rate, times, jitters, single)
        groups.append(signals)
    file, named = _settings("mdf", "a.mf4", columns, rng, alone, {"a": {}})
    meant = {}
    for (key, one), (rate, times, jitters, single) in zip(named.items(), clocks.values(), strict=True):
        exact = 1e-5 if single else 1e-6
        jittered = {"times": times, "assumed": (("samples", "beside even ones"),)} if jitters else {}
        meant[key] = one.planted(rate, times[0], exact=exact, **jittered)
    file, meant = cut(rng, file, meant)
    return Trial("a.mf4", written(lambda path: _append(path, groups, version)), "clocks, conversions, gaps of MDF",
                 {"files": [file]}, Meant({"a": meant}), _must(meant))


def _append(path, groups, version):
    import asammdf

    with asammdf.MDF(version=version) as file:
        for signals in groups:
            file.append(signals)
        made = file.save(str(path.with_suffix(".mf4")), overwrite=True)
    Path(made).rename(path)


def _ramp(rng, one, times):
    fit = np.polyfit(one.numbers, one.true, 1)
    numbers = float(rng.uniform(-3, 3)) + float(draw(rng, (5.0, -4.0))) * (times - times[0])
    return replace(one, numbers=numbers, true=fit[0] * numbers + fit[1])


def _raw(rng, one, version, jitters):
    """(Column, fields of a Signal, whether in single precision) of a channel as a converter, or a bus, has it."""
    from asammdf.blocks.v4_blocks import ChannelConversion

    kind = draw(rng, ("plain", "plain", "single", "linear", "invalid", "texts", "rational"))
    kind = "plain" if jitters or (version == "3.30" and kind in ("invalid", "texts")) else kind
    kind = "plain" if kind in ("linear", "texts", "rational") and not is_line(one) else kind
    if kind == "rational":      # (P2 x + P3) / P6, as ASAP2 has it
        one, raw, slope, intercept = scaled(rng, one)
        return one, {"samples": raw, "conversion": {"P1": 0.0, "P2": slope, "P3": intercept, "P4": 0.0, "P5": 0.0,
                                                    "P6": 1.0}}, False
    if kind == "linear":
        one, raw, slope, intercept = scaled(rng, one)
        return one, {"samples": raw, "conversion": {"a": slope, "b": intercept}}, False
    if kind == "invalid":
        numbers = one.numbers
        one, lost = gaps(rng, one)
        return one, {"samples": numbers, "invalidation_bits": lost}, False
    if kind == "texts":
        one, raw, slope, intercept = scaled(rng, one)
        one, lost = gaps(rng, one)
        linear = ChannelConversion(conversion_type=1, a=slope, b=intercept)
        return one, {"samples": np.where(lost, 32767, raw).astype("i2"), "conversion": ChannelConversion(
            conversion_type=7, val_param_nr=1, ref_param_nr=2, val_0=32767, text_0=b"Error", links_nr=6,
            default_addr=linear)}, False
    return one, {"samples": one.numbers.astype("f4" if kind == "single" else "f8")}, kind == "single"


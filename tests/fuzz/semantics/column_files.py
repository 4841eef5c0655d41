"""Planted facts in text tables by csv and numpy.savetxt, and in MATLAB files by savemat: times, units, marks, gaps."""

import csv
import io
from dataclasses import replace

import numpy as np
from scipy.io import savemat

from tests.fuzz.mutation import draw
from tests.fuzz.semantics.planted import Meant, Planted, column, cut, gaps, is_line
from tests.fuzz.trial import Trial

_RATES = (10.0, 50.0, 100.0, 256.0, 1000.0, 2048.0, 12800.0, 25600.0, 44100.0, 51200.0)
_TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}
_WORDS = {"s": ("s", "sec", "Sekunden", "seconds"), "ms": ("ms", "msec", "milliseconds"), "us": ("us", "µs", "usec"),
          "min": ("min", "minutes")}
_GONE = ("", "NaN", "nan", "n/a", "#N/A", "---", "NA", "null")
#: what a remark says of times that nothing states the unit of
_UNSTATED = "states no unit: read in"
#: and of numbers whose mark may be one of thousands
_GROUPS = "thousands"


def _columns(rng, count):
    """{name in the file: Column}, some with gaps."""
    found = {}
    for k in range(int(rng.integers(1, 4))):
        one = column(rng, count)
        found[f"ch{k}"] = gaps(rng, one)[0] if rng.random() < 0.25 else one
    return found


def table(rng):
    """A text table: where its names, units and numbers stand, how its times are written, and what its head says."""
    rate, begin, count = float(draw(rng, _RATES)), float(draw(rng, (0.0, 0.0, 0.5, 2.0, -0.25))), int(
        rng.integers(60, 400))
    columns = _columns(rng, count)
    how = draw(rng, ("name", "name", "row", "setting", "head", "none", "rate", "stamps", "rate and times"))
    unit = draw(rng, ("s", "s", "ms", "us", "min"))
    spoken = _spoken(rng, columns, how, unit, rate, begin, count)
    content, given = _written(rng, columns, spoken)
    stated = {"kind": "table", "runs": {"a": {}}, "columns": {
        f"c{k}": one.stated(spoken["names"][key]) for k, (key, one) in enumerate(columns.items())}}
    meant = {f"c{k}": one.planted(rate, spoken["begin"], exact=1e-6, **spoken["open"])
             for k, one in enumerate(columns.values())}
    either = any(one.asked for one in columns.values()) or spoken["either"] or len(columns) + bool(spoken["times"]) < 2
    stated, meant = cut(rng, stated | given | spoken["given"], meant)
    return Trial("a.csv", content, f"table with times by {how}", {"files": [stated]},
                 Meant({"a": meant}), "either" if either else "read")


def _spoken(rng, columns, how, unit, rate, begin, count):
    """How the times of a table are told: texts of them, names, rows of the head, settings and what is left open."""
    names = {key: f"{key} [{one.label}]" if how != "row" and rng.random() < 0.5 and one.label.strip() else key
             for key, one in columns.items()}
    base = {"names": names, "row": None, "head": [], "given": {}, "open": {}, "begin": begin, "either": False}
    if how in ("rate", "head") and rng.random() < 0.5:
        head = [] if how == "rate" else [_said(rng, rate)]
        return base | {"times": None, "time": None, "begin": 0.0, "head": head, "given": (
            {} if how == "head" else {"sample_rate": f"{rate!r} Hz"})}
    instants = begin + np.arange(count) / rate
    if how == "stamps":
        return base | _stamps(rng, instants)
    digits = int(draw(rng, (15, 15, 9, 7)))
    text = [f"{t:.{digits}g}" for t in instants / _TIMES[unit]]
    rounded = np.array([float(t) for t in text]) * _TIMES[unit]
    off = float(np.abs(rounded - instants).max())
    open_ = {"instant": 2e-6 + off, "exact_rate": 1e-6 + 4 * off * rate / count}
    name = draw(rng, ("t", "time", "Zeit", "Time"))
    word = draw(rng, _WORDS[unit])
    made = base | {"times": text, "time": name, "open": open_, "given": {"time": name}, "either": digits < 15}
    if how == "name":
        name = draw(rng, (f"{name} [{word}]", f"{name} ({word})", f"{name}/{unit}", f"{name} in {unit}"))
        return made | {"time": name, "given": {"time": name}}
    if how == "row":
        return made | {"row": word}
    if how == "setting":
        return made | {"given": {"time": name, "time_unit": unit}}
    if how == "rate and times":     # which tells the unit
        return made | {"given": {"time": name, "sample_rate": f"{rate!r} Hz"}}
    if how == "head":
        return made | {"head": [_said(rng, rate)]}
    assumed = () if unit == "s" else (("rate", _UNSTATED), ("begin", _UNSTATED))
    return made | {"open": open_ | {"assumed": assumed}, "either": True}


def _said(rng, rate):
    """A line of a head that states the rate."""
    return draw(rng, ((f"Sample rate: {rate:g} Hz",), (f"Sampling frequency = {rate / 1e3:.12g} kHz",),
                      (f"Interval: {1 / rate!r} s",), (f"SampleRate: {rate!r}",)))[0].replace(
        "Interval", "Sample interval")


def _stamps(rng, instants):
    """Times of day, with a date or without, to a microsecond."""
    begin = np.datetime64("2026-03-29T23:59:58.500000", "us")
    clock = begin + np.rint(1e6 * (instants - instants[0])).astype("timedelta64[us]")
    form = draw(rng, ("iso", "german", "clock"))
    texts = [str(one) for one in clock]
    if form == "german":
        texts = [f"{t[8:10]}.{t[5:7]}.{t[:4]} {t[11:]}" for t in texts]
    elif form == "clock":
        texts = [t[11:] for t in texts]
    else:
        texts = [t.replace("T", draw(rng, ("T", " "))) for t in texts]
    step = 0.5e-6
    return {"times": texts, "time": "Timestamp", "given": {"time": "Timestamp"}, "begin": 0.0, "either": True,
            "open": {"instant": 1e-6 + 2 * step, "exact_rate": 1e-6 + 4 * step / (instants[-1] - instants[0])},
            "stamps": True}


def _written(rng, columns, spoken):
    """(bytes, settings) of a table."""
    comma = bool(rng.random() < 0.35)
    mark = draw(rng, (";", "\t", "|") if comma else (",", ";", "\t", "\t"))
    gone = draw(rng, _GONE)
    texts = [] if spoken["times"] is None else [spoken["times"]]
    form = draw(rng, ("{!r}", "{!r}", "{:.9e}", "{:+.9g}"))
    texts += [[gone if np.isnan(v) else form.format(float(v)) for v in one.numbers] for one in columns.values()]
    if comma:
        texts = [each if k == 0 and spoken.get("stamps") else [t.replace(".", ",") if t != gone else t for t in each]
                 for k, each in enumerate(texts)]
    names = [spoken["time"]] * (spoken["times"] is not None) + [spoken["names"][key] for key in columns]
    stream = io.StringIO()
    title = draw(rng, ([], [], ["Bench 3, stop 12"], ["Operator: A. B.", "", "Remarks: cold"]))
    for line in (*title, *spoken["head"]):
        stream.write(line + "\n")
    quoting = csv.QUOTE_ALL if rng.random() < 0.2 else csv.QUOTE_MINIMAL
    writer = csv.writer(stream, delimiter=mark, lineterminator=draw(rng, ("\n", "\r\n")), quoting=quoting)
    writer.writerow(names)
    given = {}
    if spoken["row"] is not None:
        row = [spoken["row"], *(one.label for one in columns.values())]
        row = [f"[{text}]" if text[:1] != "[" else text for text in row] if rng.random() < 0.5 else row
        writer.writerow(row)
        given = {"units_row": True} if any(one.asked for one in columns.values()) else {}
    if rng.random() < 0.2:
        stream.write("\n")
    writer.writerows(zip(*texts, strict=True))
    return _encoded(rng, stream.getvalue()), given


def _encoded(rng, text):
    encoding = draw(rng, ("utf-8", "utf-8", "utf-8-sig", "utf-16", "cp1252"))
    try:
        return text.encode(encoding)
    except UnicodeEncodeError:
        return text.encode("utf-8")


def plain_text(rng):
    """What numpy.savetxt writes, with and without names."""
    rate, count = float(draw(rng, _RATES)), int(rng.integers(60, 300))
    columns = _columns(rng, count)
    times, named = np.arange(count) / rate, bool(rng.random() < 0.7)
    stream, mark = io.StringIO(), draw(rng, (" ", ",", ";", "\t"))
    names = ["time", *columns]
    np.savetxt(stream, np.column_stack([times, *(one.numbers for one in columns.values())]), delimiter=mark,
               fmt=draw(rng, ("%.18e", "%.12g", "%.15f")), header=mark.join(names) if named else "",
               comments=draw(rng, ("# ", "", "% ", "#")) if named else "")
    called = names if named else [f"column {k + 1}" for k in range(len(names))]
    stated = {"kind": "table", "runs": {"a": {}}, "time": called[0], "columns": {
        f"c{k}": one.stated(called[k + 1]) for k, one in enumerate(columns.values())}}
    meant = {f"c{k}": one.planted(rate, 0.0) for k, one in enumerate(columns.values())}
    return Trial("a.txt", stream.getvalue().encode(), "numpy.savetxt", {"files": [stated]}, Meant({"a": meant}),
                 "either" if rate < 50 or any(one.asked for one in columns.values()) else "read")


def matlab(rng):
    """Vectors, columns of a matrix, or the structures of Testlab, with times in their unit, a rate, or an increment."""
    rate, begin, count = float(draw(rng, _RATES)), float(draw(rng, (0.0, 0.5, -0.25))), int(rng.integers(60, 300))
    columns, form = _columns(rng, count), draw(rng, ("4", "5", "5"))
    kind = draw(rng, ("vectors", "matrix", "testlab", "rate"))
    kind = "vectors" if form == "4" and kind == "testlab" else kind
    unit = draw(rng, ("s", "s", "ms", "us"))
    how = draw(rng, ("setting", "name", "none"))
    times, given, assumed = (begin + np.arange(count) / rate) / _TIMES[unit], {}, ()
    if how == "none" and unit != "s":
        assumed = (("rate", _UNSTATED), ("begin", _UNSTATED))
    name = f"t_{unit}" if how == "name" else "t"
    given = {"time_unit": unit} if how == "setting" else {}
    numbers = {key: one.numbers for key, one in columns.items()}
    called = {key: key for key in columns}
    if kind == "matrix":
        given, name = {"time_unit": unit}, "data(:,1)"
        assumed, variables = (), {"data": np.column_stack([times, *numbers.values()])}
        called = {key: f"data(:,{k + 2})" for k, key in enumerate(columns)}
    elif kind == "testlab":
        given, name, assumed = {}, None, ()
        variables = {f"S_{key}": {"x_values": {"start_value": begin, "increment": 1 / rate, "number_of_values": count},
                                  "y_values": {"values": values}} for key, values in numbers.items()}
        called = {key: f"S_{key}.y_values.values" for key in columns}
    elif kind == "rate":
        given, name, begin, assumed, variables = {"sample_rate": f"{rate!r} Hz"}, None, 0.0, (), numbers | {"fs": rate}
    else:
        variables = {name: times} | numbers
    if kind in ("vectors", "matrix") and rng.random() < 0.3:
        variables = {key: value[:, None] if value.ndim == 1 else value for key, value in variables.items()}
    stream = io.BytesIO()
    savemat(stream, variables, format=form, oned_as=draw(rng, ("row", "column")), do_compression=bool(
        form == "5" and rng.random() < 0.3))
    stated = {"kind": "matlab", "runs": {"a": {}}, "columns": {
        f"c{k}": one.stated(called[key]) for k, (key, one) in enumerate(columns.items())}} | given | (
        {"time": name} if name else {})
    meant = {f"c{k}": one.planted(rate, begin, assumed=assumed) for k, one in enumerate(columns.values())}
    either = assumed or any(one.asked for one in columns.values()) or (rate < 50 and kind != "rate")
    stated, meant = cut(rng, stated, meant)
    return Trial("a.mat", stream.getvalue(), f"MATLAB, {kind}", {"files": [stated]}, Meant({"a": meant}),
                 "either" if either else "read")




def grouped(rng):
    """Whole or long numbers whose thousands are set apart, by marks of which one may as well be a decimal mark."""
    count, rate = int(rng.integers(60, 200)), float(draw(rng, _RATES[2:]))
    numbers = np.round(rng.uniform(1000, 99999, count) * rng.choice([1.0, -1.0], count), int(draw(rng, (0, 0, 2, 3))))
    style, mark = draw(rng, (",.", ".,", " .", "',", ",_", "._")), draw(rng, (";", "\t"))
    whole = style[1] == "_"
    numbers = np.round(numbers) if whole else numbers
    texts = [f"{v:,.{0 if whole else 3}f}".replace(",", "@").replace(".", style[1]).replace("@", style[0].replace(
        " ", "\u00a0")) for v in numbers]
    unit, size = draw(rng, (("N", 1.0), ("bar", 1e5)))
    rows = [mark.join([f"{k}", text]) for k, text in enumerate(texts)]
    content = "\n".join([mark.join(["count", "load"]), *rows, ""]).encode()
    stated = {"kind": "table", "runs": {"a": {}}, "sample_rate": f"{rate!r} Hz", "columns": {
        "load": {"column": "load", "unit": unit, "measures": "force" if unit == "N" else "pressure"}}}
    meant = {"load": Planted(size * numbers, unit.replace("bar", "Pa"), rate, assumed=(("samples", _GROUPS),))}
    return Trial("a.csv", content, f"thousands as {style!r}", {"files": [stated]}, Meant({"a": meant}))


def lost(rng):
    """Rows that are not there: gaps where the rate is stated, else refused; a few equal instants are refused."""
    count, rate, begin = int(rng.integers(60, 200)), float(draw(rng, _RATES[2:6])), float(draw(rng, (0.0, 0.5)))
    one = column(rng, count, bad=0.0)
    one = one if is_line(one) else column(np.random.default_rng(1), count, bad=0.0)
    gone = np.unique(int(rng.integers(1, count - 12)) + rng.choice([0, 3, 4, 5, 6, 10], int(rng.integers(1, 6))))
    instants, digits = begin + np.arange(count) / rate, int(draw(rng, (6, 9, 12)))
    kept = np.setdiff1d(np.arange(count), gone)
    rows = [f"{instants[k]:.{digits}f},{float(one.numbers[k])!r}" for k in kept]
    stated = {"kind": "table", "runs": {"a": {}}, "time": "time [s]", "columns": {"x": one.stated("x")}}
    how = draw(rng, ("rate", "resample", "nothing"))
    stated |= {} if how == "nothing" else {"sample_rate" if how == "rate" else how: f"{rate!r} Hz"}
    true = np.where(np.isin(np.arange(count), gone), np.nan, one.true)
    planted = Planted(true, one.si, rate, begin, instant=2e-6 + 10.0**-digits)
    if how == "resample":
        planted = replace(planted, samples=_joined(true, one), exact=1e-3 if digits < 9 else 1e-5)
    return Trial("a.csv", "\n".join(["time [s],x", *rows, ""]).encode(), f"rows lost, {how}", {"files": [stated]},
                 Meant({"a": {"x": planted}}), "refuse" if how == "nothing" else "either")


def _joined(true, one):
    """Straight lines across gaps of up to three intervals."""
    there = np.flatnonzero(np.isfinite(true))
    numbers = np.interp(np.arange(len(true)), there, one.numbers[there])
    whole = np.polyval(np.polyfit(one.numbers, one.true, 1), numbers)
    for k in np.flatnonzero(np.diff(there) > 3):
        whole[there[k] + 1:there[k + 1]] = np.nan
    return whole


def labview(rng):
    """A LabVIEW measurement (.lvm) with X0, Delta_X and units in its head, after NI's specification."""
    rate, begin, count = float(draw(rng, (50.0, 100.0, 256.0, 1000.0, 12800.0, 51200.0))), float(
        draw(rng, (0.0, 0.5, -0.25))), int(rng.integers(60, 200))
    columns, decimal, kind = _columns(rng, count), draw(rng, (".", ",")), draw(rng, ("One", "No", "Multi"))
    columns = {key: one for key, one in columns.items() if np.isfinite(one.numbers).all()} or {
        "ch0": column(rng, count, bad=0.0)}
    head = ["LabVIEW Measurement", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab",
            f"Decimal_Separator\t{decimal}", "Multi_Headings\tNo", f"X_Columns\t{kind}", "Time_Pref\tRelative",
            "Date\t2026/03/02", "Time\t10:20:30,25", "***End_of_Header***\t", "\t"]
    apart = rng.random() < 0.4      # each channel with its own begin and interval
    clocks = [(begin + apart * k * 0.25, rate / (1 + apart * (k % 2))) for k in range(len(columns))]
    fields = {"Channels": [str(len(columns))], "Samples": [str(count)] * len(columns),
              "Date": ["2026/03/02"] * len(columns), "Y_Unit_Label": [one.label for one in columns.values()],
              "X_Dimension": ["Time"] * len(columns), "X0": [f"{first:.16E}" for first, _ in clocks],
              "Delta_X": [f"{1 / each:.16E}" for _, each in clocks]}
    head += ["\t".join([key, *(v.replace(".", decimal) if key in ("X0", "Delta_X") else v for v in values)])
             for key, values in fields.items()] + ["***End_of_Header***\t"]
    names, rows = [], [[] for _ in range(count)]
    for k, ((key, one), (first, each)) in enumerate(zip(columns.items(), clocks, strict=True)):
        timed = kind == "Multi" or k == 0
        names += ["X_Value"] * timed + [key]
        for n in range(count):
            instant = "" if kind == "No" else f"{first + n / each:.9f}".replace(".", decimal)
            rows[n] += [instant] * timed + [repr(float(one.numbers[n])).replace(".", decimal)]
    lines = [*head, "\t".join([*names, "Comment"]), *("\t".join([*row, ""]) for row in rows), ""]
    files, must = _sections(rng, columns, apart and len(columns) > 1, kind)
    meant = {f"c{k}": one.planted(*clock[::-1], instant=2e-6, exact_rate=1e-5)
             for k, (one, clock) in enumerate(zip(columns.values(), clocks, strict=True))}
    return Trial("a.lvm", "\n".join(lines).encode(), f"LabVIEW measurement, {kind}", {"files": files},
                 Meant({"a": meant}), "either" if any(one.asked for one in columns.values()) else must)


def _sections(rng, columns, apart, kind):
    """(sections of a case, whether they must be read or refused) of a LabVIEW measurement: one of all channels, or,
    where these are ``apart``, one for each."""
    stated = {"kind": "table", "runs": {"a": {}}}
    named = {f"c{k}": one.stated(key) for k, (key, one) in enumerate(columns.items())}
    if not apart:
        timed = rng.random() < 0.6
        return [stated | {"columns": named} | ({"time": "X_Value"} if timed else {})], "read"
    if kind == "Multi" and rng.random() < 0.6:
        return [stated | {"columns": {key: one}, "time": f"X_Value ({k + 1})"} | ({"offset": "0 s"} if k else {})
                for k, (key, one) in enumerate(named.items())], "read"
    time = draw(rng, ({}, {"time": "X_Value (1)" if kind == "Multi" else "X_Value"}))
    return [stated | {"columns": named} | time], "refuse"

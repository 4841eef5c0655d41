"""Text tables, friction tables and time signals of SEP 005."""

import json

import numpy as np

from pipeline.contract.settings import fill
from pipeline.recordings.runs.imported import Imported
from pipeline.recordings.sep005 import run_of
from stages import recording
from tests.fuzz.documents import reshaped
from tests.fuzz.mutation import draw, garbled
from tests.fuzz.targets import plain
from tests.fuzz.trial import Target, Trial, difference

RATE, COUNT = 2000.0, 24
TIME = np.arange(COUNT) / RATE
FORCE = np.round(40.0 + 12.5 * np.sin(0.7 * np.arange(COUNT)), 6)
MOVED = np.round(1e-3 * np.cos(0.3 * np.arange(COUNT)), 9)
#: unit of the file -> size of it in SI
FORCES, LENGTHS = {"N": 1.0, "kN": 1e3, "mN": 1e-3}, {"m": 1.0, "mm": 1e-3, "um": 1e-6}
SETTINGS = {
    "time": "time",
    "runs": {"a": {}},
    "columns": {
        "force": {"column": "force", "unit": "N", "measures": "force"},
        "moved": {"column": "moved", "unit": "m", "measures": "displacement"},
    },
}
EXPECTED = {
    "a": plain.run(
        {
            "force": plain.channel(FORCE, "N", RATE, measures="force"),
            "moved": plain.channel(MOVED, "m", RATE, measures="displacement"),
        }
    )
}


def read(path, section=recording.Table, **given):
    """Plain values of the runs that the stage makes of a file."""
    settings = fill(section, {"file": str(path), **given}, "case.yaml: recording.files.0")
    return plain.of_runs(recording.READ[settings.kind](settings, Imported(False, lambda text: None)))


def right(expected=EXPECTED, tolerance=1e-6):
    """The check that plain values are the ``expected`` ones."""
    return lambda value: difference(value, expected, tolerance)


def table(columns, mark=",", end="\n", form="{!r}", last=True):
    """Bytes of a text table."""
    rows = [mark.join(form.format(float(v)) for v in row) for row in zip(*columns.values(), strict=True)]
    return (end.join([mark.join(columns), *rows]) + end * last).encode()


def named(values):
    """Of changed settings, what a call can pass on."""
    return (
        {key: value for key, value in values.items() if isinstance(key, str) and key not in ("file", "path")}
        if isinstance(values, dict)
        else {}
    )


def whole():
    return {"time": TIME, "force": FORCE, "moved": MOVED}


def _damaged(rng):
    mark = draw(rng, ",;\t")
    given = draw(
        rng,
        (
            SETTINGS,
            {**SETTINGS, "time": None, "sample_rate": "2 kHz"},
            {**SETTINGS, "delimiter": mark},
            {**SETTINGS, "sample_rate": "2 kHz"},
            {**SETTINGS, "skip": int(rng.integers(4))},
        ),
    )
    return Trial("a.csv", garbled(rng, table(whole(), mark, draw(rng, ("\n", "\r\n")))), given=given)


def _arranged(rng):
    """Columns in another order, others beside them, another separator, line break, mark of the encoding, or form."""
    mark, names = draw(rng, ",;\t"), list(rng.permutation(["time", "force", "moved", "other"]))
    columns = {name: whole().get(name, rng.normal(size=COUNT)) for name in names}
    content = table(
        columns, mark, draw(rng, ("\n", "\r\n", "\r")), draw(rng, ("{!r}", "{:.12e}", " {:.15g} ", "{:+.15f}"))
    )
    if rng.random() < 0.3:
        content = content.replace(b"force", b'"force"')
    return Trial(
        "a.csv", draw(rng, (b"", b"\xef\xbb\xbf")) + content, "table arranged otherwise", SETTINGS, right(), "read"
    )


def _scaled(rng):
    """The same record in other units, with a factor, lines before the head and a rate instead of times."""
    force, length = draw(rng, list(FORCES)), draw(rng, list(LENGTHS))
    factor, skip = float(draw(rng, (1.0, -1.0, 10.0, 0.25))), int(rng.integers(4))
    columns = {"moved": MOVED / LENGTHS[length], "force": FORCE / FORCES[force] / factor}
    given = {
        "sample_rate": draw(rng, ("2 kHz", "2000 Hz", "2000 1/s")),
        "skip": skip,
        "runs": {"a": {}},
        "columns": {
            "force": {"column": "force", "unit": force, "measures": "force", "factor": factor},
            "moved": {"column": "moved", "unit": length, "measures": "displacement"},
        },
    }
    return Trial("a.csv", b"# bench, 2 bar\n" * skip + table(columns), "other units", given, right(), "read")


def _cut(rng):
    """Cut off: refused, or a record that ends earlier, whose samples are right."""
    content = table(whole(), form="{:.9f}")
    return Trial("a.csv", content[: int(rng.integers(len(content)))], "cut off", SETTINGS, _begins)


def _begins(value):
    channels = value["a"]["channels"]
    return next(
        (
            text
            for name, wanted in (("force", FORCE), ("moved", MOVED))
            if (text := difference(channels[name]["samples"], wanted[: len(channels[name]["samples"])], 1e-6, name))
        ),
        "",
    )


def _comma(rng):
    """Decimal commas between semicolons."""
    content = table(whole(), ";", form="{:.15f}").replace(b".", b",")
    return Trial("a.csv", content, "decimal commas", SETTINGS, right(), "read")


def _lost(rng):
    """Lines lost from a record with times: marked as missing, or refused as uneven."""
    lines = table(whole()).split(b"\n")
    gone = int(rng.integers(2, COUNT - 1))
    wanted = {
        "a": plain.run(
            {
                name: plain.channel(np.where(np.arange(COUNT) == gone, np.nan, values), unit, RATE, measures=measures)
                for name, values, unit, measures in (
                    ("force", FORCE, "N", "force"),
                    ("moved", MOVED, "m", "displacement"),
                )
            }
        )
    }
    rate = rng.random() < 0.5
    given = {**SETTINGS, "sample_rate": "2 kHz"} if rate else SETTINGS
    return Trial(
        "a.csv",
        b"\n".join(lines[: gone + 1] + lines[gone + 2 :]),
        "a line lost",
        given,
        right(wanted),
        "read" if rate else "refuse",
    )


FRICTION = {
    "mu": np.linspace(0.3, 0.45, 8),
    "p": np.linspace(1, 4, 8),
    "v": np.linspace(0.5, 9, 8),
    "t": np.linspace(40, 300, 8),
}
ROWS = {
    "run": "a",
    "columns": {
        "friction": {"column": "mu"},
        "pressure": {"column": "p", "unit": "MPa"},
        "speed": {"column": "v", "unit": "m/s"},
        "temperature": {"column": "t", "unit": "degC"},
    },
}
MAP = {
    "table": {
        "friction": FRICTION["mu"],
        "pressure": 1e6 * FRICTION["p"],
        "speed": FRICTION["v"],
        "temperature": FRICTION["t"] + 273.15,
    }
}


def _friction(path, **given):
    return read(path, recording.FrictionTable, **given)


def _friction_damaged(rng):
    given = ROWS if rng.random() < 0.6 else named(reshaped(rng, ROWS))
    return Trial("f.csv", garbled(rng, table(FRICTION, draw(rng, ",;\t"))), given=given)


def _friction_scaled(rng):
    pressure, speed = draw(rng, (("bar", 10.0), ("Pa", 1e6), ("kPa", 1e3))), draw(rng, (("km/h", 3.6), ("mm/s", 1e3)))
    columns = {
        "p": FRICTION["p"] * pressure[1],
        "t": FRICTION["t"] + 273.15,
        "mu": FRICTION["mu"] * 100,
        "v": FRICTION["v"] * speed[1],
    }
    units = {
        "friction": ("mu", "%"),
        "pressure": ("p", pressure[0]),
        "speed": ("v", speed[0]),
        "temperature": ("t", "K"),
    }
    given = {"run": "a", "columns": {name: {"column": c, "unit": u} for name, (c, u) in units.items()}}
    return Trial("f.csv", table(columns), "other units", given, right({"a": plain.run({}, friction=MAP)}), "read")


def _signals(path):
    return plain.of_runs({"a": run_of(json.loads(path.read_bytes()))})


SIGNALS = [
    {"name": "force", "data": FORCE.tolist(), "unit_str": "N", "fs": RATE, "quantity": "force"},
    {"name": "moved", "data": MOVED.tolist(), "unit_str": "m", "time": TIME.tolist(), "quantity": "displacement"},
]


def _signals_damaged(rng):
    return Trial("s.json", json.dumps(reshaped(rng, SIGNALS), default=str).encode())


def _signals_scaled(rng):
    force, length = draw(rng, list(FORCES)), draw(rng, list(LENGTHS))
    signals = [
        {**SIGNALS[1], "data": (MOVED / LENGTHS[length]).tolist(), "unit_str": length},
        {**SIGNALS[0], "data": (FORCE / FORCES[force]).tolist(), "unit_str": force},
    ]
    return Trial("s.json", json.dumps(signals).encode(), "other units", {}, right(), "read")


TARGETS = (
    Target("table", read, _damaged, (_arranged, _scaled, _cut, _comma, _lost)),
    Target("friction", _friction, _friction_damaged, (_friction_scaled,)),
    Target("sep005", _signals, _signals_damaged, (_signals_scaled,)),
)

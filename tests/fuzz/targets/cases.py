"""Cases, overrides, published facts, schedules of brake applications, and quantities."""

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import yaml

import stages
from pipeline.case_models.noise_matrix import schedule
from pipeline.contract import case, documents, units
from pipeline.contract.settings import ORIGINS
from pipeline.validation import published_facts
from tests.fuzz.documents import reshaped
from tests.fuzz.mutation import EXTREMES, draw, garbled
from tests.fuzz.trial import Target, Trial, difference

ROOT = Path(__file__).parents[3]
_CASES = (
    "belt",
    "two_mode_flutter",
    "pin_on_disc",
    "beam_on_beam",
    "bimaterial_rupture_quick",
    "brake_matrices",
    "disc_brake_quick",
    "disc_brake",
    "emps_recording",
    "disc_brake_bench",
    "worn_pad",
    "pin_on_disc_lines",
    "disc_brake_matrix",
    "tribometer_map",
    "silverbox",
    "wobbling_disc",
    "disc_table1",
    "beam_geometry",
)


def _nowhere(name):
    """Public recordings are not asked for."""
    raise KeyError(f"{name} is not registered")


@cache
def _text(name):
    """The text of a case, whose base and files are found from anywhere."""
    text = (ROOT / "configs" / f"{name}.yaml").read_text()
    return re.sub(
        r"(based_on: |file: )(?=[\w]+\.\w+)", rf"\1{ROOT}/configs/", text.replace("../data/", f"{ROOT}/data/")
    )


@cache
def _document(name):
    return documents._loaded(_text(name), name)


def _loaded(path, overrides=()):
    found = case.load(path, stages.CHAINS, stages.load, overrides, _nowhere)
    return {name: _values(section) for name, section in found.sections.items()}


def _values(section):
    """The settings of a section as plain values, files by their names."""
    return json.loads(json.dumps(section.model_dump(), default=lambda v: getattr(v, "name", str(v))))


def _case_damaged(rng):
    name = draw(rng, _CASES)
    if rng.random() < 0.3:
        return Trial("c.yaml", garbled(rng, _text(name).encode()))
    return Trial("c.yaml", _dumped(reshaped(rng, _document(name))))


def _dumped(document):
    try:
        return yaml.dump(documents._plain(document), sort_keys=False, allow_unicode=True).encode("utf-8", "replace")
    except (yaml.YAMLError, TypeError, ValueError):  # keys that the library cannot write
        return repr(document).encode("utf-8", "replace")


def _overridden(rng):
    name = draw(rng, ("belt", "two_mode_flutter", "beam_on_beam"))
    places = [*_paths(_document(name))]
    steps = [str(s) for s in draw(rng, places)]
    if rng.random() < 0.3:
        steps[int(rng.integers(len(steps)))] = draw(rng, ("", "0", "x", "-1", "value", "99", "a b", "é"))
    value = draw(
        rng,
        (
            *EXTREMES,
            "{}",
            "[]",
            "null",
            "3 mm",
            "-1 kg",
            "{a: 1}",
            "[1, 2",
            "!!python/none",
            "&a [*a]",
            "'",
            ":",
            "2026-11-27",
            "block.x",
            "{value: 3 N, origin: stated}",
            "*x",
            "- - 1",
            "? x",
            "\t",
            "%x",
        ),
    )
    return Trial("c.yaml", _text(name).encode(), "override", {"overrides": (f"{'.'.join(steps)}={value}",)})


def _paths(node, steps=()):
    for key in list(node) if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ():
        yield (*steps, key)
        yield from _paths(node[key], (*steps, key))


@cache
def _right(name):
    """The settings of a case as it stands, once loaded for all trials."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "c.yaml"
        path.write_text(_text(name))
        return _loaded(path)


_KNOWN = ("belt", "two_mode_flutter", "pin_on_disc", "beam_on_beam", "bimaterial_rupture_quick", "disc_brake")


def _same_case(rng):
    """Keys in another order, quantities in other units, values with an origin, comments, another style."""
    name = draw(rng, _KNOWN)
    document = _rewritten(rng, _document(name))
    content = yaml.dump(
        _shuffled(rng, documents._plain(document)),
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=draw(rng, (None, False, True)),
        width=int(draw(rng, (60, 10000))),
    ).encode()
    return Trial(
        "c.yaml",
        draw(rng, (b"", b"# a comment\n", b"---\n", b"\n\n")) + content,
        "case written otherwise",
        {},
        lambda value: difference(value, _right(name), 1e-9),
        "read",
    )


def _shuffled(rng, node):
    if isinstance(node, dict):
        keys = list(node)
        ordered = keys if _ordered(node) else [keys[k] for k in rng.permutation(len(keys))]
        return {key: _shuffled(rng, node[key]) for key in ordered}
    return [_shuffled(rng, each) for each in node] if isinstance(node, list) else node


def _ordered(node):
    """Mappings of names that the user gives keep their order, which is that of rows and coordinates."""
    return all(isinstance(value, dict) for value in node.values())


#: unit as cases have it -> others and their sizes in it
_ALIKE = {
    "mm": (("m", 1e-3), ("um", 1e3), ("cm", 0.1)),
    "m": (("mm", 1e3), ("km", 1e-3)),
    "GPa": (("Pa", 1e9), ("MPa", 1e3)),
    "MPa": (("Pa", 1e6), ("bar", 10.0)),
    "kHz": (("Hz", 1e3),),
    "Hz": (("kHz", 1e-3),),
    "s": (("ms", 1e3),),
    "ms": (("s", 1e-3),),
    "N": (("kN", 1e-3),),
    "kg": (("g", 1e3),),
    "m/s": (("km/h", 3.6), ("mm/s", 1e3)),
    "rpm": (("rad/s", np.pi / 30),),
    "um": (("m", 1e-6), ("nm", 1e3)),
    "N/m": (("kN/mm", 1e-6),),
}


def _rewritten(rng, node, key=""):
    if isinstance(node, dict):
        return {k: _rewritten(rng, value, k) for k, value in node.items()}
    if isinstance(node, list):
        return [_rewritten(rng, value) for value in node]
    number, _, unit = node.partition(" ") if isinstance(node, str) else ("", "", "")
    if (
        unit not in _ALIKE
        or key in ("column", "source", "description", "title")
        or not re.fullmatch(r"-?\d+\.?\d*(e-?\d+)?", number)
        or rng.random() < 0.5
    ):
        return node
    other, size = draw(rng, _ALIKE[unit])
    node = f"{float(number) * size!r} {other}"
    if rng.random() < 0.2 and key not in ("value", ""):
        return {"value": node, "origin": draw(rng, ORIGINS), "source": "so"}
    return node


def _facts(path):
    return [(f.key, f.value, f.unit, f.tolerance) for f in published_facts.load(path)]


def _facts_damaged(rng):
    path = draw(rng, sorted((ROOT / "data" / "reference").glob("*.yaml")))
    document = documents.read_yaml(path)
    short = document[: int(rng.integers(1, 6))] if isinstance(document, list) else document
    return Trial("f.yaml", _dumped(reshaped(rng, short)) if rng.random() < 0.7 else garbled(rng, _dumped(short)))


def _scheduled(path):
    found = schedule.schedule(path)
    return len(found.conditions)


def _schedule_damaged(rng):
    path = draw(rng, sorted((ROOT / "pipeline" / "case_models" / "noise_matrix").glob("*.yaml")))
    document = documents.read_yaml(path)
    return Trial("s.yaml", _dumped(reshaped(rng, document)) if rng.random() < 0.7 else garbled(rng, path.read_bytes()))


_ATOMS = (
    "m",
    "mm",
    "km",
    "um",
    "s",
    "ms",
    "kg",
    "g",
    "N",
    "kN",
    "Pa",
    "MPa",
    "bar",
    "Hz",
    "kHz",
    "rad",
    "deg",
    "rpm",
    "K",
    "degC",
    "°C",
    "J",
    "W",
    "V",
    "A",
    "%",
    "dB",
    "min",
    "h",
    "l",
    "inch",
    "ft",
    "lbf",
    "psi",
    "U/min",
    "g_0",
    "1",
    "N m",
    "m/s",
    "m/s²",
    "mm^2",
    "µm",
    "Ω",
    "count",
    "rev",
    "turn",
    "degrees",
    "year",
    "ly",
    "Mpc",
    "eV",
)
_JOINTS = (
    " ",
    "*",
    "/",
    "**",
    "^",
    "·",
    "(",
    ")",
    "^-1",
    "²",
    "⁻¹",
    " / ",
    "**2",
    "^0.5",
    "^(1/2)",
    "^9",
    "e",
    ",",
    "±",
    "  ",
)
_IN_SI = tuple(sorted(units.SI))


def _unit_text(rng):
    parts = [draw(rng, _ATOMS) if rng.random() < 0.6 else draw(rng, _JOINTS) for _ in range(int(rng.integers(1, 9)))]
    text = "".join(parts) if rng.random() < 0.5 else draw(rng, ("/", " ", "*")).join(parts[:3])
    return (
        text
        if rng.random() < 0.8
        else text + draw(rng, ("\0", "__class__", ".real", "lambda: 1", "x" * 200, "[0]", "'", "{}"))
    )


def _quantity(path, kind, text, unit):
    value = {
        "setting": lambda: units.to_si(text, unit, "x"),
        "channel": lambda: units.in_si(np.ones(2), text, "x")[0],
        "measured": lambda: units.in_si(1.0, text, "x", "acceleration")[0],
        "quotient": lambda: units.quotient_in_si(1.0, text, "x")[0],
        "named": lambda: units.measured_in(text, "x"),
    }[kind]()
    if kind == "setting" and not (isinstance(value, float) and np.isfinite(value)):
        raise ValueError(f"{value!r} of {text!r}")
    return value


def _quantity_damaged(rng):
    kind = draw(rng, ("setting", "setting", "setting", "channel", "measured", "quotient", "named"))
    text = _unit_text(rng)
    if kind == "setting":
        number = draw(rng, (*EXTREMES, "12", "0.3", "-4.5e-3", "1e+3", " 3", "+7", ".5", "5."))
        text = number + draw(rng, (" ", "", "  ", "\t", "*")) + text
    return Trial("q", b"", f"quantity {text[:80]!r} in {kind}", {"kind": kind, "text": text, "unit": draw(rng, _IN_SI)})


_EXACT = {
    "m": {"mm": 1e-3, "km": 1e3, "um": 1e-6, "cm": 1e-2, "nm": 1e-9, "inch": 0.0254, "m": 1.0},
    "N/m": {"N/mm": 1e3, "kN/mm": 1e6, "N/um": 1e6, "MN/m": 1e6, "kN/m": 1e3},
    "rad/s": {"rpm": np.pi / 30, "deg/s": np.pi / 180, "U/min": np.pi / 30, "rad/s": 1.0, "turn/s": 2 * np.pi},
    "Pa": {"MPa": 1e6, "bar": 1e5, "GPa": 1e9, "N/mm^2": 1e6, "kPa": 1e3, "N/m²": 1.0},
    "kg": {"g": 1e-3, "kg": 1.0, "mg": 1e-6},
    "m/s^2": {"g": 9.80665, "mm/s^2": 1e-3, "m/s²": 1.0, "mg": 9.80665e-3},
    "m/s": {"km/h": 1 / 3.6, "mm/s": 1e-3, "m/min": 1 / 60},
    "1": {"%": 0.01, "": 1.0},
    "J/K/kg": {"J/kg/K": 1.0, "kJ/(kg K)": 1e3},
    "N s/m": {"N*s/mm": 1e3, "kg/s": 1.0, "N s/m": 1.0},
    "m^2/N": {"mm^2/N": 1e-6, "1/Pa": 1.0, "um^2/N": 1e-12},
    "s": {"ms": 1e-3, "min": 60.0, "h": 3600.0},
}


def _quantity_known(rng):
    unit = draw(rng, list(_EXACT))
    text, size = draw(rng, list(_EXACT[unit].items()))
    number = float(np.round(rng.normal() * 10.0 ** rng.integers(-6, 7), 9))
    spelt = draw(rng, (f"{number!r}", f"{number:.12e}", f"{number:+.15g}"))
    return Trial(
        "q",
        b"",
        f"quantity {spelt} {text} in {unit}",
        {"kind": "setting", "text": f"{spelt} {text}".strip(), "unit": unit},
        lambda value: difference(value, float(spelt) * size, 1e-11),
        "read",
    )


TARGETS = (
    Target(
        "case",
        _loaded,
        lambda rng: (_case_damaged if rng.random() < 0.7 else _overridden)(rng),
        (_same_case,),
        share=0.1,
    ),
    Target("facts", _facts, _facts_damaged),
    Target("schedule", _scheduled, _schedule_damaged),
    Target("quantity", _quantity, _quantity_damaged, (_quantity_known,)),
)

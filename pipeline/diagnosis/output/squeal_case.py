"""The case that asks whether the diagnosed rig squeals, how likely, and what helps: its values as fitted, its effects.

Values that the diagnosis corrected are written where the case states them, each with its origin; what it found them
uncertain by is what scatters. What such a case cannot state is listed in its description.
"""

import copy

import numpy as np

from pipeline.contract import documents as yaml
from pipeline.contract.units import to_si
from pipeline.diagnosis.output.files import completed, completed_name

#: chain of the case, and sections that ask what was recorded
CHAIN, _ASKED = "lumped_brake", ("recording", "bench", "diagnosis")
#: closing speed of a contact damping that is none, and band where the bench states none
_UNDAMPED, _HIGHEST = "1e9 m/s", "10 kHz"
#: share by which the inputs of a run may differ from one multiple of the constant ones
_ALIKE = 1e-3
#: powers of the factor on a body that its own springs and its mass take: stiffness, damping, mass
_OF_BODY = {"frequency": (2, 0, 0), "stiffness": (1, 0, 0), "damping": (0, 1, 0), "mass": (0, 0, 1),
            "modal_mass": (1, 1, 1)}
_SOLID = {"stiffness": "N/m", "damping": "N s/m", "torsional_stiffness": "N m/rad", "torsional_damping": "N m s/rad"}


def companions(product, case):
    """{file name: text} of the case; none where the diagnosis completes none, or no run slid in contact."""
    if case is None or not completed_name(product, case.name) or not _slid(product, case.document):
        return {}
    return {f"{case.name}_squeal.yaml": yaml.yaml_text(squeal_case(product, case))}


def _slid(product, document):
    """(loads (l,) over the constant inputs, speeds (v,) rad/s) of the runs that slid under a load; None without any."""
    lumped = document.get("lumped") or {}
    given = {name: part for name, part in (lumped.get("inputs") or {}).items() if "force" in part}
    if document.get("chain") != "lumped_bench" or not given or not any(
            "normal" in contact for contact in (lumped.get("contacts") or {}).values()):
        return None
    constant, points = {name: to_si(_plain(part["force"]), "N", name) for name, part in given.items()}, []
    for run in product.runs.values():
        stated = dict(zip(map(str, run.condition), map(float, run.condition_value), strict=True))
        loads = [stated[name] / force for name, force in constant.items() if name in stated and force]
        alike = len(loads) == len(constant) and min(loads) > 0 and np.ptp(loads) <= _ALIKE * loads[0]
        if stated.get("speed") and alike:
            points.append((loads[0], abs(stated["speed"])))
    return tuple(np.unique(np.round(each, 9)) for each in zip(*points, strict=True)) if points else None


def squeal_case(product, case):
    """The document of the case."""
    loads, speeds = _slid(product, case.document)
    whole = completed(product, case)
    bench, corrections = whole.get("bench") or {}, (whole.get("bench") or {}).get("corrections") or {}
    document = {key: part for key, part in whole.items() if key not in _ASKED}
    writer = _Writer(document["lumped"], f"diagnosis of {case.name}")
    std = {str(name): float(each) for name, each in zip(product.parameter, product.parameter_std, strict=True)}
    for name, value in corrections.items():
        writer.apply(str(name), _number(_plain(value)), std.get(str(name), 0.0))
    friction = float(_plain(bench.get("friction", 0.0)))
    document["chain"], document["title"] = CHAIN, f"{case.document.get('title', case.name)}, completed"
    document["lumped"]["load_factors"] = [f"{float(load)!r} Pa" for load in loads]
    document["complex_modes"] = {
        "speeds": [f"{float(speed)!r} rad/s" for speed in speeds], "friction": writer.stated(
            friction * writer.friction, "1") if writer.friction != 1 else friction,
        "friction_damping": False, "damping_speed": _UNDAMPED,
        "frequency_max": _plain((bench.get("poles") or {}).get("high", _HIGHEST))}
    document["probability"] = {"sources": writer.sources(friction)}
    document["description"] = (
        f"The brake of {case.name} as its recordings were explained: does it squeal, how likely is that with what the"
        " diagnosis leaves uncertain of its values, what moves it? State countermeasures.variants to compare some."
        + (f" Not expressed here: {'; '.join(writer.left)}." if writer.left else ""))
    return document


class _Writer:
    """Writes corrected values into a section ``lumped``, each with its ``source``; lists what is ``left`` out."""

    def __init__(self, lumped, source):
        self.lumped, self.source, self.left = lumped, source, []
        self.friction, self._spread = 1.0, {}

    def apply(self, name, value, std):
        """One corrected number, as ``case_models.corrections`` has it, and its standard deviation."""
        kind, _, rest = name.partition(".")
        owner, _, what = rest.rpartition(".")
        springs = self.lumped.get("springs") or {}
        if name == "friction":
            self.friction, self._spread["friction", None] = value, std
        elif kind == "joints" and owner in springs:
            self._spring(springs[owner], what, value, False)
            self._scatters("joint_stiffness" if what == "stiffness" else "joint_loss", owner, std / value)
        elif kind == "bodies" and what in _OF_BODY:
            self._body(owner, what, value, std / value)
        elif name == "contact.stiffness":
            for contact in self.lumped["contacts"].values():
                if "stiffness" in contact:      # areas stay those of the bench, which effects read pressures by
                    given = to_si(_plain(contact["stiffness"]), "N/m", "stiffness")
                    contact.setdefault("area", f"{given!r} m^2")
                    contact["stiffness"] = self._scaled(contact["stiffness"], "N/m", value)
            self._scatters("contact_stiffness", None, std / value)
        elif kind not in ("channels", "inputs"):        # which are of the recording
            self.left.append(f"{name} {value:.3g}")

    def sources(self, friction):
        """What scatters, by the standard deviations of the values; friction is about its ``friction`` coefficient."""
        found = []
        for (kind, part), width in self._spread.items():
            width = width * friction if kind == "friction" else width
            if width > 0:
                found.append({"kind": kind, **({"part": part} if part else {}), "variation": float(f"{width:.3g}")})
        return found

    def stated(self, value, unit):
        """A value in its SI unit, with its origin."""
        return {"value": float(value) if unit == "1" else f"{float(value)!r} {unit}", "origin": "inferred",
                "source": self.source}

    def _body(self, owner, what, factor, width):
        """A body, and the springs that touch nothing else."""
        stiffer, lossier, heavier = (factor**power for power in _OF_BODY[what])
        mass = self.lumped["masses"][owner]
        for key, unit in (("mass", "kg"), ("inertia", "kg m^2")):
            if heavier != 1 and key in mass:
                mass[key] = self._scaled(mass[key], unit, heavier)
        for name, spring in (self.lumped.get("springs") or {}).items():
            if {str(coordinate).partition(".")[0] for coordinate in _coordinates(spring)} != {owner}:
                continue
            for key, by in (("stiffness", stiffer), ("damping", lossier)):
                if by != 1:
                    self._spring(spring, key, by, True)
            if what in ("frequency", "stiffness"):
                self._scatters("joint_stiffness", name, _OF_BODY[what][0] * width)
            elif what == "damping":
                self._scatters("joint_loss", name, width)

    def _spring(self, spring, what, value, scales):
        """Set, or scale, the stiffness or damping of a spring, which may be torsional."""
        key = next((key for key in (what, f"torsional_{what}") if key in spring), what)
        unit = _SOLID[key]
        spring[key] = self._scaled(spring.get(key, 0.0), unit, value) if scales else self.stated(value, unit)

    def _scaled(self, given, unit, factor):
        value = _plain(given)
        return self.stated(factor * (to_si(value, unit, unit) if value else 0.0), unit)

    def _scatters(self, kind, part, width):
        self._spread[kind, part] = float(np.hypot(self._spread.get((kind, part), 0.0), width))


def _coordinates(spring):
    """Coordinates that a spring connects."""
    if spring.get("along"):
        return list(spring["along"])
    return [each for each in spring.get("between", ()) if each != "ground"]


def _plain(value):
    return copy.deepcopy(value["value"]) if isinstance(value, dict) and "value" in value else value


def _number(value):
    """The number of a quantity written in its SI unit."""
    return float(str(value).split()[0])

"""What a column most likely measures, by its name and unit: a proposal for the user to confirm, never a fact."""

import re
from dataclasses import dataclass

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si, measured_in

#: unit in a name, as in "Position [mm]", "Force (N)", "F/N" or "torque_Nm"
_LETTERS = r"A-Za-z\u00b5\u03bc\u00b0%"
_WITH_UNIT = (re.compile(r"(.*\S)\s*[\[(]\s*([^\])]*?)\s*[\])]"),
              re.compile(rf"(.*?\S)\s+/\s+([{_LETTERS}][\w^/]*)"),
              re.compile(rf"(.*\w)\s*/\s*([{_LETTERS}][\w^/ ]*)"),
              re.compile(rf"(.*\w)(?:,|\s+in)\s+([{_LETTERS}][\w^/]*)"),
              re.compile(r"(.*[A-Za-z0-9])_(mm|um|nm|m|N|kN|mN|uN|Nm|mNm|rad|deg|rpm|V|mV|A|mA|s|ms|us|min|MPa|kPa)"))
#: what is measured -> (names, units by rotation: no, yes)
_NAMES = {
    "time": (r"t|time|zeit|timestamps?|seconds|xvalue", ("s", "s")),
    "torque": (r"tau|torque|moment|drehmoment|trq|mz", ("N m", "N m")),
    "force": (r"f|force|kraft|load|friction|normal|thrust|tension|f[xyz]", ("N", "N m")),
    "current": (r"i|cur|current|strom|amps?|iq", ("A", "A")),
    "voltage": (r"v\d*in|u\d*in|volt|voltage|spannung|vir|v\d", ("V", "V")),
    "stress": (r"sigma|stress|spannungen", ("MPa", "MPa")),
    "strain": (r"e|eps|epsilon|strain|dehnung", ("1", "1")),
    "pressure": (r"p|pressure|druck", ("Pa", "Pa")),
    "counts": (r"counts?|enc|encoder|ticks|pulses?", ("1", "1")),
    "acceleration": (r"a|acc|accel|acceleration|beschleunigung|a[xyz]|ddq|ddx", ("m/s^2", "rad/s^2")),
    "velocity": (r"v|vel|velocity|speed|geschwindigkeit|omega|rate|dq|dx|qd", ("m/s", "rad/s")),
    "angle": (r"angle|angles|theta|phi|alpha|rot|rotation|winkel|q", ("rad", "rad")),
    "displacement": (r"x|y|z|s|pos|position|disp|displacement|weg|height|h|stroke|travel|qm|extension|elongation",
                     ("m", "rad"))}
_DRIVES = frozenset({"force", "torque", "current", "voltage", "stress"})
_MOVES = ("displacement", "angle", "strain", "counts", "velocity", "acceleration")
#: words of a name that say what a channel is not: what was asked for, filtered, or of the base
_ASKED = re.compile(r"(^|[_\W])(des|desired|ref|reference|cmd|command|commanded|con|set|setpoint|target|soll|qg)"
                    r"(\d|[_\W]|$)", re.IGNORECASE)
_FILTERED = re.compile(r"filt|smooth", re.IGNORECASE)
_BASE = re.compile(r"(^|[_\W])(base|ground|table|floor|support|foundation|fuss)", re.IGNORECASE)


@dataclass(frozen=True)
class Meaning:
    """``measures`` ('' where nothing speaks for anything) in ``unit``, which the file ``states`` or which is typical.

    ``index``: number at the end of the name; ``turns``: whether it is about an axis; ``asked``, ``filtered``, ``base``:
    by words in the name.
    """

    measures: str
    unit: str
    stated: bool
    index: str
    turns: bool
    asked: bool
    filtered: bool
    base: bool

    @property
    def drives(self):
        """Whether it can be what acts on a rig."""
        return self.measures in _DRIVES

    @property
    def order(self):
        """Derivative of a displacement that it is: 1 of a velocity, 2 of an acceleration, else 0."""
        return {"velocity": 1, "acceleration": 2}.get(self.measures, 0)

    @property
    def rank(self):
        """Place among the motions that show a coordinate best, the first best; None of others."""
        return _MOVES.index(self.measures) if self.measures in _MOVES else None


def meaning(name, unit="", measures="", turning=False):
    """Meaning of a column; ``unit`` and ``measures`` as the file states them, ``turning``: it lies beside torques.

    A unit that no channel has is none.
    """
    bare, written = split_unit(name)
    unit = unit if _known(unit) else written
    index = re.search(r"(\d+)\s*$", bare)
    measures = measures if measures not in ("", "value") else ""
    base = bool(_BASE.search(bare))
    measures = measures or _by_unit(unit) or _by_name(bare) or ("displacement" if base else "")
    if measures == "angular_velocity" or measures == "speed":
        measures = "velocity"
    turns = measures in ("angle", "torque") or "rad" in unit or unit in ("deg", "rpm", "rev") or (
        turning and not unit and measures in _MOVES)
    if turns and measures == "displacement":
        measures = "angle"
    typical = _NAMES[measures][1][turns] if measures in _NAMES else "1"
    return Meaning(measures, unit or typical, bool(unit), index[1] if index else "", turns, bool(_ASKED.search(bare)),
                   bool(_FILTERED.search(bare)), base)


def split_unit(name):
    """(name, unit) of a name that holds its unit, as "Position [mm]" does; no unit where it is none that is known."""
    for form in _WITH_UNIT:
        split = form.fullmatch(name.strip())
        if split and _known(split[2]):
            return split[1].strip(), split[2]
    return name.strip(), ""


def _known(unit):
    try:
        return bool(unit) and bool(in_si(1.0, unit, "unit"))
    except ConfigError:
        return False


def _by_unit(unit):
    if not unit or unit in ("1", "%"):
        return ""
    found = measured_in(unit, "unit")
    return {"value": "", "pressure": "stress" if unit in ("MPa", "GPa") else "pressure",
            "angular_velocity": "velocity"}.get(found, found)


def _by_name(name):
    """By the whole name, then by its words: 'pos_meas1' is pos, meas; a letter alone counts as the first word."""
    words = [word for word in re.split(r"[^A-Za-z]+", re.sub(r"([a-z])([A-Z])", r"\1 \2", name).lower()) if word]
    whole = re.sub(r"\W|_", "", name).lower()
    for text in (whole, *words[:1], *(word for word in words[1:] if len(word) > 1)):
        for measures, (names, _) in _NAMES.items():
            if re.fullmatch(names, text):
                return measures
    return ""

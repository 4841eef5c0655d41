"""Planted facts in universal files by pyuff: units of labels, case and file, abscissae, sign, responses."""

from dataclasses import dataclass, replace

import numpy as np

from tests.fuzz.mutation import draw
from tests.fuzz.semantics.channel_files import written
from tests.fuzz.semantics.labels import LABELS
from tests.fuzz.semantics.planted import Meant, Planted, column, signal
from tests.fuzz.trial import Told, Trial, difference

_CODES = {"displacement": 8, "force": 9, "velocity": 11, "acceleration": 12, "pressure": 15, "sound_pressure": 15,
          "temperature": 5, "angle": 8, "angular_velocity": 11, "torque": 9}
_TURNS = ("angle", "angular_velocity", "torque")
_RATES = (50.0, 100.0, 256.0, 1000.0, 2048.0, 12800.0, 25600.0, 44100.0, 51200.0)
_TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "SEC": 1.0, "msec": 1e-3, "Milliseconds": 1e-3, "NONE": 1.0}
_FREQUENCIES = {"Hz": 1.0, "HZ": 1.0, "kHz": 1e3, "rad/s": 0.5 / np.pi, "RPM": 1 / 60, "NONE": 1.0}
#: units of the file: size of a metre and of a newton in them
_SYSTEMS = ((1.0, 1.0), (1e3, 1.0), (1e2, 1e5), (39.3700787401575, 0.224808943099711),
            (3.28083989501312, 0.224808943099711))
#: a quantity -> its SI unit and the powers of length and force in it
_POWERS = {"displacement": ("m", 1, 0), "velocity": ("m/s", 1, 0), "acceleration": ("m/s^2", 1, 0),
           "force": ("N", 0, 1), "pressure": ("Pa", -2, 1), "angle": ("rad", 0, 0), "angular_velocity": ("rad/s", 0, 0),
           "torque": ("N m", 1, 1)}


def _saved(sets):
    """Bytes of a universal file of these dicts."""
    import pyuff

    def write(path):
        for given in sets:
            numbers = {name: value for name, value in given.items() if not name.endswith("_lab")}
            whole = given if given.get("type") == 164 else {
                name: value or 0 for name, value in pyuff.prepare_58(**numbers, return_full_dict=True).items()
                if value is None or np.size(value) == 1} | given
            pyuff.UFF(str(path)).write_sets(whole, mode="add")

    return written(write)


def _head(rng, name, node, direction):
    return {"binary": int(draw(rng, (0, 1))), "rsp_node": node, "rsp_dir": direction, "rsp_ent_name": name,
            "ref_node": 1, "ref_dir": 0,
            "id1": "made for a test", "ordinate_axis_lab": "NONE", "orddenom_spec_data_type": 0,
            "orddenom_axis_units_lab": "NONE"}


def _axis(rng, count, size, step, begin, code, name, label):
    even = int(draw(rng, (1, 1, 0)))
    return {"abscissa_spacing": even, "abscissa_min": begin / size, "abscissa_inc": step / size, "num_pts": count,
            "abscissa_spec_data_type": code, "abscissa_axis_lab": name, "abscissa_axis_units_lab": label,
            "x": (begin + step * np.arange(count)) / size}


def uff(rng):
    """Time signals, or responses."""
    return _responses(rng) if rng.random() < 0.35 else _signals(rng)


def _signals(rng):
    system = draw(rng, _SYSTEMS) if rng.random() < 0.3 else None
    sets, meant, units, uneven = [], {}, {}, False
    rate, begin = float(draw(rng, _RATES)), float(draw(rng, (0.0, 0.0, 0.5, -0.25)))
    for k in range(int(rng.integers(1, 4))):
        count, label = int(rng.integers(40, 200)), draw(rng, list(_TIMES))
        one, name = column(rng, count, True, (1.0,), 0.06 if system is None else 0.0), f"ch {k}"
        measured = one.measured
        needed = one.label in {each.text for each in LABELS if each.stated}
        code = _CODES.get(measured, 0) if needed or rng.random() < 0.7 else 0
        direction = int(draw(rng, (4, -5, 6) if measured in _TURNS else (1, -2, 3, 0)))
        text = one.label if one.label.isascii() else "V"
        if not one.label.isascii():     # pyuff writes ASCII
            one = replace(one, label="V", measured="voltage", si="V", true=one.numbers, asked=False)
            measured, code = "voltage", 0
        if system is not None and measured in _POWERS:
            si, length, force = _POWERS[measured]
            numbers = signal(rng, count)
            true = numbers * system[0] ** -length * system[1] ** -force
            code, text = _CODES[measured], "NONE"
        else:
            numbers, true, si = one.numbers, one.true, one.si
        if rng.random() < 0.15 and text not in ("NONE", "None") and not one.asked:
            units[f"ch_{k}"], text = text, draw(rng, ("PA", "xyz", "NONE", "kN"))   # the case goes before the label
        sets.append(_head(rng, name, 3 + k, direction) | {
            "func_type": 1, "ord_data_type": 4, "data": numbers, "ordinate_spec_data_type": code,
            "ordinate_axis_units_lab": text} | _axis(rng, count, _TIMES[label], 1 / rate, begin, 17, "Time", label))
        even = sets[-1]["abscissa_spacing"]
        off = 1e-5 * (1 if even else 2 * (abs(begin) + count / rate) / (count / rate))      # heads have six digits
        meant[f"ch_{k}"] = Planted(true, si, rate, begin, 1e-5, 1.1 * off, 1e-5 + 1e-5 * abs(begin),
                                   one.asked and text == one.label)
        uneven |= not even
    if system is not None:
        sets.insert(int(rng.integers(len(sets) + 1)), _system(system))
    stated = {"kind": "uff", "run": "a"} | ({"units": units} if units else {})
    either = uneven or any(one.asked for one in meant.values())
    return Trial("a.uff", _saved(sets), "units, abscissae of universal files", {"files": [stated]},
                 Meant({"a": meant}), "either" if either else "read")


def _system(system):
    import pyuff

    return pyuff.prepare_164(units_code=9, units_description="user", temp_mode=2, length=system[0], force=system[1],
                             temp=1.0, temp_offset=273.15)


def _responses(rng):
    sets, meant = [], {}
    for k in range(int(rng.integers(1, 4))):
        count, label = int(rng.integers(20, 100)), draw(rng, list(_FREQUENCIES))
        step, begin = float(draw(rng, (0.5, 1.0, 3.125))), float(draw(rng, (0.0, 100.0)))
        numbers = (signal(rng, count) + 1j * signal(rng, count)) * draw(rng, (1.0, -1.0))
        above = draw(rng, [one for one in LABELS if one.measured in ("acceleration", "velocity", "displacement")
                           and "pk" not in one.text and one.text.isascii()])
        below = draw(rng, [one for one in LABELS if one.measured == "force" and not one.stated])
        sets.append(_head(rng, f"ch {k}", 3 + k, int(draw(rng, (1, -2, 3)))) | {
            "func_type": 4, "ord_data_type": 6, "data": numbers, "ref_node": 2, "ref_dir": -3,
            "ordinate_spec_data_type": _CODES[above.measured], "ordinate_axis_units_lab": above.text,
            "orddenom_spec_data_type": 13, "orddenom_axis_units_lab": below.text} | _axis(
                rng, count, _FREQUENCIES[label], step, begin, 18, "Frequency", label))
        meant[f"ch_{k}"] = {"frequency": begin + step * np.arange(count), "response": numbers * above.size / below.size,
                            "unit": f"{above.si}/N"}
    return Trial("a.uff", _saved(sets), "frequency responses of universal files",
                 {"files": [{"kind": "uff", "run": "a"}]}, Responses(meant), "read")


@dataclass(frozen=True)
class Responses:
    """{name: plain values} of frequency responses: judges the value of ``read``."""

    meant: dict

    def __call__(self, value):
        found, told = value["runs"]["a"]["frf"], []
        for name, wanted in self.meant.items():
            if name not in found:
                if not any("left out" in one and name in one for one in value["remarks"]):
                    return f"no {name}, and no word of it"
                told.append(f"left out: {name}")
                continue
            said = difference(found[name], wanted, 2e-5, name)
            if said:
                return said
        return Told("; ".join(told)) if told else ""

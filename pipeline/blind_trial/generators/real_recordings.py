"""Real recordings, and complete models of what they show, from which a draw removes one term or none.

Carriage drive (EMPS), circuit (Silverbox) and tribometer: the cases of ``configs`` with the effect that their diagnosis
named. What is removed is that effect, or viscous friction of the nominal model. Whoever draws knows what was removed,
not what else the recordings hold: a control here is a model that is complete as far as anybody knows. Recordings lie in
the folder that BRAKECHAIN_DATA names.
"""

import os
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from pipeline.blind_trial.generators import case_files
from pipeline.contract.errors import ConfigError

#: system -> (case, {effect: (place, its values in the complete model)})
_COMPLETE = {
    "carriage": ("emps.yaml", {"coulomb": ("guide", {"force": "20.6 N"})}),
    "circuit": ("silverbox.yaml", {"cubic_stiffness": ("mount", {"coefficient": "7.313e11 N/m^3"})}),
    "tribometer": ("tribometer.yaml", {"micro_slip": ("contact", {"compliance": "21.7 um/N"})}),
}
NAMES = tuple(_COMPLETE)
#: system -> joint whose damping may be removed; a joint that is left without any force has no typical one
_DAMPED = {"circuit": "mount"}
#: SI unit of a recorded one
_SI = {"m": ("m", 1.0), "mm": ("m", 1e-3), "N": ("N", 1.0), "uN": ("N", 1e-6), "V": ("V", 1.0)}


def removable(system):
    """{class: ((name,), ...)} of what can be removed from the complete model of a system."""
    names = [*_COMPLETE[system][1], *(["joint_damping"] if system in _DAMPED else [])]
    return {"control": ((),), "effect": tuple((name,) for name in names)}


def write(draw, folder):
    """Write the case of a draw with what it hides removed from the model; returns its truth."""
    name, effects = _COMPLETE[draw.system]
    document = case_files.stated(name)
    runs = _runs(document["recording"]["files"])
    document["recording"] = {"files": [{"kind": "hdf5", "file": "recordings.h5"}]}
    document.pop("based_on", None)
    removed = [_removed(document, draw.system, hidden) for hidden in draw.hidden]
    for effect, (location, values) in effects.items():
        if effect not in draw.hidden:
            document.setdefault("effects", {}).setdefault(effect, {})[location] = values
    case_files.leave(folder, document, runs)
    return {"class": draw.kind, "effects": removed, "system": draw.system, "parameters": {}, "seed": draw.seed}


def _removed(document, system, name):
    """{name, place, parameters} of a term; viscous friction is taken out of the ``document``."""
    if name == "joint_damping":
        joint = _DAMPED[system]
        del document["lumped"]["springs"][joint]["damping"]
        del document["diagnosis"]["parameters"][f"joints.{joint}.damping"]
        return {"name": name, "place": joint, "parameters": {}}
    return {"name": name, "place": _COMPLETE[system][1][name][0], "parameters": {}}


def _runs(entries):
    """{run: ...} as ``files.leave`` takes them, cut from all files of a case."""
    runs = {}
    for entry in entries:
        table, rate = _table(entry)
        for name, cut in entry["runs"].items():
            first, after = (round(float(cut[end].split()[0]) * rate) if end in cut else None
                            for end in ("begin", "end"))
            runs[name] = {"conditions": {}, "channels": {
                key: (*_si(table[column["column"]][first:after], column), rate, column.get("role", "response"))
                for key, column in entry["columns"].items()}}
    return runs


def _si(values, column):
    """(samples, unit, quantity) in SI, with the factor that the case states."""
    factor = column.get("factor", 1.0)
    unit, scale = _SI[column["unit"]]
    return (factor["value"] if isinstance(factor, dict) else factor) * scale * values, unit, column["measures"]


def _table(entry):
    """({column: (n,)}, rate in Hz) of a MATLAB file or a table of numbers below one line of names."""
    path = _path(entry["file"])
    if entry["kind"] == "matlab":
        table = {name: np.ravel(v).astype(float) for name, v in loadmat(path).items() if not name.startswith("_")}
    else:
        names = path.read_text(encoding="utf-8").splitlines()[0].split("\t")
        table = dict(zip((n.strip() for n in names), np.genfromtxt(path, delimiter="\t", skip_header=1).T, strict=True))
    rate = entry.get("sample_rate")
    if rate is None:
        return table, 1 / float(np.median(np.diff(table[entry["time"]])))
    return table, float((rate["value"] if isinstance(rate, dict) else rate).split()[0])


def _path(name):
    folder = os.environ.get("BRAKECHAIN_DATA")
    path = Path(folder or "") / name.removeprefix("measured:")
    if not folder or not path.exists():
        raise ConfigError("trial on real recordings", f"{name} in the folder BRAKECHAIN_DATA", str(folder),
                          "set BRAKECHAIN_DATA to the folder of the public recordings")
    return path

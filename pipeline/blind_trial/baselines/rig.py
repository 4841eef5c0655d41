"""What a baseline reads of a case: masses on springs with a displacement sensor each, pushed, perhaps on a belt."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.contract import ConfigError, documents
from pipeline.contract.units import to_si
from pipeline.recordings.neutral import read_neutral


@dataclass(frozen=True)
class Run:
    """Samples of a run: forces on the masses ``push`` (mass, n) N, ``shown`` (mass, n) m, ``belt`` (n,) m/s or None,
    ``load`` N of the contact."""

    name: str
    push: np.ndarray
    shown: np.ndarray
    belt: np.ndarray | None
    load: float


@dataclass(frozen=True)
class Rig:
    """``masses``, ``joints``, ``channels``: names; ``mass`` (n,), ``rows`` (joint, n), ``stiffness``, ``damping``
    (joint,): as stated; ``sensors`` [(delay s, corner Hz)]; ``contact`` (n,) row of what rubs, or None.

    ``free``: names of values that may be wrong; ``runs`` are for training, ``held_out`` for verification.
    """

    masses: tuple
    joints: tuple
    channels: tuple
    mass: np.ndarray
    rows: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    sensors: tuple
    contact: np.ndarray | None
    free: frozenset
    rate: float
    runs: tuple
    held_out: tuple


def read(folder):
    """The Rig of a case's folder. ConfigError for cases of another kind: these baselines know forced rigs alone."""
    folder = Path(folder)
    case, recorded = documents.read_yaml(folder / "nominal.yaml"), read_neutral(folder / "recordings.h5")
    lumped, bench, asked = (case.get(name) or {} for name in ("lumped", "bench", "diagnosis"))
    if not lumped or "poles" in bench or asked.get("forward", "simulation") != "simulation":
        raise _other("a forced lumped rig", case.get("chain", "none"))
    names = [f"{body}.{move}" for body, mass in lumped["masses"].items() for move in mass["moves"]]
    sensors = _sensors(lumped, bench, names)
    joints = lumped.get("springs", {})
    mass = np.array([_si(lumped["masses"][name.partition(".")[0]], "mass", "kg") for name in names])
    contacts = lumped.get("contacts", {})
    rows = np.array([_row(joint, names) for joint in joints.values()])
    row = _combined(next(iter(contacts.values()))["tangent"], names) if contacts else None
    load = sum(_si(contact, "normal_force", "N") for contact in contacts.values())
    runs = [_run(name, run, lumped, bench, names, sensors, load) for name, run in recorded.items()]
    kept = set(asked.get("held_out", ()))
    return Rig(tuple(name.partition(".")[0] for name in names), tuple(joints), tuple(channel for channel, _ in sensors),
               mass, rows, *(np.array([_si(joint, what, unit) for joint in joints.values()])
                             for what, unit in (("stiffness", "N/m"), ("damping", "N s/m"))),
               tuple(chain for _, chain in sensors), row, frozenset(asked.get("parameters", ())), _rate(recorded),
               tuple(r for r in runs if r.name not in kept), tuple(r for r in runs if r.name in kept))


def _sensors(lumped, bench, names):
    """[(channel, (delay, corner))] of a displacement of every mass alone, in their order."""
    sensors = {}
    for channel, entry in bench.get("channels", {}).items():
        row = _combined(lumped.get("sensors", {}).get(entry["source"], {}).get("along", {}), names)
        if entry["quantity"] == "displacement" and np.count_nonzero(row) == 1 and row.max() == 1:
            corner = to_si(entry["corner"], "Hz", channel) if "corner" in entry else np.inf
            sensors[int(row.argmax())] = channel, (_si(entry, "delay", "s"), corner)
    if sorted(sensors) != list(range(len(names))):
        raise _other("a displacement channel of every mass", f"those of {len(sensors)} of {len(names)}")
    return [sensors[k] for k in range(len(names))]


def _run(name, run, lumped, bench, names, sensors, load):
    push = 0.0
    for key, entry in bench.get("inputs", {}).items():
        push = push + np.outer(_combined(lumped["inputs"][key]["along"], names), _samples(run, entry["channel"]))
    shown = np.array([_samples(run, channel) for channel, _ in sensors])
    drive = bench.get("drive")
    entry = run.conditions.get("normal_load")
    return Run(name, np.broadcast_to(push, shown.shape), shown, _samples(run, drive["channel"]) if drive else None,
               float(np.ravel(entry.value)[0]) if entry else load)


def _samples(run, channel):
    if channel not in run.channels:
        raise _other(f"a channel {channel} in every run", ", ".join(run.channels) or "none")
    return np.asarray(run.channels[channel].samples, float)


def _rate(recorded):
    rates = {float(c.rate) for run in recorded.values() for c in run.channels.values()}
    if len(rates) != 1:
        raise _other("one sampling rate", f"{sorted(rates)} Hz")
    return rates.pop()


def _row(joint, names):
    if "along" in joint:
        return _combined(joint["along"], names)
    first, second = joint["between"]
    return _combined({first: 1}, names) - _combined({second: 1}, names)


def _combined(combination, names):
    return np.array([float(combination.get(name, 0.0)) for name in names])


def _si(section, key, unit):
    return float(to_si(section[key], unit, key)) if key in section else 0.0


def _other(expected, actual):
    return ConfigError("baseline", expected, actual, "baselines answer forced rigs of masses alone")

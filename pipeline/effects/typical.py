"""Typical sizes at a place of a bench, taken from nominal runs: they scale the priors of effects."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.bench import Channel, respond, run_drive
from pipeline.physics.contact_groups import parts
from pipeline.physics.time_stepping import Penalty, Table

#: kinds of place that an effect can have; ``contacts`` is all of them, which share one law of contact and of friction
JOINT, CONTACT, CONTACTS, POINT, CHANNEL = "joint", "contact", "contacts", "point", "channel"
_SENSOR = "typical"


@dataclass(frozen=True)
class Typical:
    """What is moved at a place, how far, how fast, how hard, how long; 0 where it means nothing there.

    ``stiffness`` N/m, ``damping`` N s/m, effective ``mass`` kg, ``length`` m, ``speed`` m/s (of sliding, for
    contacts), ``force`` N, ``pressure`` Pa, ``time`` s of the longest run, ``interval`` s between samples, ``drive``
    rad/s, ``shown`` in units of a channel.
    """

    stiffness: float = 1.0
    damping: float = 1.0
    mass: float = 1.0
    length: float = 1.0
    speed: float = 1.0
    force: float = 1.0
    pressure: float = 1.0
    time: float = 1.0
    interval: float = 1.0
    drive: float = 1.0
    shown: float = 1.0


def places(kind, bench):
    """Names of the places of this kind on a bench."""
    model = bench.model
    contact = dict.fromkeys(("contact", *bench.groups)) if len(model.contacts.area) else ()
    return {JOINT: tuple(model.joints.name), CONTACT: tuple(contact), CONTACTS: tuple(contact)[:1],
            POINT: tuple(model.sensor_name), CHANNEL: tuple(c.name for c in bench.channels)}[kind]


def typical(kind, bench, place, runs):
    """Typical sizes at ``place``: largest values of the bench as it is, over ``runs``. ConfigError without runs."""
    if not runs:
        raise ConfigError("typical sizes", "one nominal run or more", "none")
    drive = max(float(np.abs(run_drive(bench, run)).max()) for run in runs)
    common = {"time": max(r.duration for r in runs), "interval": 1 / max(r.sample_rate for r in runs), "drive": drive}
    if kind == CHANNEL:
        shown = _largest(replace(bench, channels=tuple(c for c in bench.channels if c.name == place)), runs)
        return Typical(**common, shown=shown[place])
    row, stiffness, damping = _place(kind, bench, place)
    channels = [Channel("length", "displacement", _SENSOR), Channel("speed", "velocity", _SENSOR)]
    if kind in (CONTACT, CONTACTS):
        channels.append(Channel("force", "normal_force", place))
    model = replace(bench.model, sensor_name=(*bench.model.sensor_name, _SENSOR),
                    sensor_rows=np.vstack((bench.model.sensor_rows, row)))
    seen = _largest(replace(bench, model=model, channels=tuple(channels)), runs)
    if kind in (CONTACT, CONTACTS):
        contacts, own = bench.model.contacts, bench.contacts(place)
        seen["speed"] = drive * abs(contacts.lever[own]).max()
        seen["pressure"] = seen["force"] / contacts.area[own].sum()
    else:
        seen["force"] = stiffness * seen["length"] + damping * seen["speed"]
    mass = 1 / (row @ np.linalg.solve(bench.model.mass, row)) if row.any() else 0.0
    return Typical(stiffness, damping, mass, **seen, **common)


def _largest(bench, runs):
    answers = [respond(bench, run) for run in runs]
    return {c.name: max(float(abs(a[c.name]).max()) for a in answers) for c in bench.channels}


def _place(kind, bench, place):
    """(row (n,), stiffness, damping) of a joint, a point, or the mean normal of a contact group."""
    if kind == JOINT:
        return bench.joint(place)
    if kind == POINT:
        row = bench.model.sensor_rows[bench.model.sensor_name.index(place)]
        return row, float(row @ bench.model.supported()[2] @ row), float(row @ bench.model.supported()[1] @ row)
    own = bench.contacts(place)
    return bench.model.contacts.normal[own].mean(axis=0), *_contact_law(bench, own)


def _contact_law(bench, own):
    """(stiffness, damping) of a whole group, 0 for contacts that do not yield; a table by its last slope."""
    area, found = bench.model.contacts.area, np.zeros(2)
    for law, members in parts(bench.law, len(area)):
        mine = np.intersect1d(members, own)
        if isinstance(law, Penalty):
            found += [np.broadcast_to(v, len(area))[mine].sum() for v in (law.stiffness, law.damping)]
        elif isinstance(law, Table):
            slope = (law.pressure[-1] - law.pressure[-2]) / (law.closure[-1] - law.closure[-2])
            found[0] += slope * area[mine].sum()
    return tuple(float(v) for v in found)

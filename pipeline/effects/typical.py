"""Typical quantities at a location of a bench, taken from nominal runs: they scale the priors of effects."""

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.effects.contact.contact_surface import sliding_angle
from pipeline.effects.resolved import felt_mass
from pipeline.physics.contact.groups import parts
from pipeline.physics.time_stepping.elements import Wave
from pipeline.physics.time_stepping.simulate import Penalty, Table
from pipeline.physics.virtual_rig.inputs import run_inputs
from pipeline.physics.virtual_rig.response import respond, run_drive
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, JOINT_FORCE, NORMAL_FORCE, VELOCITY, Sensor

#: kinds of location that an effect can have: ``contact`` is a group of contacts, ``contacts`` all together, ``pressed
#: contact`` a group that can open (a friction joint cannot), ``contact row`` one whose contacts lie one behind the
#: other along the sliding direction, ``sideways contact`` one that can move across it, ``pair of channels`` two of one
#: unit
JOINT, CONTACT, CONTACTS, POINT, CHANNEL = "joint", "contact", "contacts", "point", "channel"
PRESSED, CONTACT_ROW, DOUBLET, INPUT = "pressed contact", "contact row", "doublet", "input"
SIDEWAYS, CHANNEL_PAIR = "sideways contact", "pair of channels"
#: what stands between the names of a pair of channels
PAIR_MARK = " and "
#: the only location of a Rubbing, and its kind
ASPERITIES = "asperities"
#: share of a force below which it hardly moves a place
_LITTLE = 0.01
_CONTACTS, _SENSOR, _SLIP = (CONTACT, CONTACTS, PRESSED, CONTACT_ROW, SIDEWAYS), "typical", "typical slip"


@dataclass(frozen=True)
class Typical:
    """Typical quantities at a location: amplitudes, forces, times; 0 where a quantity has no meaning there.

    ``stiffness`` N/m, ``damping`` N s/m, effective ``mass`` kg, ``length`` m, ``speed`` m/s (of the drive, for
    contacts; of their motion along sliding where it rests), ``force`` N, ``pressure`` Pa, ``time`` s of the longest
    run, ``interval`` s between samples, ``drive`` rad/s where something turns, ``shown``: largest value in units of
    the channel, ``pushed`` N of the inputs along a joint, however far it moves.
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
    pushed: float = 0.0

    @property
    def period(self):
        """Seconds per radian of the mass on the stiffness; duration of the longest run where there is no stiffness."""
        return np.sqrt(self.mass / self.stiffness) if self.stiffness > 0 else self.time

    @property
    def holding(self):
        """Stiffness in N/m, or force over length where no spring supports the location (a carriage on its drive)."""
        return self.stiffness if self.stiffness > 0 else self.force / self.length

    def scaled(self, factor):
        """The quantities with amplitudes times ``factor``; contact loads and inputs stay."""
        return replace(self, length=factor * self.length, speed=factor * self.speed, shown=factor * self.shown,
                       force=max(factor * self.force, self.pushed))


def locations(kind, bench):
    """Names of the locations of this kind on a bench; no joint whose far end an input moves, which laws do not see."""
    model = bench.model
    contact = tuple(dict.fromkeys(("contact", *bench.groups))) if len(model.contacts.area) else ()
    pressed = tuple(g for g in contact if not model.contacts.fixed[bench.contacts(g)].all())
    still = tuple(name for name in model.joints.name if name not in model.moved_ends.values())
    return {JOINT: still, CONTACT: contact, CONTACTS: contact[:1], PRESSED: pressed,
            CONTACT_ROW: tuple(g for g in pressed if np.ptp(sliding_angle(model.contacts, bench.contacts(g))) > 0),
            SIDEWAYS: tuple(g for g in contact if model.contacts.lateral[bench.contacts(g)].any()),
            POINT: tuple(model.sensor_name), INPUT: tuple(model.input_name), DOUBLET: tuple(bench.doublets),
            CHANNEL: tuple(c.name for c in bench.channels),
            CHANNEL_PAIR: tuple(PAIR_MARK.join((a.name, b.name)) for a, b in combinations(bench.channels, 2)
                                if a.measurand.unit == b.measurand.unit)}[kind]


def typical(kind, bench, location, runs):
    """Typical quantities at ``location``: largest values of the nominal bench over ``runs`` (Drags of a Rubbing).

    ConfigError without runs.
    """
    if not runs:
        raise ConfigError("typical sizes", "one nominal run or more", "none")
    if kind == ASPERITIES:
        return _rubbed(bench, runs)
    drive = max(float(np.abs(run_drive(bench, run)).max()) for run in runs)
    common = {"time": max(r.duration for r in runs), "interval": 1 / max(r.sample_rate for r in runs),
              "drive": drive if _turns(bench, runs) else 0.0}
    if kind == CHANNEL_PAIR:
        return Typical(**common)
    if kind == CHANNEL:
        shown = _largest(replace(bench, channels=tuple(c for c in bench.channels if c.name == location)), runs)
        return Typical(**common, shown=shown[location])
    row, stiffness, damping = _at(kind, bench, location)
    channels, along = [Sensor("length", DISPLACEMENT, _SENSOR), Sensor("speed", VELOCITY, _SLIP)], row
    if kind in _CONTACTS:
        channels.append(Sensor("force", NORMAL_FORCE, location))
        along = bench.model.contacts.tangent[bench.contacts(location)].mean(axis=0)
    others = _beside(bench, row) if kind == JOINT else {}
    channels += [s for name in others for s in (
        Sensor(f"force {name}", JOINT_FORCE, name), Sensor(f"length {name}", DISPLACEMENT, f"{_SENSOR} {name}"),
        Sensor(f"speed {name}", VELOCITY, f"{_SENSOR} {name}"))]
    model = replace(bench.model, sensor_name=(*bench.model.sensor_name, _SENSOR, _SLIP,
                                              *(f"{_SENSOR} {name}" for name in others)),
                    sensor_rows=np.vstack((bench.model.sensor_rows, row, along,
                                           *(bench.joint(name)[0] for name in others))))
    seen = _largest(replace(bench, model=model, channels=tuple(channels)), runs)
    if kind in _CONTACTS:
        contacts, members = bench.model.contacts, bench.contacts(location)
        seen["force"] = seen["force"] or stiffness * seen["length"]     # one that nominal runs never close
        seen["speed"] = drive * abs(contacts.lever[members]).max() or seen["speed"]
        seen["pressure"] = seen["force"] / contacts.area[members].sum()
    else:
        seen["force"] = stiffness * seen["length"] + damping * seen["speed"]
    if kind == JOINT:
        seen = _moved(bench, row, runs, seen, others)
    if kind == INPUT:
        seen["force"] = max(seen["force"], *(float(np.abs(_input(bench, run, location)).max()) for run in runs))
    mass = felt_mass(bench, row) if row.any() else 0.0
    return Typical(stiffness, damping, mass, **seen, **common)


def _shares(bench, row, rows):
    """(k,): how far forces along ``rows`` (k, n) move what one along ``row`` (n,) moves."""
    return abs(rows.reshape(-1, len(row)) @ np.linalg.solve(bench.model.mass, row)) * felt_mass(bench, row)


def _beside(bench, row):
    """{joint: share of its force} of the joints that move what one along ``row`` moves; none where contacts press,
    whose loads say more."""
    if len(bench.model.contacts.area) or not row.any():
        return {}
    shares = _shares(bench, row, bench.model.joints.rows)
    return {name: float(share) for name, share in zip(bench.model.joints.name, shares, strict=True) if share > _LITTLE}


def _moved(bench, row, runs, seen, others):
    """Largest values ``seen`` of a joint with the largest force on what it moves, of inputs the root mean square, which
    blows do not rule: the less a nominal model has at a place, the less would be looked for there."""
    model = bench.model
    if not others:
        return seen
    sizes = []
    for name, share in others.items():
        (_, stiffness, damping), force = bench.joint(name), seen.pop(f"force {name}")
        apart = stiffness * seen.pop(f"length {name}") + damping * seen.pop(f"speed {name}")
        sizes.append(share * (force if name in model.moved_ends.values() else apart))
    pushed = [share * float(np.sqrt(np.mean(np.square(_input(bench, run, name))))) for run in runs
              for share, name in zip(_shares(bench, row, model.input_rows), model.input_name, strict=True)
              if name not in model.moved_ends]
    pushed += [float(_shares(bench, row, e.row)[0]) * abs(e.law.amplitude) for e in model.elements
               if isinstance(e.law, Wave) and not (e.law.order or e.law.frequency)]     # as weights
    return seen | {"force": float(max([seen["force"], *sizes, *pushed])), "pushed": float(max(pushed, default=0.0))}


def _turns(bench, runs):
    """Whether a drive acts on the bench: contacts slide on it, a speed changes its matrices, or runs tell its speed."""
    model = bench.model
    return bool(len(model.contacts.area) or bench.doublets or np.any(model.gyroscopic) or np.any(model.centrifugal)
                or any(run.drive is not None or "speed" in run.conditions for run in runs))


def _rubbed(rubbing, runs):
    """Typical of the Drags of a Rubbing: mean pressure, mean speed, longest way; lengths of wear at the asperities."""
    pressure, speed = (float(np.mean([np.mean(getattr(run, n)) for run in runs])) for n in ("pressure", "speed"))
    way, wearing = max(float(run.distance.max()) for run in runs), rubbing.wearing
    return Typical(length=(wearing.pad_coefficient + wearing.disc_coefficient) * pressure * way, speed=speed,
                   pressure=pressure, time=way / speed)


def _input(bench, run, location):
    return run_inputs(bench, run)[bench.model.input_name.index(location)]


def _largest(bench, runs):
    answers = [respond(bench, run) for run in runs]
    return {c.name: max(float(abs(a[c.name]).max()) for a in answers) for c in bench.channels}


def _at(kind, bench, location):
    """(row (n,), stiffness, damping) of a location: contacts along their mean normal, friction joints along the
    sliding direction, a doublet by its first mode.
    """
    if kind == JOINT:
        return bench.joint(location)
    if kind == INPUT:
        return bench.input(location)
    if kind == DOUBLET:
        (_, (stiffness, _), (first, _)) = bench.doublet(location)
        return np.eye(bench.model.size)[first], stiffness, float(bench.model.supported()[1][first, first])
    if kind == POINT:
        row = bench.sensor(location)
        return row, float(row @ bench.model.supported()[2] @ row), float(row @ bench.model.supported()[1] @ row)
    members = bench.contacts(location)
    contacts = bench.model.contacts
    rows = contacts.tangent if contacts.fixed[members].all() else contacts.normal
    return rows[members].mean(axis=0), *_contact_law(bench, members)


def _contact_law(bench, group):
    """(stiffness, damping) of a whole group, 0 for contacts that do not yield; a table by its last slope."""
    area, total = bench.model.contacts.area, np.zeros(2)
    for law, members in parts(bench.law, len(area)):
        mine = np.intersect1d(members, group)
        if isinstance(law, Penalty):
            total += [np.broadcast_to(v, len(area))[mine].sum() for v in (law.stiffness, law.damping)]
        elif isinstance(law, Table):
            slope = (law.pressure[-1] - law.pressure[-2]) / (law.closure[-1] - law.closure[-2])
            total[0] += slope * area[mine].sum()
    return tuple(float(v) for v in total)

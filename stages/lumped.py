"""Stage lumped: masses, springs, dampers, contacts, inputs and sensors of a minimal model, from the YAML alone."""

import numpy as np

from pipeline.case_models.lumped.connections import (
    connected,
    inertia_matrix,
    is_torsional,
    joint_fields,
    row_along,
    rows,
    sees_angle,
    turning,
    weights,
)
from pipeline.case_models.lumped.parts import (
    Chirp,
    Contact,
    Drive,
    Gyro,
    Harmonic,
    Histories,
    Inertia,
    Input,
    Mass,
    Pendulum,
    SensorSettings,
    Spring,
    Step,
)
from pipeline.contract import ConfigError, Context, Quantities, Section, option, stage
from pipeline.physics.contact.static_forces import static_forces
from pipeline.physics.signals import input_histories
from pipeline.products import Lumped
from pipeline.recordings.apart import waveforms
from pipeline.systems import lumped as system

#: samples, joined by lines, that a period needs to keep its size within 2 %
_SAMPLES = 10


class Settings(Section):
    """The whole system, every part by its name."""

    masses: dict[str, Mass] = option({}, "masses; at least one that can move")
    inertias: dict[str, Inertia] = option({}, "masses that move along combinations of coordinates")
    springs: dict[str, Spring] = option({}, "springs and dampers")
    pendulums: dict[str, Pendulum] = option({}, "weights that rotations lift; each is a joint of its name")
    contacts: dict[str, Contact] = option({}, "contacts and friction joints")
    gyros: dict[str, Gyro] = option({}, "masses that turn with the drive")
    inputs: dict[str, Input] = option({}, "forces and imposed displacements")
    sensors: dict[str, SensorSettings] = option({}, "sensors")
    drive: Drive | None = option(None, "speed of the drive over time; none = constant")
    load_factors: Quantities("Pa", gt=0) = option(("1 Pa",), "states: constant inputs times these, 1 Pa = as given")
    histories: Histories = option(Histories(), "samples of the time histories")


def _check(sections):
    """Build the whole system before anything is computed, and refuse histories shorter than the motion."""
    settings = sections["lumped"]
    _built(settings, massless=getattr(sections.get("bench"), "forward", None) == "equation")
    timed = settings.drive is not None or any(i.history for i in settings.inputs.values())
    motion = sections.get("transient")
    if timed and motion is not None and settings.histories.duration < motion.duration * (1 - 1e-9):
        raise ConfigError("lumped.histories.duration", f"at least transient.duration, {motion.duration:g} s",
                          f"{settings.histories.duration:g} s")
    yields = any(c.stiffness is not None for c in settings.contacts.values())
    if motion is not None and yields and motion.contact != "table":
        raise ConfigError("transient.contact", "table, because contacts have a stiffness", repr(motion.contact))


@stage(check=_check)
def lumped(settings: Settings, context: Context) -> Lumped:
    """Read a minimal model of masses, springs, contacts, inputs and sensors.

    Method:
    The system was specified as masses, springs, dampers and contacts; static contact forces exclude friction.
    """
    built = _built(settings, massless=True)      # where a mass is needed, the check asked for it
    context.log(f"coordinates: {', '.join(built.coordinate_name)}")
    return built


def _built(settings, massless):
    masses = {name: system.Mass(m.moves, m.mass, m.inertia, m.grounded) for name, m in settings.masses.items()}
    coordinates = system.coordinates(masses, "lumped.masses", massless)
    joints = joint_fields(settings.springs, settings.pendulums, coordinates)
    contacts = _contacts(settings.contacts, coordinates)
    inputs = _inputs(settings, coordinates, joints)
    sensors = settings.sensors.items()
    return Lumped(
        body_name=list(masses), coordinate_name=coordinates.names, coordinate_body=coordinates.body,
        mass=system.mass_matrix(masses, coordinates) + inertia_matrix(settings.inertias, coordinates),
        gyroscopic=system.gyroscopic_matrix(_gyros(settings.gyros), coordinates, "lumped.gyros"), **joints, **contacts,
        **inputs, pressure=settings.load_factors,
        **_preload(settings, coordinates, joints, contacts, inputs), sensor_name=[name for name, _ in sensors],
        sensor_rows=rows([connected(coordinates, s.along, f"lumped.sensors.{name}.along") for name, s in sensors],
                         coordinates),
        sensor_turns=[int(sees_angle(s.along)) for _, s in sensors], turning=turning(settings),
        sensor_quantity=[s.quantity for _, s in sensors], sensor_unit=[s.unit for _, s in sensors],
        sensor_gain=[s.gain for _, s in sensors])


def _contacts(contacts, coordinates):
    parts = {"normal": [], "tangent": [], "lateral": []}
    for name, contact in contacts.items():
        where = f"lumped.contacts.{name}"
        if bool(contact.normal) == (contact.normal_force is not None):
            raise ConfigError(where, "either normal, where it can open, or normal_force, for a friction joint",
                              "both" if contact.normal else "neither")
        if contact.normal_force is not None and contact.stiffness is not None:
            raise ConfigError(f"{where}.stiffness", "none beside normal_force", f"{contact.stiffness:g} N/m")
        for part, read in parts.items():
            combination = weights(getattr(contact, part), f"{where}.{part}", angles=False)
            row = coordinates.connected if combination else coordinates.row
            read.append(row(combination, f"{where}.{part}"))
        if not contact.tangent:
            coordinates.connected({}, f"{where}.tangent")
    closure, pressure, area = system.normal_law(contacts, "lumped.contacts")
    return {"contact_name": list(contacts), **{f"contact_{k}": rows(read, coordinates) for k, read in parts.items()},
            "contact_body": [coordinates.body[np.flatnonzero(row)[0]] for row in parts["tangent"]],
            "contact_area": area,
            "contact_lever": [c.lever for c in contacts.values()], "contact_gap": [c.gap for c in contacts.values()],
            "contact_position": np.reshape([(abs(c.lever) * np.cos(c.angle), abs(c.lever) * np.sin(c.angle), 0.0)
                                            for c in contacts.values()], (-1, 3)),
            "law_closure": closure, "law_pressure": pressure}


def _gyros(gyros):
    return {name: system.Gyro(g.axes, g.polar_inertia) for name, g in gyros.items()}


def _inputs(settings, coordinates, joints):
    """Rows, constant forces (per Pa) and histories of the inputs; a displacement is the force k u + c u'."""
    interval = settings.histories.interval
    time = interval * np.arange(round(settings.histories.duration / interval) + 1)
    along, constant, samples, sizes = [], [], [], []
    torsional = [name for name, spring in settings.springs.items() if is_torsional(spring)]
    for name, given in settings.inputs.items():
        where = f"lumped.inputs.{name}"
        size = _size(given, where)
        row, spring, damper = _input_row(given, coordinates, joints, torsional, where)
        shape = 1.0 if given.history is None else _shape(given.history, time, f"{where}.history")
        along.append(row)
        sizes.append(size)
        constant.append(spring * size if given.history is None else 0.0)
        samples.append(np.zeros(len(time)) if given.history is None else
                       size * (spring * shape + damper * np.gradient(shape, interval)))
    timed = any(i.history for i in settings.inputs.values())
    drive = [] if settings.drive is None else _shape(settings.drive.history, time, "lumped.drive.history")
    return {"input_name": list(settings.inputs), "input_rows": rows(along, coordinates), "input_area": constant,
            "input_joint": [i.displaces or "" for i in settings.inputs.values()], "input_scale": sizes,
            "history_interval": interval if timed or len(drive) else 0.0,
            "input_history": np.transpose(samples) if timed else np.empty((0, len(along))), "drive_history": drive}


def _input_row(given, coordinates, joints, torsional, where):
    """(row, N per unit, N s per unit) of one input."""
    if (given.along is None) == (given.displaces is None):
        raise ConfigError(where, "either along, for a force, or displaces, for a displacement",
                          "both" if given.along else "neither")
    if given.displaces is None:
        return row_along(coordinates, given.along, given.torque is not None, where), 1.0, 0.0
    k = system.index_of(given.displaces, joints["joint_name"], f"{where}.displaces")
    if (given.angle is not None) != (given.displaces in torsional):
        raise ConfigError(where, "an angle of a torsional spring, or a displacement of another", "the other way round")
    return joints["joint_rows"][k], joints["joint_stiffness"][k], joints["joint_damping"][k]


def _size(given, where):
    """Force or torque of an input, or displacement or angle of the end of a spring: the one that is stated."""
    kinds = ("force", "torque") if given.displaces is None else ("displacement", "angle")
    stated = [kind for kind in kinds if getattr(given, kind) is not None]
    if len(stated) != 1:
        raise ConfigError(f"{where}.{kinds[0]}", f"a value, or {kinds[1]} where rotations alone are moved",
                          "both" if stated else "none", "add it to the YAML" if not stated else None)
    return getattr(given, stated[0])


def _shape(history, time, where):
    """The history at ``time``; ConfigError for a frequency that its samples, joined by lines, do not follow."""
    highest = max((getattr(history, name, 0.0) for name in ("frequency", "first", "last")), default=0.0)
    if highest * _SAMPLES * time[1] > 1 + 1e-9:
        raise ConfigError("lumped.histories.interval", f"at most {1 / (_SAMPLES * highest):.3g} s, {_SAMPLES} samples a"
                          f" period at {highest:g} Hz", f"{time[1]:g} s", f"lower it, or the frequency of {where}")
    if isinstance(history, Harmonic):
        return input_histories.harmonic(time, history.frequency, history.phase)
    if isinstance(history, Chirp):
        return input_histories.chirp(time, history.first, history.last, history.sweep)
    if isinstance(history, Step):
        return input_histories.step(time, history.begin, history.rise)
    table = {name: waveform.values for name, waveform in waveforms("columns", history.file).items()}
    values = _column(table, history.column, f"{where}.column")
    instants = history.interval * np.arange(len(values))
    if history.time is not None:
        instants = _column(table, history.time, f"{where}.time")
    return input_histories.resampled(time, instants, values, f"{where}.file")


def _column(table, name, where):
    names = list(table)
    values = table[names[system.index_of(name, names, where)]]
    if not np.isfinite(values).all():
        raise ConfigError(where, "a number in every row", f"none in {np.sum(~np.isfinite(values))} rows")
    return values


def _preload(settings, coordinates, joints, contacts, inputs):
    """Static normal forces and contact stiffnesses of every state."""
    rows, stiffness = joints["joint_rows"], np.array(joints["joint_stiffness"])
    given = list(settings.contacts.values())
    fixed = np.array([c.normal_force is not None for c in given], bool)
    soft = np.array([c.stiffness or 0.0 for c in given])
    normal, gap = contacts["contact_normal"][~fixed], np.array(contacts["contact_gap"])[~fixed]
    compliance = np.divide(1.0, soft, out=np.zeros(len(soft)), where=soft > 0)[~fixed]
    preload = np.zeros((len(settings.load_factors), len(given)))
    for state, factor in enumerate(settings.load_factors):
        preload[state, fixed] = [factor * c.normal_force for c in given if c.normal_force is not None]
        if not fixed.all():
            load = factor * np.array(inputs["input_area"]) @ inputs["input_rows"]
            preload[state, ~fixed] = static_forces((rows.T * stiffness) @ rows, load, normal, gap, compliance)
    return {"preload": preload, "contact_stiffness": np.where(preload > 0, soft, 0.0)}

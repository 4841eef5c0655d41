"""Stage lumped: masses, springs, dampers, contacts, inputs and sensors of a minimal model, from the YAML alone.

Linear combinations {coordinate: weight} define the displacement on which a spring, contact, input or sensor acts:
weights of translations are numbers, those of rotations are radii ("30 mm").
"""

from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, InputFile, Quantities, Quantity, Section, option, stage
from pipeline.contract.units import to_si
from pipeline.physics.contact.static_forces import static_forces
from pipeline.physics.signals import input_histories
from pipeline.products import Lumped
from pipeline.recordings.columns import read_columns
from pipeline.systems import lumped as system

#: samples, joined by lines, that a period needs to keep its size within 2 %
_SAMPLES = 10


class Mass(Section):
    """One rigid body."""

    moves: tuple[str, ...] = option(..., "motions: x, y, z, rotation, tilt_x, tilt_y; coordinates are mass.motion")
    mass: Quantity("kg") = option("0 kg", "mass, needed for motions x, y, z")
    inertia: Quantity("kg m^2") = option("0 kg m^2", "moment of inertia, needed for rotation and tilts")
    grounded: bool = option(False, "the mass stands still")


class Spring(Section):
    """Spring and damper in parallel, between two coordinates or along a combination of several."""

    between: tuple[str, str] | None = option(None, "two coordinates, or one and ground")
    along: dict[str, str | float] | None = option(None, "elongation as a combination of coordinates")
    stiffness: Quantity("N/m") = option("0 N/m", "stiffness; below 0 it pushes away")
    damping: Quantity("N s/m", ge=0) = option("0 N s/m", "damping")


class Contact(Section):
    """Sliding contact with the drive: unilateral along ``normal``, or a joint with a given normal force."""

    tangent: dict[str, str | float] = option(..., "displacement of the rubbed mass along sliding")
    normal: dict[str, str | float] = option({}, "displacement that opens the contact; none for a friction joint")
    lateral: dict[str, str | float] = option({}, "displacement across sliding")
    normal_force: Quantity("N", ge=0) | None = option(None, "normal force of a friction joint, at load factor 1")
    stiffness: Quantity("N/m", gt=0) | None = option(None, "normal stiffness of the contact; none = hard")
    gap: Quantity("m") = option("0 mm", "gap in the unloaded position, negative where parts are set to press")
    lever: Quantity("m") = option("1 m", "sliding speed per speed of the drive: a radius, 1 m on a belt")
    area: Quantity("m^2", gt=0) | None = option(None, "contact area, where friction depends on pressure")
    angle: Quantity("rad") = option("0 deg", "where it sits about the axis of the drive, for what turns with the drive")


class Gyro(Section):
    """Gyroscopic moments of a mass that rotates with the drive."""

    axes: tuple[str, str] = option(..., "its two tilts, the first turning towards the second under the drive")
    polar_inertia: Quantity("kg m^2", gt=0) = option(..., "moment of inertia about the axis of the drive")


class Harmonic(Section):
    """sin(2 pi frequency t + phase)."""

    kind: Literal["harmonic"] = "harmonic"
    frequency: Quantity("Hz", gt=0) = option(..., "frequency")
    phase: Quantity("rad") = option("0 rad", "phase at time 0")


class Chirp(Section):
    """Sine of rising or falling frequency."""

    kind: Literal["chirp"] = "chirp"
    first: Quantity("Hz", ge=0) = option(..., "frequency at time 0")
    last: Quantity("Hz", ge=0) = option(..., "frequency at the end of the sweep")
    sweep: Quantity("s", gt=0) = option(..., "length of the sweep")


class Step(Section):
    """0, then 1."""

    kind: Literal["step"] = "step"
    begin: Quantity("s", ge=0) = option("0 s", "when it leaves 0")
    rise: Quantity("s", ge=0) = option("0 s", "how long it takes to reach 1")


class Recording(Section):
    """A column of a file: a text table with a header, MATLAB, or plain HDF5."""

    kind: Literal["file"] = "file"
    file: InputFile = option(..., "text table with one row of names, .mat, or .h5 with vectors at its root;"
                             " measured:PATH for a registered one")
    column: str = option(..., "name of the column")
    time: str | None = option(None, "name of the column of times in s; none = equal intervals")
    interval: Quantity("s", gt=0) = option("1 ms", "time between samples, where there is no column of times")


History = Harmonic | Chirp | Step | Recording


class Input(Section):
    """A force along a combination, or a displacement imposed on the far end of a spring."""

    along: dict[str, str | float] | None = option(None, "where the force acts; opposite signs: a pair of forces")
    force: Quantity("N") | None = option(None, "force at load factor 1, or per SI unit of the history or channel")
    displaces: str | None = option(None, "the spring whose far end is moved, against its elongation")
    displacement: Quantity("m") | None = option(None, "displacement of that end, or per SI unit of the history or"
                                                    " channel")
    history: History | None = option(None, "time history, with peak 1 where it is none of a file; none = constant",
                                     discriminator="kind")


class SensorSettings(Section):
    """What is measured along a combination."""

    along: dict[str, str | float] = option(..., "displacement that the sensor sees")
    quantity: Literal["displacement", "velocity", "acceleration"] = option("velocity", "what it measures")
    unit: str = option("m/s", "unit of its reading")
    gain: float = option(1.0, "its reading per SI unit of the quantity")


class Drive(Section):
    """Speed of the drive over time; it multiplies the nominal speed."""

    history: History = option(..., "harmonic: a reversing drive", discriminator="kind")


class Histories(Section):
    """Common samples of all time histories."""

    interval: Quantity("s", gt=0) = option("0.1 ms", "time between samples; linear between")
    duration: Quantity("s", gt=0) = option("1 s", "length; the last sample holds beyond")


class Settings(Section):
    """The whole system, every part by its name."""

    masses: dict[str, Mass] = option({}, "masses; at least one that can move")
    springs: dict[str, Spring] = option({}, "springs and dampers")
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
    _built(settings)
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
    built = _built(settings)
    context.log(f"coordinates: {', '.join(built.coordinate_name)}")
    return built


def _built(settings):
    masses = {name: system.Mass(m.moves, m.mass, m.inertia, m.grounded) for name, m in settings.masses.items()}
    coordinates = system.coordinates(masses, "lumped.masses")
    joints, contacts = _joints(settings.springs, coordinates), _contacts(settings.contacts, coordinates)
    inputs = _inputs(settings, coordinates, joints)
    sensors = settings.sensors.items()
    return Lumped(
        body_name=list(masses), coordinate_name=coordinates.names, coordinate_body=coordinates.body,
        mass=system.mass_matrix(masses, coordinates),
        gyroscopic=system.gyroscopic_matrix(_gyros(settings.gyros), coordinates, "lumped.gyros"), **joints, **contacts,
        **inputs, pressure=settings.load_factors,
        **_preload(settings, coordinates, joints, contacts, inputs), sensor_name=[name for name, _ in sensors],
        sensor_rows=_rows([_connected(coordinates, s.along, f"lumped.sensors.{name}.along") for name, s in sensors],
                          coordinates),
        sensor_turns=[_turns(s.along) for _, s in sensors],
        sensor_quantity=[s.quantity for _, s in sensors], sensor_unit=[s.unit for _, s in sensors],
        sensor_gain=[s.gain for _, s in sensors])


def _rows(rows, coordinates):
    return np.reshape(rows, (len(rows), len(coordinates.names)))


def _weights(combination, where):
    """{coordinate: weight} with numbers for translations and radii in m for rotations."""
    weights = {}
    for name, weight in combination.items():
        turns = name.rpartition(".")[2] in system.ROTATIONS
        weights[name] = to_si(weight, "m" if turns else "1", f"{where}.{name}")
    return weights


def _turns(combination):
    """1 where a combination sees rotations alone, the largest weight being a radius of 1 m; else 0."""
    weights = _weights(combination, "sensor")
    rotations = all(name.rpartition(".")[2] in system.ROTATIONS for name in weights)
    return int(rotations and max(map(abs, weights.values())) == 1)


def _connected(coordinates, combination, where):
    return coordinates.connected(_weights(combination, where), where)


def _joints(springs, coordinates):
    rows = []
    for name, spring in springs.items():
        where = f"lumped.springs.{name}"
        if (spring.between is None) == (spring.along is None):
            raise ConfigError(where, "either between or along", "both" if spring.between else "neither",
                              "name what the spring connects, as in between: [block.x, ground]")
        if spring.along is not None:
            rows.append(_connected(coordinates, spring.along, f"{where}.along"))
            continue
        first, second = spring.between
        row = coordinates.row({first: 1.0}, f"{where}.between") - coordinates.row({second: 1.0}, f"{where}.between")
        rows.append(row if row.any() else coordinates.connected({}, f"{where}.between"))
    return {"joint_name": list(springs), "joint_rows": _rows(rows, coordinates),
            "joint_stiffness": [s.stiffness for s in springs.values()],
            "joint_damping": [s.damping for s in springs.values()]}


def _contacts(contacts, coordinates):
    parts = {"normal": [], "tangent": [], "lateral": []}
    for name, contact in contacts.items():
        where = f"lumped.contacts.{name}"
        if bool(contact.normal) == (contact.normal_force is not None):
            raise ConfigError(where, "either normal, where it can open, or normal_force, for a friction joint",
                              "both" if contact.normal else "neither")
        if contact.normal_force is not None and contact.stiffness is not None:
            raise ConfigError(f"{where}.stiffness", "none beside normal_force", f"{contact.stiffness:g} N/m")
        for part, rows in parts.items():
            combination = _weights(getattr(contact, part), f"{where}.{part}")
            read = coordinates.connected if combination else coordinates.row
            rows.append(read(combination, f"{where}.{part}"))
        if not contact.tangent:
            coordinates.connected({}, f"{where}.tangent")
    closure, pressure, area = system.normal_law(contacts, "lumped.contacts")
    return {"contact_name": list(contacts), **{f"contact_{k}": _rows(rows, coordinates) for k, rows in parts.items()},
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
    rows, constant, samples, sizes = [], [], [], []
    for name, given in settings.inputs.items():
        where = f"lumped.inputs.{name}"
        row, spring, damper = _input_row(given, coordinates, joints, where)
        shape = 1.0 if given.history is None else _shape(given.history, time, f"{where}.history")
        size = given.force if given.displaces is None else given.displacement
        rows.append(row)
        sizes.append(size)
        constant.append(spring * size if given.history is None else 0.0)
        samples.append(np.zeros(len(time)) if given.history is None else
                       size * (spring * shape + damper * np.gradient(shape, interval)))
    timed = any(i.history for i in settings.inputs.values())
    drive = [] if settings.drive is None else _shape(settings.drive.history, time, "lumped.drive.history")
    return {"input_name": list(settings.inputs), "input_rows": _rows(rows, coordinates), "input_area": constant,
            "input_joint": [i.displaces or "" for i in settings.inputs.values()], "input_scale": sizes,
            "history_interval": interval if timed or len(drive) else 0.0,
            "input_history": np.transpose(samples) if timed else np.empty((0, len(rows))), "drive_history": drive}


def _input_row(given, coordinates, joints, where):
    """(row, N per unit, N s per unit) of one input."""
    if (given.along is None) == (given.displaces is None):
        raise ConfigError(where, "either along, for a force, or displaces, for a displacement",
                          "both" if given.along else "neither")
    needed = "force" if given.displaces is None else "displacement"
    if getattr(given, needed) is None:
        raise ConfigError(f"{where}.{needed}", "a value", "none", "add it to the YAML")
    if given.displaces is None:
        return _connected(coordinates, given.along, f"{where}.along"), 1.0, 0.0
    k = system.index_of(given.displaces, joints["joint_name"], f"{where}.displaces")
    return joints["joint_rows"][k], joints["joint_stiffness"][k], joints["joint_damping"][k]


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
    table = read_columns(history.file)
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

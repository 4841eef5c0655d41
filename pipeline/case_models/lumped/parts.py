"""Sections of the parts of a lumped system.

Linear combinations {coordinate: weight} define the displacement on which a spring, contact, input or sensor acts:
weights of translations are numbers, those of rotations are radii ("30 mm"). A combination of rotations alone may have
numbers, too: it is an angle then, with torques and torsional stiffnesses.
"""

from typing import Literal

from pipeline.contract import InputFile, Quantity, Section, option


class Mass(Section):
    """One rigid body."""

    moves: tuple[str, ...] = option(..., "motions: x, y, z, rotation, tilt_x, tilt_y; coordinates are mass.motion")
    mass: Quantity("kg") = option("0 kg", "mass, needed for motions x, y, z")
    inertia: Quantity("kg m^2") = option("0 kg m^2", "moment of inertia, needed for rotation and tilts")
    grounded: bool = option(False, "the mass stands still")


class Spring(Section):
    """Spring and damper in parallel, between two coordinates or along a combination of several."""

    between: tuple[str, str] | None = option(None, "two coordinates, or one and ground; elongation: first less second")
    along: dict[str, str | float] | None = option(None, "elongation as a combination of coordinates")
    stiffness: Quantity("N/m") = option("0 N/m", "stiffness; below 0 it pushes away")
    damping: Quantity("N s/m", ge=0) = option("0 N s/m", "damping")
    torsional_stiffness: Quantity("N m/rad") | None = option(None, "stiffness where rotations alone are connected")
    torsional_damping: Quantity("N m s/rad", ge=0) | None = option(None, "damping there")


class Inertia(Section):
    """Mass that moves along a combination of coordinates and couples them, as a centre of gravity off the axis does."""

    along: dict[str, str | float] = option(..., "how it moves")
    mass: Quantity("kg", gt=0) | None = option(None, "its mass")
    inertia: Quantity("kg m^2", gt=0) | None = option(None, "its moment of inertia, where rotations alone move it")


class Pendulum(Section):
    """Weight that a rotation lifts: a torsional spring m g l about the vertical, for swings of up to about 0.2 rad.

    The moment -m g l sin(t) of larger ones is that spring with an effect ``cubic_stiffness`` of -m g l / 6 at its
    joint.
    """

    swings: dict[str, str | float] = option(..., "the angle between arm and vertical")
    mass: Quantity("kg", gt=0) = option(..., "mass whose weight pulls the arm back; its inertia is that of the body")
    length: Quantity("m") = option(..., "from the axis down to its centre of gravity; below 0 m: upright")
    gravity: Quantity("m/s^2", gt=0) = option("9.80665 m/s^2", "gravity")


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

    along: dict[str, str | float] | None = option(None, "where the force acts, positive as the coordinate counts;"
                                                                  " opposite signs: a pair of forces")
    force: Quantity("N") | None = option(None, "force at load factor 1, or per SI unit of the history or channel")
    displaces: str | None = option(None, "the spring whose far end is moved, against its elongation")
    displacement: Quantity("m") | None = option(None, "displacement of that end, positive as the first coordinate of"
                                                    " its spring counts, or per SI unit of the history or channel")
    torque: Quantity("N m") | None = option(None, "torque along rotations alone, in place of a force")
    angle: Quantity("rad") | None = option(None, "rotation of the end of a torsional spring, in place of a"
                                               " displacement")
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

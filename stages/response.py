"""Stage response: vibration of the elastic brake under the contact forces of the multi-body simulation."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.physics.fem.force_mapping import circle_table
from pipeline.physics.fem.mesh import Mesh, boundary_faces
from pipeline.physics.modal.modal_superposition import Points, fixed_points, modal_response, sharpened, undamped_modes
from pipeline.physics.signals.spectra import power_spectrum
from pipeline.physics.sliding.model import sliding_model
from pipeline.products import Multibody, ReducedModel, Response, Structure

#: samples per period of the highest mode below which its velocity is not shown faithfully
_SAMPLES_PER_PERIOD = 2.5


class Settings(Section):
    """Load on the elastic brake, and the modes that respond."""

    coupling: Literal["disc", "released", "assembly"] = option(
        "disc", "disc: the disc alone, turning; released: the whole brake with open contacts; assembly: with closed"
        " contacts as in the paper, which counts them twice")
    forces: Literal["friction", "friction_and_normal"] = option(
        "friction_and_normal", "which contact forces are applied")
    load: Literal["fluctuation", "whole"] = option(
        "fluctuation", "fluctuation: from equilibrium at the first sample; whole: raised from zero during 'ramp'")
    ramp: Quantity("s", gt=0) = option("10 ms", "half-cosine rise of the whole load")
    highest_frequency: Quantity("Hz", gt=0) = option("20 kHz", "modes below it are superposed")
    resolution: Quantity("Hz", gt=0) = option("50 Hz", "distance of the lines of the spectra")
    settling: Quantity("s", ge=0) = option("50 ms", "begin of the signals that the spectra leave out")
    circle_angles: int = option(1440, "disc coupling: angles at which mode shapes are tabulated around a circle", ge=8)


@dataclass(frozen=True)
class _Superposition:
    """Modes, where the forces act on them and where they are seen."""

    angular_frequency: np.ndarray
    damping: np.ndarray
    force_points: Points
    sensor_points: Points
    turning: float = 0.0


def _check(sections):
    """Refuse, before anything is computed, operating points without preload, signals that end before they settle, and
    bands beyond the modes that are there."""
    motion, solved = sections["multibody"], sections["structure"].pressures
    for pressure in motion.pressures:
        if not np.isclose(solved, pressure, rtol=1e-6).any():
            raise ConfigError("multibody.pressures", f"pressures among structure.pressures, {list(solved)} Pa",
                              f"{pressure:g} Pa", "add it to structure.pressures")
    for name in ("response", "squeal"):
        if sections[name].settling >= motion.duration:
            raise ConfigError(f"{name}.settling", f"less than multibody.duration, {motion.duration:g} s",
                              f"{sections[name].settling:g} s")
    for name, last, until in (("response", "structure", "frequency_max"), ("squeal", "response", "highest_frequency")):
        asked, there = sections[name].highest_frequency, getattr(sections[last], until)
        if asked > there:
            raise ConfigError(f"{name}.highest_frequency", f"at most {last}.{until}, {there:g} Hz", f"{asked:g} Hz",
                              f"raise {last}.{until} too: what lies above it is missing")


@stage(check=_check)
def response(structure: Structure, model: ReducedModel, multibody: Multibody, settings: Settings,
             context: Context) -> Response:
    """Compute the response of the elastic brake to the contact forces by modal superposition.

    The forces were computed on a rigid disc and contain all that the contact does, the reaction of the
    pads included. They are the only thing that passes between pads and disc, so each side must carry them
    without contact springs.

    Coupling 'disc': the elastic disc alone, in its rotating frame, at points fixed in space (gyroscopic and
    centrifugal terms are neglected: the disc rotates by a hundredth of a radian per radian of its slowest
    mode). Coupling 'released': the whole brake with open contacts. Its disc is the same but does not turn;
    pads and caliper repeat the motion that they had in the multibody simulation, so that sensors may lie
    on them.

    Coupling 'assembly' is the paper's variant (section 2.1.6): the modes of the whole brake, with contact
    springs between pads and disc. It counts the contact twice. The normal forces already include the
    spring forces due to the pad motion, and load the same springs again; along sliding, the pads respond
    a second time, at resonance, to friction forces that already follow their motion. Tones at the pad
    frequencies are exaggerated: at 7 kHz the normal forces add 10 to 50 % to the response to friction.

    The disc without the pads, on the other hand, lacks their support and responds several times as
    strongly below 1 kHz. That is the limit of every one-way analysis: only an elastic disc in the
    simulation of the contact itself resolves it.

    'forces: friction' omits the normal forces.

    The load 'fluctuation' is the force minus its first sample: motion about the static equilibrium from
    which the multibody simulation starts.

    Method:
    The contact forces of the multibody simulation ({forces}, {load}) were applied to the real modes of the brake below
    {highest_frequency} (coupling: {coupling}). Modal superposition used the exact recursion for piecewise-linear
    forces, corrected for the amplitude loss of linear interpolation (sinc^2 of frequency times sampling interval), with
    diagonal modal damping. Spectra are Welch estimates with a resolution of {resolution}, after {settling}.
    """
    step = _checked_step(multibody.time, settings)
    build = {"assembly": partial(_brake, closed=True), "released": partial(_brake, closed=False),
             "disc": _turning_disc}[settings.coupling]
    sensors, superpositions = build(structure, model, multibody, settings)
    components = {"friction": (multibody.friction_force,),
                  "friction_and_normal": (multibody.normal_force, multibody.friction_force)}[settings.forces]
    tasks = [(superposition, [component[operating] for component in components])
             for operating, superposition in enumerate(superpositions)]
    velocity = np.array(context.map(partial(_vibrate, step=step, settings=settings), tasks, "modal superposition"))
    frequency, spectrum = power_spectrum(velocity[..., multibody.time >= settings.settling].astype(float), 1 / step,
                                         settings.resolution)
    return Response(
        pressure=multibody.pressure, speed=multibody.speed, time=multibody.time, velocity=velocity,
        sensor_name=structure.sensor_name[sensors], sensor_position=structure.sensor_position[sensors],
        frequency=frequency, velocity_spectrum=spectrum, coupling=settings.coupling, **_mode_table(superpositions))


def _checked_step(time, settings):
    step = (time[-1] - time[0]) / (len(time) - 1)
    longest = 1 / (_SAMPLES_PER_PERIOD * settings.highest_frequency)
    if step > longest * (1 + 1e-9):
        raise ConfigError("response.highest_frequency", f"force samples at most {longest:.3g} s apart", f"{step:.3g} s",
                          "record the multi-body forces more often, or lower the highest frequency")
    if settings.settling >= time[-1]:
        raise ConfigError("response.settling", f"less than the simulated {time[-1]:.3g} s",
                          f"{settings.settling:.3g} s")
    return step


def _brake(structure, model, multibody, settings, closed):
    """Sensors and, per operating point, the modes of the whole brake, contacts ``closed`` about its preload or open."""
    superpositions = []
    for pressure, speed in zip(multibody.pressure, multibody.speed, strict=True):
        sliding = sliding_model(model, _preload_state(model, pressure), speed)
        mass, damping, stiffness = (sliding.frictionless if closed else sliding.supported)(gyroscopic=False)
        angular, shape = undamped_modes(mass, stiffness, settings.highest_frequency)
        rows = _chosen(settings, sliding.contacts.normal, sliding.contacts.tangent)
        superpositions.append(_Superposition(angular, np.einsum("cm,cm->m", shape, damping @ shape),
                                             fixed_points(rows @ shape), fixed_points(sliding.sensor_rows @ shape)))
    return np.arange(len(model.sensor_name)), superpositions


def _chosen(settings, normal, tangent):
    """Rows of the forces that are applied, in the order of the forces."""
    return tangent if settings.forces == "friction" else np.concatenate([normal, tangent])


def _preload_state(model, pressure):
    state = int(np.argmin(np.abs(model.pressure - pressure)))
    if not np.isclose(model.pressure[state], pressure, rtol=1e-6):
        raise ConfigError("response: pressure of the operating point", f"one of {model.pressure.tolist()} Pa",
                          f"{pressure:g} Pa", "solve the preload of the structure at this pressure")
    return state


def _turning_disc(structure, model, multibody, settings):
    """Sensors on the disc and, per operating point, the modes of the disc alone under points that stay in place."""
    body, disc = list(structure.body_name).index("disc"), structure.disc
    rows = structure.sensor_rows
    elsewhere = set(rows.row[rows.body != body])
    sensors = np.array([s for s in range(len(structure.sensor_name)) if s not in elsewhere], dtype=int)
    if not len(sensors):
        raise ConfigError("response.coupling", "a sensor on the disc", "none", "declare one in the structure")
    kept = disc.frequency < settings.highest_frequency
    angular = 2 * np.pi * disc.frequency[kept]
    read = partial(_circle_points, disc, disc.shape[kept], settings.circle_angles)
    outwards = np.where(structure.contact_body == list(structure.body_name).index("pad_outer"), 1.0, -1.0)
    none = np.zeros_like(outwards)
    normal, tangent = np.stack([none, none, -outwards], axis=1), np.stack([none, none - 1, none], axis=1)
    directions = _chosen(settings, normal, tangent)
    positions = np.tile(structure.contact_position, (len(directions) // len(outwards), 1))
    seen = structure.sensor_position[sensors]
    damping = (2 * disc.damping_ratio + disc.loss_factor.max(initial=0.0)) * angular
    base = _Superposition(angular, damping, read(positions, directions),
                          read(seen, _cylindrical(seen, structure.sensor_direction[sensors])))
    return sensors, [replace(base, turning=speed) for speed in multibody.speed]


def _circle_points(disc, shape, angles, position, direction):
    """Points of the laboratory at ``position`` (p, 3) with cylindrical ``direction`` (p, 3), on the turning disc."""
    radius, height = np.hypot(position[:, 0], position[:, 1]), position[:, 2]
    circles, circle = np.unique(np.round(np.column_stack([radius, height, direction]), 9), axis=0, return_inverse=True)
    face = boundary_faces(Mesh(disc.node, disc.element, disc.kind.item(), np.zeros((len(disc.element), 3), int)))
    table = [circle_table(disc.node, face, shape, c[0], c[1], c[2:], angles) for c in circles]
    return Points(np.array(table), circle.ravel(), np.arctan2(position[:, 1], position[:, 0]))


def _cylindrical(position, direction):
    """Cartesian directions in radial, tangential and axial components."""
    radial = position[:, :2] / np.linalg.norm(position[:, :2], axis=1, keepdims=True)
    x, y = direction[:, 0], direction[:, 1]
    return np.column_stack([radial[:, 0] * x + radial[:, 1] * y, radial[:, 0] * y - radial[:, 1] * x, direction[:, 2]])


def _vibrate(task, step, settings):
    """(sensor, time) velocity at one operating point."""
    superposition, components = task
    s, forces = superposition, np.concatenate(components).T.astype(float)
    velocity = modal_response(s.angular_frequency, s.damping, step, sharpened(_applied(forces, step, settings)),
                              s.force_points, s.sensor_points, s.turning)[1]
    return velocity.T.astype(np.float32)


def _applied(forces, step, settings):
    if settings.load == "fluctuation":
        return forces - forces[0]
    rise = np.minimum(np.arange(len(forces)) * step / settings.ramp, 1)
    return forces * (0.5 - 0.5 * np.cos(np.pi * rise))[:, None]


def _mode_table(superpositions):
    """Frequencies and damping ratios of all modes, with their operating point."""
    angular = np.concatenate([s.angular_frequency for s in superpositions])
    damping = np.concatenate([s.damping for s in superpositions])
    ratio = np.divide(damping, 2 * angular, out=np.zeros_like(angular), where=angular > 0)
    operating = np.repeat(np.arange(len(superpositions)), [len(s.angular_frequency) for s in superpositions])
    return {"mode_operating": operating, "mode_frequency": angular / (2 * np.pi), "mode_damping": ratio}

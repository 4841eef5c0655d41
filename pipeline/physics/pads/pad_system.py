"""Reduced pads and caliper on a rigid disc: M q'' + C q' + K q = load + contact force."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import (
    BACKWARD,
    EXPONENT,
    READ_AT,
    RIGID,
    STATIC,
    STIFFNESS,
    Friction,
    kernel,
)
from pipeline.physics.friction.state_variables import state_kernel
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.patch_contact import SUB_DISCS, PatchContact, add, contact_force, contact_tangent
from pipeline.physics.time_stepping.coupled_solver import no_memory
from pipeline.physics.time_stepping.element_forces import LawKernel, element_force
from pipeline.physics.time_stepping.elements import alone
from pipeline.physics.time_stepping.normal_laws import Table, normal_kernel
from pipeline.physics.time_stepping.rigid_friction import located

#: steps in a period of the mass along dry friction that sticks on a spring
STICK_STEPS = 16
#: residual of a time step, as a share of the load
STEP_TOLERANCE = 1e-8
#: patches whose radii and heights differ by less than this share of the radius lie on one circle
SAME_CIRCLE = 1e-6


class PadElements(NamedTuple):
    """e nonlinear elements on the assembly, and the memory of those that have one."""

    law: LawKernel
    rows: np.ndarray        # (e, n) elongation
    offset: np.ndarray      # (e,) m, elongation where all coordinates are zero
    begin: np.ndarray       # (e,) m, elongation after the last accepted step
    memory: np.ndarray      # (s,) what they remember from there
    ahead: np.ndarray       # (s,) what they would remember after the motion that was seen last


def pad_elements(elements, size):
    """PadElements of Elements of ``size`` coordinates n."""
    rows = np.array([e.row for e in elements], float).reshape(len(elements), size)
    kernel = alone(elements)
    return PadElements(LawKernel(*(getattr(kernel, name) for name in LawKernel._fields)), rows, np.zeros(len(rows)),
                       np.zeros(len(rows)), no_memory(kernel), no_memory(kernel))


def on_springs(elements, mass, step):
    """Elements whose rigid dry friction gives way before it slides, by as little as a ``step`` (s) resolves.

    ``mass`` (n, n) kg. Newton's method needs a slope at rest: here 16 steps in a period of the mass on that spring.
    """
    mobility = [float(e.row @ np.linalg.solve(mass, e.row)) for e in elements]
    return tuple(replace(e, law=replace(e.law, stiffness=(2 * np.pi / STICK_STEPS / step) ** 2 / mobile))
                 if located(e) else e for e, mobile in zip(elements, mobility, strict=True))


class PadSystem(NamedTuple):
    """Equation of motion of the assembly without its disc; n coordinates, SI units."""

    mass: np.ndarray        # (n, n) kg
    damping: np.ndarray     # (n, n) N s/m, bodies and joints
    stiffness: np.ndarray   # (n, n) N/m, bodies and joints
    load: np.ndarray        # (n,) N, generalised force of the pistons
    contact: PatchContact
    elements: PadElements = pad_elements((), 0)


def pad_system(sliding, input_force, closure, pressure, friction, bedding, bedding_share, sectors, ramp, stick_speed,
               damping_speed):
    """PadSystem of a SlidingModel without its disc (``sliding.held("disc")``), at the speed of that model.

    ``input_force`` (i,) N; ``closure`` (k,) m and ``pressure`` (k,) Pa: normal law; ``friction``: FrictionLaw;
    ``bedding`` (4,) m: distance of the sub-discs on the friction map at the start; ``bedding_share``: part of the
    distance slid that counts on the map; ``sectors`` per revolution; ``ramp`` s; ``stick_speed`` and
    ``damping_speed`` m/s. Raises ConfigError.
    """
    _check(closure, pressure, bedding, sectors)
    contacts, (mass, damping, stiffness) = sliding.contacts, sliding.supported()
    count = len(contacts.area)
    contact = PatchContact(
        rows=np.array([contacts.normal, contacts.tangent, contacts.lateral]),
        law=normal_kernel(Table(closure, pressure, damping_speed), contacts),
        dry=pad_friction(Friction(friction), count), radius=contacts.lever,
        angle=np.arctan2(contacts.position[:, 1], contacts.position[:, 0]),
        half_angle=half_angles(contacts.position, contacts.area), bedding=np.array(bedding),
        bedding_speed=bedding_share * sliding.speed * np.mean(contacts.lever), disc_speed=float(sliding.speed),
        sectors=int(sectors), ramp=float(ramp), stick_speed=float(stick_speed),
        waviness=np.empty((0, 6)), scatter=np.empty((0, 4)), states=state_kernel(Friction(friction), contacts.area),
        wear=np.zeros(count), receded=np.zeros((2, count)))
    arrays = {name: np.array(value) for name, value in contact._asdict().items() if isinstance(value, np.ndarray)}
    return PadSystem(mass, damping, stiffness, input_force @ sliding.input_rows, contact._replace(**arrays),
                     pad_elements((), sliding.size))


def pad_friction(friction, count):
    """FrictionKernel of a Friction, Grouped or not, without what contacts ask for that stick or slide backwards.

    Pads do neither: friction is regularised, and read at the distance of the sub-discs.
    """
    dry = kernel(friction, count)
    contact = dry.contact.copy()
    contact[:, [READ_AT, STATIC, BACKWARD, STIFFNESS, EXPONENT]] = 0.0
    return dry._replace(contact=contact, description=RIGID)


def half_angles(position, area):
    """(c,) half of the angle in rad that each patch spans: patches on one circle meet halfway, without overlap.

    ``position`` (c, 3) m: centroids, the disc turning about z; ``area`` (c,) m^2: a patch alone on its circle
    (radius and height, so that the pads are apart) counts as square.
    """
    radius, angle = np.hypot(position[:, 0], position[:, 1]), np.arctan2(position[:, 1], position[:, 0])
    circle = np.column_stack([radius, position[:, 2]])
    apart = np.abs(np.angle(np.exp(1j * (angle[:, None] - angle))))
    apart[np.linalg.norm(circle[:, None] - circle, axis=2) > SAME_CIRCLE * radius] = np.inf
    np.fill_diagonal(apart, np.inf)
    nearest = apart.min(axis=1)
    return np.where(np.isfinite(nearest), nearest / 2, np.sqrt(area) / (2 * radius))


def _check(closure, pressure, bedding, sectors):
    if closure[0] != 0 or pressure[0] != 0 or np.any(np.diff(closure) <= 0) or np.any(np.diff(pressure) <= 0):
        raise ConfigError("multibody: normal contact law", "closure and pressure that rise from 0",
                          f"closures from {closure[0]:g} m and pressures from {pressure[0]:g} Pa")
    if len(bedding) != SUB_DISCS:
        raise ConfigError("multibody.bedding", f"{SUB_DISCS} distances, one per sub-disc", f"{len(bedding)}")
    if sectors % SUB_DISCS or sectors < SUB_DISCS:
        raise ConfigError("multibody.sectors", f"a multiple of {SUB_DISCS}", f"{sectors}")


@njit
def force(system, time, displacement, velocity):
    """M q'' (n,): load and contact force less elastic and damping forces, and those of elements."""
    result = contact_force(system.contact, time, displacement, velocity)
    elastic, viscous = system.stiffness @ displacement, system.damping @ velocity
    for i in range(result.size):
        result[i] = system.load[i] + result[i] - (elastic[i] + viscous[i])
    for k in range(system.elements.offset.size):
        element = element_at(system, k, time, displacement, velocity)[0]
        for i in range(result.size):
            result[i] -= element * system.elements.rows[k, i]
    return result


@njit
def tangent(system, time, displacement, velocity):
    """(stiffness, damping), both (n, n): minus the exact derivatives of ``force``."""
    stiffness, damping = contact_tangent(system.contact, time, displacement, velocity)
    add(stiffness, system.stiffness)
    add(damping, system.damping)
    for k in range(system.elements.offset.size):
        _, slope, drag = element_at(system, k, time, displacement, velocity)
        row = system.elements.rows[k]
        for i in range(row.size):
            for j in range(row.size):
                stiffness[i, j] += slope * (row[i] * row[j])
                damping[i, j] += drag * (row[i] * row[j])
    return stiffness, damping


@njit
def element_at(system, k, time, displacement, velocity):
    """(F, dF/de, dF/dv) of element ``k``; fills ``ahead`` with what it would remember there."""
    elements, speed = system.elements, system.contact.disc_speed
    row = elements.rows[k]
    elongation, instant = elements.offset[k] + row @ displacement, (time, speed * time, speed)
    return element_force(elements.law, k, elongation, row @ velocity, elements.begin[k], elements.memory,
                         elements.ahead, instant)

"""Small systems of pads on the rigid disc for tests: a block on a belt, a two-mode flutter model, a random assembly."""

from dataclasses import replace

import numpy as np

from pipeline.physics.friction.dry_friction import Friction, kernel
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.friction.state_variables import state_kernel
from pipeline.physics.pads.pad_system import PadSystem
from pipeline.physics.pads.patch_contact import PatchContact
from pipeline.physics.time_stepping.normal_laws import Table, normal_kernel
from tests.physics.lumps import lumps

FAR = 1e-2


def contacts(normal, tangent, lateral=None, friction=0.4, speed=10.0, stiffness=1e8, damping_speed=np.inf, law=None,
             area=1e-4, **more):
    """PatchContact with a linear law of ``stiffness`` N/m per contact of ``area`` m^2, or with a ``law``, a Table.

    ``friction``: a number or a FrictionLaw.
    """
    count, lateral = len(normal), np.zeros_like(tangent) if lateral is None else lateral
    if np.isscalar(friction):
        friction = FrictionLaw([0.0, 1e9], [0.0, 100.0], [0.0, 1.0], np.full((2, 2, 2), friction))
    closure = np.array([0.0, FAR / 2, FAR])
    law = law or Table(closure, stiffness / area * closure, damping_speed)
    pressed = replace(lumps(np.ones(np.shape(normal)[1]), normal=normal, tangent=tangent).contacts,
                      area=np.full(count, area))
    contact = PatchContact(
        rows=np.array([normal, tangent, lateral]), law=normal_kernel(law, pressed),
        dry=kernel(Friction(friction), count), radius=np.full(count, 0.1), angle=np.linspace(-0.5, 0.5, count),
        half_angle=np.full(count, 0.05), bedding=np.full(4, 0.5), bedding_speed=0.0, disc_speed=speed, sectors=16,
        ramp=0.0, stick_speed=1e-3, waviness=np.empty((0, 6)), scatter=np.empty((0, 4)),
        states=state_kernel(Friction(friction), pressed.area), wear=np.zeros(count), receded=np.zeros((2, count)))
    return contact._replace(**more)


def block_on_belt(mass=2.0, spring=1e5, damping=0.0, load=50.0, **more):
    """One block: coordinate 0 along sliding on a spring, coordinate 1 normal, pressed down by ``load``."""
    contact = contacts(np.array([[0.0, 1.0]]), np.array([[1.0, 0.0]]), **more)
    return PadSystem(mass * np.eye(2), damping * np.eye(2), np.diag([spring, 0.0]), np.array([0.0, -load]), contact)


def flutter(k11, k22, k12, k_friction, friction, load=50.0, **more):
    """Unit masses with K = [[k11, k12 - mu k_friction], [k12, k22]]; the contact stiffness is part of k22."""
    contact = contacts(np.array([[0.0, 1.0]]), np.array([[-1.0, 0.0]]), friction=friction, stiffness=k_friction, **more)
    stiffness = np.array([[k11, k12], [k12, k22 - k_friction]])
    return PadSystem(np.eye(2), np.zeros((2, 2)), stiffness, np.array([0.0, -load]), contact)


def random_assembly(seed=1, size=12, count=8, friction=1.0):
    """Elastic assembly with a curved normal law and friction that varies over pressure, speed and distance.

    ``friction``: factor on the coefficient.

    Its static start is at zero, with 60 N on every contact.
    """
    rng = np.random.default_rng(seed)
    rows = [rng.normal(size=(count, size)) / np.sqrt(size) for _ in range(3)]
    closure = np.linspace(0, 4e-6, 30)
    pressures, speeds, distances = np.array([0, 1e6, 2e6, 9e6]), np.array([0.1, 0.9, 1.5]), np.array([0, 5e-3, 1e-2])
    table = friction * (0.35 + 0.05 * np.sqrt(pressures / 1e6)[:, None, None] - 0.06 * speeds[:, None]
                        + 8.0 * distances)
    pressure, area, preload = 2e11 * closure + 1e17 * closure**2, 5e-5, np.full(count, 60.0)
    law = Table(closure, pressure, 2.0, gap=-np.interp(preload / area, pressure, closure))
    contact = contacts(
        *rows, law=law, area=area, friction=FrictionLaw(pressures, speeds, distances, table),
        bedding=np.array([1, 3, 5, 7]) * 1e-3, bedding_speed=0.02, speed=9.0, ramp=1e-3, half_angle=np.full(count, 0.3))
    basis, _ = np.linalg.qr(rng.normal(size=(size, size)))
    stiffness = 0.05 * (basis * (2 * np.pi * np.geomspace(300, 2e4, size)) ** 2) @ basis.T
    stiffness = (stiffness + stiffness.T) / 2
    return PadSystem(0.05 * np.eye(size), 2e-6 * stiffness + 1.0 * np.eye(size), stiffness,
                     -rows[0].T @ preload, contact)

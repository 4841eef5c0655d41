"""Pin and disc: dimensions, declared compliances, rows, and what cannot be built."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.supports import held_modes
from pipeline.physics.numerics.sparse_solver import available
from pipeline.systems.pin_on_disc import DISC, PIN, build, pin, reshaped, sliding_flexibility

pytestmark = pytest.mark.exact


def parameters(**changes):
    """A coarse system; ``changes`` are part__name=value."""
    parts = {
        "disc": {"shaft_radius": 0.008, "hub_radius": 0.0188, "outer_radius": 0.179, "thickness": 0.025, "young": 70e9,
                 "poisson": 0.33, "density": 2700.0, "rocking_stiffness": 8.2e5, "damping_ratio": 1e-3,
                 "radial_cells": 4, "angular_cells": 24, "axial_cells": 1},
        "pin": {"length": 0.1465, "clamp_length": 0.02, "side": 0.01, "axial_cells": 12, "cells_across": 1,
                "density": 2700.0, "tip_mass": 1.3e-3, "tip_cell": 0.002, "base_mass": 0.005, "young": 70e9,
                "poisson": 0.33, "damping_ratio": 1e-3, "tilt": np.radians(4), "clamp_stiffness": 1e10,
                "loss_time": 0.0},
        "contact": {"radius": 0.159, "offset": -0.0045, "width": 0.01, "length": 0.0005},
        "sensors": {"pin_side": "outer", "pin_height": 0.05, "disc_radius": 0.159, "disc_angle": np.pi}}
    for name, value in changes.items():
        part, key = name.split("__")
        parts[part][key] = value
    return SimpleNamespace(**{name: SimpleNamespace(**values) for name, values in parts.items()})


def clamped_frequencies(body, count):
    held = np.unique(body.mesh.element[body.element_material == 2])
    return held_modes(*body.matrices(), held, available()[0], count=count)[0]


@pytest.fixture(scope="module")
def system():
    return build(parameters())


def test_masses_are_those_declared(system):
    ones = np.tile([0.0, 0.0, 1.0], len(system.bodies[PIN].mesh.node))
    _, mass = system.bodies[PIN].matrices()
    assert ones @ mass @ ones == pytest.approx(2700 * 1e-4 * 0.1465 + 1.3e-3 + 0.005, rel=1e-9)


def test_pin_bends_as_a_cantilever_without_its_accelerometer():
    """Euler and Bernoulli; a rigid clamp hinders the section from widening, which adds 0.2 %."""
    bar = pin(parameters(pin__tip_mass=0.0, pin__length=0.2, pin__axial_cells=40, pin__cells_across=2))
    slender = 1.8751**2 / (2 * np.pi * 0.2**2) * np.sqrt(70e9 * 1e-4**2 / 12 / (2700 * 1e-4))
    found = clamped_frequencies(bar, 2)
    assert found == pytest.approx([slender, slender], rel=3e-3)


def test_shaft_gives_way_as_declared(system):
    """Rocking of a rigid body: the disc's inertia about its diameter on the declared spring, hub and disc stiff."""
    stiff = build(parameters(disc__rocking_stiffness=8.2e3)).bodies[DISC]
    found = held_modes(*stiff.matrices(), stiff.supported, available()[0], count=3)[0]
    weight = 2700 * np.pi * (0.179**2 - 0.008**2) * 0.025
    inertia = weight * ((0.179**2 + 0.008**2) / 4 + 0.025**2 / 12)
    rocking = np.sqrt(8.2e3 / inertia) / (2 * np.pi)
    assert np.abs(found / rocking - 1).min() < 0.01


def test_rows_of_the_contact_read_relative_motion(system):
    """Both bodies moved alike: nothing. The pin moved alone along z, y, x: normal, tangent, lateral displacement."""
    nodes = [len(b.mesh.node) for b in system.bodies]
    for axis, rows in ((2, system.contacts.normal), (1, system.contacts.tangent), (0, system.contacts.lateral)):
        moved = [np.tile(np.eye(3)[axis], n) for n in nodes]
        assert sum(p @ m for p, m in zip(rows.parts, moved, strict=True)) == pytest.approx(0, abs=1e-12)
        assert rows.parts[PIN] @ moved[PIN] == pytest.approx(1)


def test_joints_hold_the_pin_but_along_its_guide(system):
    rows = system.joints.rows.parts[PIN]
    along = np.tile([0.0, 0, 1], rows.shape[1] // 3)
    assert rows @ along == pytest.approx(0, abs=1e-12)
    node = system.bodies[PIN].mesh.node
    centred = node - node.mean(axis=0)
    motions = [np.tile(np.eye(3)[a], len(node)) for a in range(3)]
    motions += [np.cross(np.eye(3)[a], centred).ravel() / 0.1 for a in range(3)]
    assert np.linalg.matrix_rank(rows @ np.array(motions).T, tol=1e-6) == 5


def test_leaning_against_the_motion_locks_inside_the_friction_cone():
    """A stiff disc and a slender pin: the flexibility vanishes near tan(tilt) = friction."""
    for tilt, friction, slides in ((4, 0.3, True), (-4, 0.3, False), (-4, 0.0, True), (-25, 0.3, True)):
        found = sliding_flexibility(build(parameters(pin__tilt=np.radians(tilt))), friction, available()[0])
        assert (found > 0) == slides


def test_a_reshaped_pin_is_the_pin_built_so():
    other = parameters(pin__length=0.17, pin__tilt=np.radians(-2))
    one, wanted = build(parameters()).bodies[PIN], pin(other)
    foot = np.array([0.159, 0, 0.0125])
    node = reshaped(one.mesh.node, foot, one.mesh.element, one.element_material, 0.1465, np.radians(4),
                    (0.17, np.radians(-2)))
    assert node == pytest.approx(wanted.mesh.node, abs=1e-9)


@pytest.mark.parametrize("changes, said", [
    ({"pin__length": 0.015}, "longer than its clamp"), ({"contact__radius": 0.178}, "never touches"),
    ({"contact__offset": 0.006}, "contact patch"), ({"disc__hub_radius": 0.2}, "hub")])
def test_what_cannot_be_built_is_refused(changes, said):
    with pytest.raises(ConfigError, match=said):
        build(parameters(**changes))

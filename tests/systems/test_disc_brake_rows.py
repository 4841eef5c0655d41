"""Rows of the brake under rigid motions: what must not stretch does not, and forces balance."""

import numpy as np
import pytest

from pipeline.systems.disc_brake import build
from stages.structure import Settings
from tests.systems.test_disc_brake import COARSE

pytestmark = pytest.mark.exact


@pytest.fixture(scope="module")
def brake():
    return build(Settings(**COARSE))


def rigid(brake, move):
    return np.concatenate([move(b.mesh.node).ravel() for b in brake.bodies])


def test_common_translation_moves_only_joints_to_ground(brake):
    shift = rigid(brake, lambda x: np.broadcast_to([1e-3, 2e-3, -3e-3], x.shape))
    for rows in (brake.contacts.normal, brake.contacts.tangent, brake.contacts.lateral, brake.piston):
        assert rows.matrix @ shift == pytest.approx(0, abs=1e-12)
    stretch = brake.joints.rows.matrix @ shift
    for name, value in zip(brake.joints.name, stretch, strict=True):
        grounded = name.startswith(("abutment", "guide_pin"))
        expected = {"radial": 1e-3, "tangential": 2e-3, "axial": -3e-3}
        kind = next((k for k in expected if k in name), None)
        assert value == pytest.approx(expected[kind] if grounded else 0, abs=1e-12)


def test_contacts_feel_no_common_turn_about_z(brake):
    """Equal and opposite forces at equal points: pad and disc are read at the same place."""
    turn = rigid(brake, lambda x: np.cross([1e-3, -2e-3, 3e-3], x))
    for rows in (brake.contacts.normal, brake.contacts.tangent, brake.contacts.lateral):
        assert rows.matrix @ turn == pytest.approx(0, abs=1e-10)


def test_directions_of_contact_and_piston(brake):
    """A pad that rises opens; one that turns with the disc moves along sliding; the piston pushes pads together."""
    sizes = np.cumsum([0, *(b.mesh.node.size for b in brake.bodies)])
    motion = np.zeros(sizes[-1])
    outer = brake.bodies[1].mesh.node
    motion[sizes[1]:sizes[2]] = np.cross([0, 0, 1.0], outer).ravel()
    speed = brake.contacts.tangent.matrix @ motion
    radius = np.hypot(*brake.contacts.position[:, :2].T)
    own = brake.contacts.body == 1
    assert speed[own] == pytest.approx(radius[own], rel=1e-3) and not speed[~own].any()
    motion[:] = 0
    motion[sizes[1] + 2:sizes[2]:3] = 1.0
    motion[sizes[2] + 2:sizes[3]:3] = -1.0
    assert brake.contacts.normal.matrix @ motion == pytest.approx(1)
    assert (brake.piston.matrix @ motion)[0] == pytest.approx(-1)


def test_patches_fill_the_pad(brake):
    assert len(brake.contacts.body) == 36
    assert brake.contacts.area[:18].sum() == pytest.approx(brake.contacts.area[18:].sum()) == brake.pad_area
    assert np.sign(brake.contacts.position[:, 2]) == pytest.approx(np.repeat([1, -1], 18))


def test_sensors_read_their_direction(brake):
    shift = rigid(brake, lambda x: np.broadcast_to([0, 0, 2.0], x.shape))
    assert brake.sensors.matrix @ shift == pytest.approx(2)


def test_contact_at_integration_points_has_the_area_and_the_rows_of_its_faces():
    """Points of a patch together carry what its mean carries."""
    coarse = {**COARSE, "pad": COARSE["pad"].model_copy(update={"contact_points": 3})}
    points, patches = build(Settings(**coarse)), build(Settings(**COARSE))
    assert len(points.contacts.body) == 9 * len(patches.contacts.body)
    near = np.argmin(np.linalg.norm(points.contacts.position[:, None] - patches.contacts.position, axis=2), axis=1)
    assert np.bincount(near, points.contacts.area) == pytest.approx(patches.contacts.area)
    share = np.zeros((len(patches.contacts.body), len(near)))
    share[near, np.arange(len(near))] = points.contacts.area / patches.contacts.area[near]
    for name in ("normal", "lateral"):
        mean, rows = (getattr(b.contacts, name).matrix for b in (patches, points))
        assert abs(share @ rows - mean).max() < 0.02 * abs(mean).max()

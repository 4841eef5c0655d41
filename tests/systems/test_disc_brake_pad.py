"""Chamfers, slots and weights of a pad against closed forms: areas, volumes, masses, energy of a uniform strain."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.systems.disc_brake import build
from pipeline.systems.disc_brake_pad import pad
from stages.structure import Pad, Settings
from tests.systems.test_disc_brake import COARSE

COUNTS = {"patches_angular": 6, "patches_radial": 2, "cells_per_patch": 2, "lining_layers": 2}
CHAMFER = {"chamfer_length": "8 mm", "chamfer_depth": "4 mm"}
SLOT = {"slot_width": "5 mm", "slot_depth": "6 mm"}
RADII, ANGLE, THICKNESS, PLATE = (0.095, 0.15), np.deg2rad(50), 0.011, 0.0055
SECTOR, MEAN = (RADII[1] ** 2 - RADII[0] ** 2) / 2, sum(RADII) / 2


def made(side=1, **given):
    return pad(Settings(**{**COARSE, "pad": Pad(**{**COUNTS, **given})}), side)


def mass(solid, material=None):
    """Mass of the elements of one material, or of all; from the mass matrix."""
    density = solid.density if material is None else np.where(np.arange(len(solid.density)) == material,
                                                             solid.density, 1e-12)
    matrix = type(solid)(**{**vars(solid), "density": density}).matrices()[1]
    return matrix.sum() / 3


@pytest.mark.exact
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("given, cut, height", [
    ({}, 0.0, 0.0), (CHAMFER, 2 * 0.008 / MEAN / 2, 0.004), (SLOT, 0.005 / MEAN, 0.006),
    ({**SLOT, "slot_depth": "11 mm"}, 0.005 / MEAN, 0.011)], ids=["plain", "chamfer", "slot", "through"])
def test_the_lining_loses_the_volume_of_what_is_cut(side, given, cut, height):
    """Chamfers are triangles of half their length by their depth, a slot is a box."""
    lining = mass(made(side, **given), 0) / 2600
    assert lining == pytest.approx(SECTOR * (ANGLE * THICKNESS - cut * height), rel=1e-4)
    assert mass(made(side, **given), 1) == pytest.approx(7820 * SECTOR * ANGLE * PLATE, rel=1e-4)


@pytest.mark.exact
@pytest.mark.parametrize("points", [None, 2], ids=["patches", "points"])
@pytest.mark.parametrize("given, lost", [
    (CHAMFER, 2 * 0.008 / MEAN), (SLOT, 0.005 / MEAN), ({**CHAMFER, **SLOT}, (2 * 0.008 + 0.005) / MEAN)],
    ids=["chamfer", "slot", "both"])
def test_the_contact_loses_the_area_of_what_is_cut(given, lost, points):
    brake = build(Settings(**{**COARSE, "pad": Pad(**{**COUNTS, **given, "contact_points": points})}))
    assert brake.pad_area == pytest.approx(SECTOR * (ANGLE - lost), rel=2e-4)
    angle = np.arctan2(brake.contacts.position[:, 1], brake.contacts.position[:, 0])
    edge = ANGLE / 2 - (0.008 / MEAN if "chamfer_length" in given else 0)
    assert abs(angle).max() < edge
    if points and "slot_width" in given:
        assert abs(angle).min() > 0.0025 / MEAN


@pytest.mark.exact
def test_a_uniform_strain_has_the_energy_of_the_volume():
    """u = e x in an isotropic lining: 9 K e^2 / 2 for each volume, in elements that chamfer and slot distort."""
    same = {"lining_young_radial": "207 GPa", "lining_young_tangential": "207 GPa", "lining_young_normal": "207 GPa",
            "lining_poisson": 0.29, "lining_shear_normal": f"{207 / 2.58} GPa",
            "lining_shear_in_plane": f"{207 / 2.58} GPa"}
    solid = made(**CHAMFER, **SLOT, **same)
    moved = 1e-3 * solid.mesh.node.ravel()
    stiffness, _ = solid.matrices()
    volume = mass(solid, 0) / 2600 + mass(solid, 1) / 7820
    bulk = 207e9 / (3 * (1 - 2 * 0.29))
    assert moved @ stiffness @ moved / 2 == pytest.approx(4.5 * bulk * 1e-6 * volume, rel=1e-4)


@pytest.mark.exact
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("ends, sign", [("both", 0), ("leading", -1), ("trailing", 1)])
def test_weights_add_their_mass_at_their_ends(side, ends, sign):
    plain, weighted = made(side), made(side, added_mass="60 g", added_mass_at=ends)
    assert mass(weighted) - mass(plain) == pytest.approx(0.06, rel=1e-4)
    np.testing.assert_array_equal(weighted.mesh.node, plain.mesh.node)
    np.testing.assert_allclose((weighted.matrices()[0] - plain.matrices()[0]).data, 0, atol=1e-3)
    gained = weighted.matrices()[1] - plain.matrices()[1]
    along = plain.mesh.node[:, 1]
    moment = (gained[1::3, 1::3] @ along).sum()
    cell = ANGLE / 12
    arm = (RADII[1] ** 3 - RADII[0] ** 3) / 3 / SECTOR * (np.cos(ANGLE / 2 - cell) - np.cos(ANGLE / 2)) / cell
    assert moment == pytest.approx(sign * 0.06 * arm, rel=1e-3, abs=1e-9)


@pytest.mark.exact
def test_without_length_a_stated_depth_is_a_line_of_the_mesh_alone():
    """So that a search from no chamfer on changes the shape and not the mesh."""
    none, little = made(chamfer_depth="4 mm"), made(chamfer_depth="4 mm", chamfer_length="1 um")
    assert none.mesh.element.shape == little.mesh.element.shape
    np.testing.assert_allclose(little.mesh.node, none.mesh.node, atol=1.3e-6)
    assert not np.allclose(little.mesh.node, none.mesh.node, atol=1e-9)


@pytest.mark.parametrize("given, message", [
    ({"chamfer_length": "8 mm"}, "structure.pad.chamfer_depth: expected how deep the chamfer is, found none"),
    ({"slot_width": "5 mm"}, "structure.pad.slot_depth"),
    ({"chamfer_length": "8 mm", "chamfer_depth": "12 mm"}, "at most the lining, 0.011 m"),
    ({"chamfer_length": "30 mm", "chamfer_depth": "1 mm"}, "a flatter chamfer would touch the disc"),
    ({**SLOT, "slot_width": "90 mm"}, "slot_width: expected at most"),
    ({"chamfer_length": "50 mm", "chamfer_depth": "11 mm"}, "chamfer_length: expected at most"),
    ({"added_mass": "-1 g"}, "greater than or equal to 0")])
def test_shapes_that_do_not_fit_are_refused(given, message):
    with pytest.raises((ConfigError, ValueError), match=message):
        build(Settings(**{**COARSE, "pad": Pad(**{**COUNTS, **given})}))

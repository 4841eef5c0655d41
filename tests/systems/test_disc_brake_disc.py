"""Discs with hat, vanes, holes: masses and energy of a uniform strain in closed form, one piece; what does not fit."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.physics.fem.supports import free_modes
from pipeline.physics.numerics.sparse_solver import available
from pipeline.systems.disc_brake import build
from pipeline.systems.disc_brake_disc import disc, disc_mesh
from stages.structure import Disc, Settings
from tests.decks.meshes.small_decks import IRON, abaqus
from tests.systems.test_disc_brake import COARSE

VENTED = {"ring_thickness": "22 mm", "cheek_thickness": "7 mm", "vane_count": 24, "vane_share": 0.4,
          "web_thickness": "5 mm"}
DRILLED = {"hole_count": 12, "hole_rows": 2, "hole_diameter": "8 mm"}
HAT = {"hat_height": "30 mm", "hat_thickness": "6 mm"}
BORE, INNER, OUTER, RING, CHEEK, WEB, WALL, RAISED = 0.0351, 0.0662, 0.1567, 0.022, 0.007, 0.005, 0.006, 0.03
#: of a hole, between four parabolas
AREA = 0.98822 * np.pi * 0.004**2


def made(**given):
    return disc(Disc(**{"web_cells": 3, "ring_cells": 3, "angular_cells": 48, **given}))


def volume(solid):
    return solid.matrices()[1].sum() / 3 / 7200


def ring(inner, outer, height):
    return np.pi * (outer**2 - inner**2) * height


@pytest.mark.exact
@pytest.mark.parametrize("given, expected", [
    ({"ring_thickness": "22 mm", "web_thickness": "5 mm"}, ring(INNER, OUTER, RING) + ring(BORE, INNER, WEB)),
    (VENTED, ring(INNER, OUTER, 2 * CHEEK + 0.4 * (RING - 2 * CHEEK)) + ring(BORE, INNER, WEB)),
    ({**VENTED, **HAT}, ring(INNER, OUTER, 2 * CHEEK + 0.4 * (RING - 2 * CHEEK)) + ring(BORE, INNER, WEB)
     + ring(INNER - WALL, INNER, RAISED - RING + CHEEK)),
    ({**VENTED, **DRILLED}, ring(INNER, OUTER, 2 * CHEEK + 0.4 * (RING - 2 * CHEEK)) + ring(BORE, INNER, WEB)
     - 24 * AREA * 2 * CHEEK),
    ({"ring_thickness": "22 mm", "web_thickness": "5 mm", **DRILLED},
     ring(INNER, OUTER, RING) + ring(BORE, INNER, WEB) - 24 * AREA * RING),
    ({"ring_thickness": "22 mm", "web_thickness": "5 mm", **HAT},
     ring(INNER, OUTER, RING) + ring(BORE, INNER, WEB) + ring(INNER - WALL, INNER, RAISED))],
    ids=["solid", "vented", "vented with hat", "vented and drilled", "drilled", "hat"])
def test_a_disc_has_the_volume_of_its_parts_in_one_piece(given, expected):
    solid = made(**given)
    assert volume(solid) == pytest.approx(expected, rel=1e-5)
    count, v = len(solid.mesh.node), solid.mesh.element.shape[1]
    links = scipy.sparse.coo_array((np.ones(solid.mesh.element.size), (
        solid.mesh.element.ravel(), np.repeat(solid.mesh.element[:, 0], v))), (count, count))
    assert scipy.sparse.csgraph.connected_components(links)[0] == 1


@pytest.mark.exact
def test_a_uniform_strain_has_the_energy_of_the_volume():
    """u = e x in isotropic iron: 9 K e^2 / 2 for each volume."""
    solid = made(**VENTED, **HAT)
    moved = 1e-3 * solid.mesh.node.ravel()
    bulk = 120e9 / (3 * (1 - 2 * 0.27))
    assert moved @ solid.matrices()[0] @ moved / 2 == pytest.approx(4.5 * bulk * 1e-6 * volume(solid), rel=1e-6)


def test_vanes_stand_in_the_middle_and_the_web_is_held_on_the_hat():
    solid = made(**VENTED, **HAT)
    middle = np.array([solid.mesh.node[cell].mean(axis=0) for cell in solid.mesh.element])
    radius, height = np.hypot(*middle[:, :2].T), middle[:, 2]
    between = (radius > INNER) & (abs(height) < RING / 2 - CHEEK)
    turn = np.arctan2(middle[between, 1], middle[between, 0]) * 24 / (2 * np.pi) % 1
    assert len(turn) == 24 * 3 and (turn < 0.4).all()
    held = solid.mesh.node[solid.supported]
    assert held[:, 2] == pytest.approx(RAISED - RING / 2) and np.hypot(*held[:, :2].T).max() < INNER - WALL


def test_holes_soften_and_lighten_the_ring_alike():
    """With 4 % of holes a ring bends at nearly the frequencies of a solid one, two diameters still in a doublet."""
    found = {}
    for name, given in (("solid", {}), ("drilled", DRILLED)):
        solid = made(**given)
        found[name] = free_modes(*solid.matrices(), available()[0], 1200.0, name)[0]
    assert 0.95 * found["solid"][0] < found["drilled"][0] < found["solid"][0]
    assert found["drilled"][0] == pytest.approx(found["drilled"][1], rel=1e-3)


def test_what_lies_over_holes_bears_nothing():
    """Area is lost as the holes under the pad take it; a common translation still moves no contact."""
    given = Settings(**{**COARSE, "disc": Disc(web_cells=2, ring_cells=4, angular_cells=36, **DRILLED)})
    brake, plain = build(given), build(Settings(**COARSE))
    lost = 1 - brake.pad_area / plain.pad_area
    assert lost == pytest.approx(24 * np.pi * 0.004**2 / ring(INNER, OUTER, 1), rel=0.35)
    for rows in (brake.contacts.normal, brake.contacts.tangent, brake.contacts.lateral):
        for axis in np.eye(3):
            moved = sum(part @ np.tile(axis, part.shape[1] // 3) for part in rows.parts)
            assert abs(moved).max() < 1e-9


def test_a_drilled_disc_from_a_file_bears_the_same(tmp_path):
    """The own mesh as a deck: the same contacts."""
    shape = {"web_cells": 2, "ring_cells": 4, "angular_cells": 36}
    (tmp_path / "disc.inp").write_text(abaqus(disc_mesh(Disc(**shape, **DRILLED)), more=IRON))
    read, own = (build(Settings(**{**COARSE, "disc": Disc(**shape, **given)})) for given in (
        {"mesh_file": tmp_path / "disc.inp", "mesh_units": "mm-t-s"}, DRILLED))
    assert read.contacts.area == pytest.approx(own.contacts.area, rel=1e-9)
    assert read.contacts.position == pytest.approx(own.contacts.position, abs=1e-9)


def test_a_ventilated_ring_bends_about_as_a_solid_one_of_its_height():
    """Cheeks far apart bend nearly as stiffly as a solid ring of that height, and weigh less."""
    found = {}
    for name, given in (("solid", {"ring_thickness": "22 mm"}), ("vented", VENTED)):
        solid = made(**{**given, "web_thickness": "5 mm"})
        found[name] = free_modes(*solid.matrices(), available()[0], 1200.0, name)[0]
    assert 0.7 * found["solid"][0] < found["vented"][0] < 1.1 * found["solid"][0]
    assert found["vented"][0] == pytest.approx(found["vented"][1], rel=1e-3)        # a doublet: 24 vanes, two diameters


def test_a_brake_with_a_ventilated_disc_is_built():
    brake = build(Settings(**{**COARSE, "disc": Disc(web_cells=2, ring_cells=3, angular_cells=24, **VENTED, **HAT)}))
    plain = build(Settings(**COARSE))
    assert brake.pad_area == pytest.approx(plain.pad_area)
    assert brake.joints.name == plain.joints.name


@pytest.mark.parametrize("given, message", [
    ({"vane_count": 24}, "disc.cheek_thickness: expected less than half the ring"),
    ({**VENTED, "cheek_thickness": "11 mm"}, "less than half the ring"),
    ({**VENTED, "vane_count": 2}, "3 vanes or more"),
    ({**HAT, "hat_thickness": "20 mm"}, "disc.hat_thickness: expected less than"),
    ({**VENTED, **HAT, "hat_height": "2 mm"}, "disc.hat_height: expected a web that ends above"),
    ({**VENTED, "web_thickness": "6.9 mm"}, "disc.cheek_thickness: expected faces of web, ring and cheeks"),
    ({"hole_count": 12}, "disc.hole_diameter: expected a diameter"),
    ({**VENTED, **DRILLED, "hole_count": 10}, "disc.hole_count: expected a divisor of the 24 channels"),
    ({**DRILLED, "hole_count": 60}, "disc.hole_diameter: expected holes of 0.00[0-9]+ m at most"),
    ({**HAT, "hat_height": "2.6 mm"}, "disc.hat_height: expected faces of web, ring and cheeks that coincide")])
def test_shapes_that_do_not_fit_are_refused(given, message):
    with pytest.raises(ConfigError, match=message):
        build(Settings(**{**COARSE, "disc": Disc(**given)}))


def test_a_disc_from_a_file_has_the_shape_of_its_mesh(tmp_path):
    (tmp_path / "disc.inp").write_text("*NODE\n")
    with pytest.raises(ConfigError, match="structure.disc.hat_height: expected none beside mesh_file, whose disc"):
        build(Settings(**{**COARSE, "disc": Disc(mesh_file=str(tmp_path / "disc.inp"), **HAT)}))

"""Shims of the pads: layers, masses and places; their loss against Kerwin's closed form."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block
from pipeline.systems.disc_brake import build
from pipeline.systems.disc_brake_pad import pad, shim_thickness
from stages.structure import Pad, Settings
from tests.systems.test_disc_brake import COARSE
from tests.systems.test_disc_brake_pad import ANGLE, COUNTS, SECTOR, made, mass

SHIM = {"shim_rubber_thickness": "0.12 mm", "shim_cover_thickness": "0.4 mm"}
PLATE, RUBBER, COVER = 5.5e-3, 0.12e-3, 0.4e-3


def stiffness_of_sandwich(number, shear):
    """Bending stiffness (complex) of plate, rubber and cover a metre wide at the wave number (rad/m), for the complex
    shear modulus of the rubber: Kerwin (1959). Plate and cover stretch against each other, which the rubber resists."""
    plate, cover, apart = 207e9 * PLATE, 207e9 * COVER, (PLATE + COVER) / 2 + RUBBER
    stretch = plate * cover / (plate + cover)
    shears = shear / (RUBBER * stretch * number**2)
    return 207e9 * (PLATE**3 + COVER**3) / 12 + stretch * apart**2 * shears / (1 + shears)


@pytest.mark.exact
@pytest.mark.parametrize("shear", [2e6, 20e6])
def test_a_plate_with_a_shim_loses_what_kerwin_says(shear):
    """A strip on knife edges in one half wave, with elements as thin as those of a pad; harder rubber stretches too."""
    length, width, lost = 0.12, 2.5e-3, 0.5
    edges = np.cumsum([0, PLATE, RUBBER, COVER])
    mesh = block(np.linspace(0, length, 25), np.array([0, width]), edges)
    steel, rubber = isotropic(207e9, 0.0), isotropic(2 * shear * 1.48, 0.48)
    layer = mesh.cell[:, 2]
    material, density = (layer == 1).astype(int), [7820.0, 1200.0]
    stiffness, inertia = assemble(mesh.node, mesh.element, mesh.kind, material, density, [steel, rubber])
    loss, _ = assemble(mesh.node, mesh.element, mesh.kind, material, density, [0 * steel, lost * rubber])
    held = np.zeros((len(mesh.node), 3), bool)
    held[:, 1] = True
    middle = np.isclose(mesh.node[:, 2], PLATE / 2)
    held[middle & (np.isclose(mesh.node[:, 0], 0) | np.isclose(mesh.node[:, 0], length)), 2] = True
    held[middle & np.isclose(mesh.node[:, 0], 0), 0] = True
    free = np.flatnonzero(~held.ravel())
    k, m, h = (matrix[free][:, free] for matrix in (stiffness, inertia, loss))
    root = scipy.sparse.linalg.eigs(k + 1j * h, 1, m, sigma=1.0, v0=np.ones(len(free)))[0][0]
    number = np.pi / length
    expected = stiffness_of_sandwich(number, shear * (1 + 1j * lost))
    per_length = 7820 * (PLATE + COVER) + 1200 * RUBBER
    assert root.real == pytest.approx(number**4 * expected.real / per_length, rel=0.01)
    assert root.imag / root.real == pytest.approx(expected.imag / expected.real, rel=0.01)


@pytest.mark.exact
@pytest.mark.parametrize("side", [1, -1])
def test_a_shim_adds_its_layers_to_the_back(side):
    plain, layered = made(side, added_mass="60 g"), made(side, added_mass="60 g", **SHIM)
    assert layered.material_name[-2:] == ("shim rubber", "shim cover")
    assert mass(layered) - mass(plain) == pytest.approx(SECTOR * ANGLE * (1200 * RUBBER + 7820 * COVER), rel=1e-4)
    backs = [(side * solid.mesh.node[:, 2]).max() for solid in (plain, layered)]
    assert backs[1] - backs[0] == pytest.approx(RUBBER + COVER)
    middle = np.array([layered.mesh.node[cell, 2].mean() for cell in layered.mesh.element]) * side
    order = [middle[layered.element_material == layered.material_name.index(name)].mean()
             for name in ("lining", "steel", "shim rubber", "shim cover")]
    assert order == sorted(order)
    np.testing.assert_array_equal(layered.loss_factor[-2:], [0.5, 0.0])


def test_fingers_and_piston_bear_on_the_cover():
    plain, layered = (build(Settings(**{**COARSE, "pad": Pad(**{**COUNTS, **given})})) for given in ({}, SHIM))
    assert shim_thickness(Pad(**COUNTS)) == 0 and shim_thickness(Pad(**SHIM)) == pytest.approx(RUBBER + COVER)
    assert layered.joints.name == plain.joints.name and layered.pad_area == pytest.approx(plain.pad_area)
    height = [brake.bodies[3].mesh.node[:, 2] for brake in (plain, layered)]
    assert height[1].max() - height[0].max() == pytest.approx(RUBBER + COVER)
    assert height[1].min() - height[0].min() == pytest.approx(-RUBBER - COVER)


def test_a_pad_from_a_file_has_the_shim_of_its_mesh(tmp_path):
    (tmp_path / "pad.inp").write_text("*NODE\n")
    with pytest.raises(ConfigError, match="structure.pad.shim_rubber_thickness: expected none beside mesh_file"):
        build(Settings(**{**COARSE, "pad": Pad(mesh_file=str(tmp_path / "pad.inp"), **SHIM)}))
    assert pad(Settings(**{**COARSE, "pad": Pad(**COUNTS)}), 1).material_name == ("lining", "steel")

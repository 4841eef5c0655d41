"""The brake as built: Table 1 of the paper, masses, bad geometry."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.axisymmetric_disc import section_frequencies
from pipeline.systems.disc_brake import build, pad
from pipeline.systems.disc_brake_disc import clamped_nodes, disc_mesh
from stages.structure import Caliper, Disc, Pad, Settings

COARSE = {"disc": Disc(web_cells=2, ring_cells=3, angular_cells=24), "pad": Pad(cells_per_patch=1, lining_layers=1),
          "caliper": Caliper(radial_cells=2, angular_cells=4, housing_cells=1, bridge_cells=1)}


@pytest.mark.published
@pytest.mark.parametrize("diameters, number, measured, tolerance", [
    (2, 0, 267, 0.04), (0, 0, 432, 0.04), (3, 0, 663, 0.04), (2, 1, 1619, 0.04), (0, 1, 2338, 0.04),
    (1, 1, 2716, 0.04)])
def test_table_1(diameters, number, measured, tolerance):
    """Free disc, test column; 4 % because the flat section is a fit to these very frequencies.

    The paper names no diameters: the pairing is that of the fit. Its seventh, 3075 Hz, is beside its own
    calculation by 15 % and is left out.
    """
    d = Disc()
    radius = np.r_[np.linspace(d.bore_radius, d.ring_inner_radius, 7),
                   np.linspace(d.ring_inner_radius, d.ring_outer_radius, 15)[1:]]
    height = np.array([0, d.web_thickness / 2, d.web_thickness, d.ring_thickness])
    mask = np.ones((20, 3), bool)
    mask[:6, 2] = False
    frequency = section_frequencies(radius, height, mask, d.young, d.poisson, d.density, diameters, 8)
    assert frequency[frequency > 1][number] == pytest.approx(measured, rel=tolerance)


@pytest.mark.exact
def test_parts_have_the_stated_places():
    settings = Settings(**COARSE)
    brake = build(settings)
    disc, outer, inner, caliper = (b.mesh.node for b in brake.bodies)
    half = settings.disc.ring_thickness / 2
    assert outer[:, 2].min() == pytest.approx(half) and inner[:, 2].max() == pytest.approx(-half)
    assert outer[:, 2].max() == pytest.approx(half + settings.pad.lining_thickness + settings.pad.backplate_thickness)
    assert np.hypot(*disc[:, :2].T).max() < np.hypot(*caliper[np.abs(caliper[:, 2]) < half][:, :2].T).min(initial=1)
    assert brake.pad_area == pytest.approx(settings.pad.angle / 2 * (0.15**2 - 0.095**2), rel=1e-4)
    assert set(np.unique(pad(settings, -1).element_material)) == {0, 1}


@pytest.mark.exact
def test_mount_holds_the_inner_face_out_to_the_pressure_cones():
    disc = Disc(web_cells=4, ring_cells=3, angular_cells=24)
    mesh = disc_mesh(disc)
    held = mesh.node[clamped_nodes(mesh, disc)]
    reach = disc.bolt_circle_radius + disc.bolt_head_radius + disc.web_thickness / np.sqrt(3)
    assert held[:, 2] == pytest.approx(-disc.ring_thickness / 2)
    assert np.hypot(*held[:, :2].T).max() == pytest.approx(reach)
    with pytest.raises(ConfigError, match="bolt_preload"):
        clamped_nodes(mesh, Disc(bolt_preload="100 N"))


@pytest.mark.exact
@pytest.mark.parametrize("part, message", [
    ({"pad": Pad(inner_radius="40 mm")}, "pads that lie on the ring"),
    ({"pad": Pad(outer_radius="160 mm")}, "pads that lie on the ring"),
    ({"caliper": Caliper(bridge_inner_radius="150 mm")}, "intersection"),
    ({"disc": Disc(web_thickness="8 mm")}, "web thinner than the ring"),
    ({"disc": Disc(bolt_circle_radius="64 mm")}, "bolts"),
    ({"sensors": [{"name": "lost", "radius": "170 mm", "angle": "0 deg"}]}, "sensors: lost"),
])
def test_bad_geometry_is_refused(part, message):
    with pytest.raises(ConfigError, match=message):
        build(Settings(**{**COARSE, **part}))

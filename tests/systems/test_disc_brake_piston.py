"""The piston in its bore, and the fluid behind it."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.supports import held_modes
from pipeline.systems.disc_brake import caliper
from pipeline.systems.disc_brake_piston import bore, column_length, fluid_column, piston
from pipeline.systems.disc_brake_rows import pad_height
from stages.structure import Caliper, Piston, Settings
from tests.systems.test_disc_brake import COARSE
from tests.systems.test_disc_brake_bracket import BODIES

pytestmark = pytest.mark.exact
HOLE = 0.1


def with_piston(**changes):
    return Settings(**{**BODIES, "bracket": {"kind": "ground"}, "piston": {"kind": "body", **changes}})


def test_mass_is_that_of_a_cup_with_a_narrow_hole():
    settings = with_piston(angular_cells=24)
    body, p = piston(settings), settings.piston
    along = np.tile([0.0, 0.0, 1.0], len(body.mesh.node))
    outer, inner = p.diameter / 2, p.diameter / 2 - p.wall
    expected = p.density * np.pi * (p.crown * (1 - HOLE**2) * outer**2 + (p.length - p.crown) * (outer**2 - inner**2))
    assert along @ body.matrices()[1] @ along == pytest.approx(expected, rel=1e-3)


def test_first_modes():
    """The rim turns oval below 20 kHz, which is why the piston is no rigid body.

    A crown stiffens the free ring, whose inextensional mode with n = 2 has the frequency
    n (n^2 - 1) / (n^2 + 1)^0.5 (E I / rho A R^4)^0.5 / 2 pi (Love, Mathematical Theory of Elasticity, 4th ed., 293).
    """
    def modes(**mesh):
        return held_modes(*piston(with_piston(**mesh)).matrices(), np.empty(0, int), "superlu", count=10)[0]

    p, default, fine = Piston(), modes(), modes(element_size="6 mm", angular_cells=24)
    radius = (p.diameter - p.wall) / 2
    ring = 6 / np.sqrt(5) * np.sqrt(p.young * p.wall**2 / 12 / p.density) / radius**2 / (2 * np.pi)
    assert default[:6] == pytest.approx(0, abs=1.0)
    assert default[6] == pytest.approx(default[7], rel=1e-6) and ring < default[6] < 20e3
    assert default[6:] == pytest.approx(fine[6:], rel=0.01)


def test_it_stands_in_its_bore_and_on_the_backplate():
    settings = with_piston()
    (first, last), half, floor = bore(settings)
    node, middle = piston(settings).mesh.node, settings.joints.clamping_radius
    radius, angle = np.hypot(*node[:, :2].T), np.arctan2(node[:, 1], node[:, 0])
    assert first < radius.min() and radius.max() < last and abs(angle).max() < half
    assert node[:, 2].max() == pytest.approx(-pad_height(settings))
    assert node[:, 2].min() - floor == pytest.approx(column_length(settings)) and column_length(settings) > 0
    assert np.hypot(node[:, 0] - middle, node[:, 1]).max() == pytest.approx(settings.piston.diameter / 2)


def test_the_housing_loses_the_volume_of_the_bore():
    """Finer cells around it leave a recess of its four walls and its floor, which the piston enters."""
    solid, hollow = (caliper(s) for s in (Settings(**{**BODIES, "bracket": {"kind": "ground"},
                                                      "piston": {"kind": "seal"}}), with_piston()))
    mass = []
    for body in (solid, hollow):
        along = np.tile([0.0, 0.0, 1.0], len(body.mesh.node))
        mass.append(along @ body.matrices()[1] @ along)
    (first, last), half, _ = bore(with_piston())
    recess = (last**2 - first**2) * half * Piston().bore_depth
    assert mass[0] - mass[1] == pytest.approx(Caliper().density * recess, rel=1e-3)


def test_fluid_column_and_line():
    """Spring A^2 B / V; the line with the column rings far below squeal, and drags little."""
    settings = with_piston(length="30 mm", fluid={"passage_volume": "0 mm^3"})
    column, f = fluid_column(settings), settings.piston.fluid
    area, line = np.pi * 0.048**2 / 4, np.pi * f.line_diameter**2 / 4
    assert column.stiffness == pytest.approx(f.bulk_modulus * area / 0.010)
    assert column.inertia == pytest.approx(f.density * line * f.line_length * (area / line) ** 2)
    speed = 1e-3                    # of the piston: Poiseuille's pressure on its area
    flow = area * speed
    pressure = 8 * f.viscosity * f.line_length * flow / (np.pi * (f.line_diameter / 2) ** 4)
    assert column.drag * speed == pytest.approx(pressure * area)
    with_passage = fluid_column(with_piston(length="30 mm", fluid={"passage_volume": "2 cm^3"}))
    assert 1 / with_passage.stiffness == pytest.approx(1 / column.stiffness + 2e-6 / (f.bulk_modulus * area**2))
    ringing = np.sqrt(fluid_column(with_piston()).stiffness / column.inertia) / (2 * np.pi)
    assert 50 < ringing < 300
    assert fluid_column(Settings(**COARSE)) is None


def several(fixed=True, **changes):
    """Twin pistons on each side of a fixed caliper, or on one of a floating one."""
    caliper = BODIES["caliper"].model_copy(update={"fixed": fixed})
    return Settings(**{**BODIES, "bracket": {"kind": "ground"}, "caliper": caliper,
                       "piston": {"kind": "body", "count": 2, "diameter": "38 mm", **changes}})


def mass(body):
    """Mass of a Solid and its centre."""
    matrix, node = body.matrices()[1], body.mesh.node
    along = np.tile([0.0, 0.0, 1.0], len(node))
    weight = (matrix @ along)[2::3]
    return weight.sum(), weight @ node / weight.sum()


def test_twins_on_both_sides_are_four_of_one():
    """One body of four parts: its mass, its centre between the pads, every mode four times, mirrored places."""
    settings = several()
    one, four = piston(with_piston(diameter="38 mm")), piston(settings)
    (single, _), (whole, centre) = mass(one), mass(four)
    assert whole == pytest.approx(4 * single, rel=1e-9)
    off = settings.piston.spacing / 2 / settings.joints.clamping_radius
    assert centre == pytest.approx([settings.joints.clamping_radius * np.cos(off), 0, 0], abs=1e-9)
    first, all_modes = (held_modes(*body.matrices(), np.empty(0, int), "superlu", count=count)[0]
                        for body, count in ((one, 8), (four, 32)))
    assert all_modes[:24] == pytest.approx(0, abs=1.0)
    assert all_modes[24:] == pytest.approx(np.repeat(first[6:8], 4), rel=1e-6)
    for point in (four.mesh.node * (1, -1, 1), four.mesh.node * (1, 1, -1)):
        assert scipy.spatial.cKDTree(four.mesh.node).query(point)[0].max() < 1e-9


def test_each_has_its_bore():
    settings = several()
    solid = caliper(settings.model_copy(update={"piston": Settings().piston}))
    (first, last), half, _ = bore(settings)
    recess = (last**2 - first**2) * half * settings.piston.bore_depth
    lost = mass(solid)[0] - mass(caliper(settings))[0]
    assert lost == pytest.approx(4 * settings.caliper.density * recess, rel=1e-3)
    assert mass(caliper(settings))[1][2] == pytest.approx(0, abs=1e-9)


def test_fluid_of_joined_bores():
    """Twins are a piston of twice the area; the columns of both sides of a fixed caliper are those of one side."""
    two, four = (fluid_column(several(fixed, fluid={"passage_volume": "0 mm^3"})) for fixed in (False, True))
    one = fluid_column(with_piston(diameter="38 mm", fluid={"passage_volume": "0 mm^3"}))
    assert two.stiffness == pytest.approx(2 * one.stiffness) and two.inertia == pytest.approx(4 * one.inertia)
    assert four == two


@pytest.mark.parametrize(("changes", "message"), [
    ({"spacing": "40 mm"}, "spacing: expected bores 0.002 m apart, 0.04036 m or more, found 0.04 m"),
    ({"spacing": "80 mm"}, "spacing: expected a bore within the caliper, 0.4189 rad, found 0.485"),
])
def test_twins_that_do_not_fit_are_refused(changes, message):
    with pytest.raises(ConfigError, match=message):
        piston(several(**changes))


@pytest.mark.parametrize(("changes", "message"), [
    ({"length": "41 mm"}, "length.*intersection"), ({"bore_depth": "46 mm"}, "floor in the housing"),
    ({"diameter": "62 mm"}, "rim on the backplate|bore in the housing"), ({"wall": "23 mm"}, "wall"),
    ({"crown": "34 mm"}, "crown"), ({"seal_depth": "31 mm"}, "seal"),
])
def test_a_piston_that_does_not_fit_is_refused(changes, message):
    with pytest.raises(ConfigError, match=message):
        piston(with_piston(**changes))


def test_a_bore_needs_a_wall():
    with pytest.raises(ConfigError, match="bore in the housing"):
        piston(Settings(**{**BODIES, "caliper": Caliper(inner_radius="99 mm")}))

"""The anchor bracket: its mass, its modes on finer meshes, and that it leaves room for the other parts."""

from itertools import combinations

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.supports import held_modes
from pipeline.systems.disc_brake import build
from pipeline.systems.disc_brake_bracket import bracket, inner_height
from stages.structure import Bracket, Caliper, Settings
from tests.systems.test_disc_brake import COARSE

pytestmark = pytest.mark.exact
#: with the bore of the piston in the housing
BODIES = {**COARSE, "bracket": Bracket(), "piston": {"kind": "body"},
          "caliper": COARSE["caliper"].model_copy(update={"inner_radius": 0.092})}


def volume(b, pads, beside):
    """Sectors of rings: both inner columns, arms and rim bridges, and the base."""
    def ring(first, last):
        return (last**2 - first**2) / 2

    column = (b.angle - pads) * (ring(b.inner_radius, b.rim_outer_radius) * (b.column_height - beside)
                                 + ring(b.rim_inner_radius, b.rim_outer_radius) * 2 * beside
                                 + ring(b.base_outer_radius, b.rim_outer_radius) * (b.arm_height - beside))
    return column + pads * ring(b.inner_radius, b.base_outer_radius) * (b.base_height - beside)


def test_mass_is_that_of_its_sectors():
    settings = Settings(**{**COARSE, "bracket": Bracket()})
    body = bracket(settings)
    along = np.tile([0.0, 0.0, 1.0], len(body.mesh.node))
    expected = settings.bracket.density * volume(settings.bracket, settings.pad.angle, inner_height(settings))
    assert along @ body.matrices()[1] @ along == pytest.approx(expected, rel=1e-4)


def test_first_modes_converge_on_finer_meshes():
    """Six rigid motions; from elements of 15 mm on, the first eight elastic modes fall by less than 3 %."""
    def modes(size):
        body = bracket(Settings(**{**COARSE, "bracket": Bracket(element_size=size)}))
        return held_modes(*body.matrices(), np.empty(0, int), "superlu", count=14)[0]

    coarse, middle, fine = (modes(size) for size in ("25 mm", "15 mm", "9 mm"))
    assert middle[:6] == pytest.approx(0, abs=1.0) and middle[6] > 100
    assert (fine[6:] <= middle[6:]).all() and (middle[6:] <= coarse[6:]).all()
    assert middle[6:] == pytest.approx(fine[6:], rel=0.03)


def test_elements_that_shrink_towards_the_corners_do_better_with_half_as_many():
    """First elastic modes, all of which come down where corners are resolved."""
    def modes(size, cells):
        body = bracket(Settings(**{**COARSE, "bracket": Bracket(element_size=size, corner_cells=cells)}))
        return len(body.mesh.node), held_modes(*body.matrices(), np.empty(0, int), "superlu", count=14)[0][6:]

    (few, graded), (many, equal) = modes("25 mm", 2), modes("9 mm", 0)
    assert few < 0.6 * many and graded.mean() < 0.999 * equal.mean()


def boxes(mesh, shift=0.0):
    """(e, 2, 3) extremes of the elements in radius, angle and height; meshes of revolution fill them."""
    corner = mesh.node[mesh.element]
    turn = np.arctan2(corner[..., 1], corner[..., 0])
    turn = np.where(np.ptp(turn, axis=1, keepdims=True) > np.pi, turn % (2 * np.pi), turn)
    place = np.stack((np.hypot(corner[..., 0], corner[..., 1]), turn, corner[..., 2]), axis=-1)
    return np.stack((place.min(axis=1), place.max(axis=1)), axis=1)


def test_no_part_intersects_another():
    """Disc, pads, caliper and bracket; parts may touch. The piston has a test of its own."""
    brake = build(Settings(**BODIES))
    bodies = {name: boxes(body.mesh) for name, body in zip(brake.names, brake.bodies, strict=True) if name != "piston"}
    assert len(bodies) == 5
    for (first, a), (second, b) in combinations(bodies.items(), 2):
        overlap = np.minimum(a[:, None, 1], b[None, :, 1]) - np.maximum(a[:, None, 0], b[None, :, 0])
        assert not (overlap > 1e-9).all(axis=2).any(), f"{first} and {second}"


@pytest.mark.parametrize(("changes", "message"), [
    ({"rim_inner_radius": "155 mm"}, "rim_inner_radius: .*intersection"),
    ({"base_outer_radius": "93 mm"}, "base_outer_radius: .*intersection"),
    ({"inner_radius": "91 mm"}, "inner < base outer"),
    ({"angle": "49 deg"}, "columns beyond the pads"),
    ({"arm_height": "18 mm"}, "cover the backplates"),
    ({"base_height": "5 mm"}, "base_height"),
    ({"column_height": "34 mm"}, "guide pins"),
    ({"mount_radius": "170 mm"}, "point on the surface"),
])
def test_a_bracket_that_does_not_fit_is_refused(changes, message):
    with pytest.raises(ConfigError, match=message):
        build(Settings(**{**BODIES, "bracket": Bracket(**changes)}))


def test_a_caliper_wider_than_the_pads_meets_the_columns():
    with pytest.raises(ConfigError, match="caliper between the columns.*intersection"):
        build(Settings(**{**BODIES, "caliper": Caliper(angle="52 deg", inner_radius="92 mm")}))

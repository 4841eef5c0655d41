"""Stated dimensions that do not fit, and that those of mesh files are not asked."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.systems.disc_brake_checks import clamped_radius, refuse_unfit
from stages.structure import Caliper, Disc, Pad, Settings

pytestmark = pytest.mark.exact


def test_the_pressure_cones_have_a_half_angle_of_30_degrees():
    disc = Disc(web_thickness="3 mm")
    assert clamped_radius(disc) == pytest.approx(0.053 + 0.003 / 3**0.5)


@pytest.mark.parametrize("section, message", [
    ({"caliper": Caliper(bridge_inner_radius="150 mm")}, "a bridge outside the disc"),
    ({"pad": Pad(inner_radius="60 mm")}, "pads that lie on the ring"),
    ({"disc": Disc(web_thickness="7 mm")}, "a web thinner than the ring"),
    ({"disc": Disc(bolt_circle_radius="60 mm")}, "pressure cones end between bore and ring"),
    ({"disc": Disc(bolt_preload="100 N")}, "bolt_preload: expected a mount that the web enters by less")])
def test_dimensions_that_do_not_fit(section, message):
    with pytest.raises(ConfigError, match=message):
        refuse_unfit(Settings(**section))


def test_dimensions_of_mesh_files_are_not_asked(tmp_path):
    (tmp_path / "a.inp").write_text("")
    for name, section in (("caliper", Caliper(bridge_inner_radius="150 mm", mesh_file=tmp_path / "a.inp")),
                          ("pad", Pad(inner_radius="60 mm", mesh_file=tmp_path / "a.inp"))):
        assert refuse_unfit(Settings(**{name: section})) is None

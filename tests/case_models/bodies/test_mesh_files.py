"""A deck of several bodies under each of them; what the case states goes before a file, which the fingerprint knows."""

import pytest

from pipeline.case_models.bodies.brake_bodies import Caliper, Pad
from pipeline.case_models.bodies.mesh_files import with_deck
from pipeline.contract.fingerprint import settings_of
from stages.structure import Settings

pytestmark = pytest.mark.exact


@pytest.fixture
def file(tmp_path):
    (tmp_path / "a.inp").write_text("")
    return str(tmp_path / "a.inp")


def test_the_deck_stands_under_every_body(file):
    sets = {"disc": "D", "pad_outer": ["L", "P"], "pad_inner": ["M", "Q"], "piston": "K"}
    settings = Settings.model_validate({"mesh_file": file, "mesh_units": "mm-t-s", "mesh_sets": sets,
                                        "pad": {"lining_density": "2500 kg/m^3"}})
    assert settings.disc.mesh_sets == ("D",) and settings.pad.mesh_sets == ("L", "P")
    assert settings.pad.inner_mesh_sets == ("M", "Q") and settings.pad.lining_density == 2500
    assert {str(part.mesh_file) for part in (settings.disc, settings.pad, settings.piston)} == {file}
    assert settings.disc.mesh_units == "mm-t-s" and settings.piston.kind == "body"
    assert settings.caliper.mesh_file is None and settings.bracket.kind == "ground"


def test_filled_sections_are_extended(file):
    settings = Settings(mesh_file=file, mesh_sets={"caliper": "C"}, caliper=Caliper(young="1 GPa"))
    assert settings.caliper.young == 1e9 and settings.caliper.mesh_sets == ("C",)


def test_axes_of_the_deck_are_those_of_every_body(file):
    settings = Settings(mesh_file=file, mesh_axes=["y", "z", "x"], mesh_sets={"disc": "D", "caliper": "C"},
                        caliper=Caliper(young="1 GPa"))
    assert settings.disc.mesh_axes == settings.caliper.mesh_axes == ("y", "z", "x") and settings.pad.mesh_axes == ()
    with pytest.raises(ValueError, match="mesh_axes"):
        Settings(mesh_file=file, mesh_axes=["r", "t", "z"], mesh_sets={"disc": "D"})


def test_without_a_deck_nothing_changes():
    assert with_deck({"disc": {}}) == {"disc": {}} and with_deck(None) is None
    assert Settings().disc.mesh_file is None


@pytest.mark.parametrize("values, message", [
    ({"mesh_sets": {"disc": "D"}}, "found no mesh_file"), ({"mesh_file": "a.inp"}, "found no mesh_sets"),
    ({"mesh_file": "a.inp", "mesh_sets": {"hub": "D"}}, "expected bodies disc, .*found 'hub'"),
    ({"mesh_file": "a.inp", "mesh_sets": {"disc": "D"}, "disc": {"mesh_file": "b.inp"}}, "one mesh of the disc, found"
     " disc.mesh_file besides")])
def test_what_is_at_odds_is_refused(values, message):
    with pytest.raises(ValueError, match=message):
        with_deck(values)


def test_stating_a_default_is_a_change_where_a_file_has_it(file):
    pad = Pad(mesh_file=file, lining_density="2600 kg/m^3")
    assert settings_of(pad)["(stated)"] == ["lining_density"] and "(stated)" not in settings_of(Pad())

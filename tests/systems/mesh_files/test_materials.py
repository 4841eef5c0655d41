"""Materials of a disc from a deck: the case goes before the file, the file before the defaults, and it is said."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.contract.fingerprint import settings_of
from pipeline.decks.meshes.material import Material, Unread
from pipeline.physics.fem.elasticity import isotropic
from pipeline.systems.disc_brake_disc import disc, disc_mesh
from pipeline.systems.mesh_files.bodies import notes as notes_of
from pipeline.systems.mesh_files.materials import from_file, lining, materials, read
from stages import model_update
from stages.structure import Disc, Pad, Settings
from tests.decks.meshes.small_decks import IRON, abaqus
from tests.decks.meshes.test_abaqus_materials import LINING

pytestmark = pytest.mark.exact
DISC = "cast iron", "structure.disc"


def notes(section):
    """Those of a disc, without its name."""
    return tuple(note.removeprefix("disc: ") for note in notes_of(SimpleNamespace(disc=section)))


@pytest.fixture
def deck(tmp_path):
    mesh = disc_mesh(Disc(web_cells=2, ring_cells=3, angular_cells=24))

    def write(more):
        (tmp_path / "disc.inp").write_text(abaqus(mesh, more=more))
        return {"mesh_file": tmp_path / "disc.inp", "mesh_units": "mm-t-s"}
    return write


def test_the_file_goes_before_the_defaults(deck):
    settings = Disc(**deck(IRON))
    made = disc(settings)
    assert made.material_name == ("IRON",) and made.density == pytest.approx([7100])
    assert np.allclose(made.elasticity, isotropic(110e9, 0.26)) and len(made.supported)
    assert notes(settings) == ("IRON: Young's modulus 1.1e+11 Pa, from the file",
                                      "IRON: Poisson's ratio 0.26, from the file",
                                      "IRON: density 7100 kg/m^3, from the file")


def test_the_case_goes_before_the_file_and_says_so(deck):
    settings = Disc(**deck(IRON), young="120 GPa", density="7100 kg/m^3")
    made = disc(settings)
    assert np.allclose(made.elasticity, isotropic(120e9, 0.26)) and made.density == pytest.approx([7100])
    assert notes(settings) == (
        "IRON: Young's modulus 1.2e+11 Pa, as stated in structure.disc.young; the file gives 1.1e+11 Pa",
        "IRON: Poisson's ratio 0.26, from the file", "IRON: density 7100 kg/m^3, as stated and from the file")


def test_what_the_file_does_not_give(deck):
    only = "*SOLID SECTION, ELSET=SOME, MATERIAL=B\n*ELSET, ELSET=SOME\n1, 2\n*MATERIAL, NAME=B\n*DENSITY\n7.1e-9\n"
    settings = Disc(**deck(only))
    made = disc(settings)
    assert made.material_name == ("B", "cast iron") and list(made.element_material[:3]) == [0, 0, 1]
    assert made.density == pytest.approx([7100, 7200]) and np.allclose(made.elasticity, isotropic(120e9, 0.27))
    said = notes(settings)
    assert "B: Young's modulus 1.2e+11 Pa, the default in structure.disc.young; the file gives none" in said
    assert said[-1] == f"{len(made.element_material) - 2} elements have no material in the file: cast iron of" \
                       " structure.disc"
    assert len([s for s in said if s.startswith("cast iron:")]) == 3


def test_direction_dependent_constants(deck):
    given = LINING.replace(", ORIENTATION=axes", "") + "*MATERIAL, NAME=UNUSED\n"
    named = deck(given)
    body = read(Disc(**named))
    (material,), _, said = materials(body, Disc(**named), *DISC)
    assert material.young == pytest.approx((6e9, 5e9, 1.5e9)) and said[-1].endswith("constants of the file")
    (material,), _, said = materials(body, Disc(**named, young="100 GPa"), *DISC)
    assert material.isotropic and material.young[0] == 100e9 and "states young, which makes it isotropic" in said[-1]


UNREAD = {"lamina": "*MATERIAL, NAME=B\n*ELASTIC, TYPE=LAMINA\n6e3, 6e3, .2, 2e3, 1e3, 1e3\n*DENSITY\n7.1e-9\n",
          "hyperelastic": "*MATERIAL, NAME=B\n*DENSITY\n7.1e-9\n*HYPERELASTIC, YEOH\n1., 2., 3.\n"}


@pytest.mark.parametrize("law", UNREAD)
def test_a_law_that_is_not_read_is_never_the_default(deck, law):
    named = deck("*SOLID SECTION, ELSET=ALL, MATERIAL=B\n" + UNREAD[law])
    for values in ({}, {"young": "100 GPa"}):
        with pytest.raises(ConfigError, match=r"disc.inp:\d+, material B: expected elastic constants of a solid that"
                           rf" are read, found \*.*{law.upper()}.*; write \*ELASTIC, .* or state structure.disc: young"
                           " and poisson in the case"):
            disc(Disc(**named, **values))
    made = disc(Disc(**named, young="100 GPa", poisson=0.3))
    assert np.allclose(made.elasticity, isotropic(100e9, 0.3)) and made.density == pytest.approx([7100])


def test_a_lining_that_is_not_read_asks_for_its_constants():
    material, stated = Material("R", unread=Unread("a.inp:5", "*ELASTIC, TYPE=LAMINA", "write it")), Pad(
        lining_young_normal="2 GPa")
    with pytest.raises(ConfigError, match="a.inp:5, material R: .* or state structure.pad: lining_young_normal and"):
        lining(material, Pad(), (), "structure.pad")
    made, _ = lining(material, stated, ("lining_young_normal",), "structure.pad")
    assert made.young == (6e9, 6e9, 2e9) and made.unread is None


def test_without_a_file_nothing_is_said():
    assert notes(Disc()) == () and disc(Disc()).material_name == ("cast iron",)


def test_what_the_case_leaves_to_the_file(deck):
    named = deck(IRON)
    assert from_file(Disc(**named)) == ("young", "poisson", "density")
    assert from_file(Disc(**named, young="1 GPa")) == ("poisson", "density") and from_file(Disc()) == ()
    update = model_update.Settings(disc=Disc(**named), values={"young": {"spread": 0.1}})
    with pytest.raises(ConfigError, match="model_update.values: .*found disc.young of the mesh file; state them"):
        model_update.stated({"model_update": update})


def test_a_group_of_the_file_is_held(deck):
    named = deck(IRON + "*NSET, NSET=hub\n1, 2, 3\n")
    assert list(disc(Disc(**named, mount_group="Hub")).supported) == [0, 1, 2]
    with pytest.raises(ConfigError, match="structure.disc.mount_group: expected .* HUB, NALL, found 'web'"):
        disc(Disc(**named, mount_group="web"))
    with pytest.raises(ConfigError, match="structure.disc.mount_group: .*it has none, found 'hub'"):
        disc(Disc(mount_group="hub"))


def test_to_state_the_default_is_a_change(deck):
    """The fingerprint of a stage tells a value that is stated from the same one that is the default."""
    named = deck(IRON)
    silent, stated = (settings_of(Disc(**named, **more)) for more in ({}, {"young": "120 GPa"}))
    assert stated == silent | {"(stated)": ["young"]} and "(stated)" not in settings_of(Disc(young="120 GPa"))
    whole = settings_of(Settings(disc=Disc(**named, young="120 GPa")))
    assert whole["disc.(stated)"] == ["young"]

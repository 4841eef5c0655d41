"""What is refined, by how much, and what is left as it is."""

import pytest

from pipeline.case_models.refinement.finer_settings import REFINEMENTS, finer, left_out, refined
from stages.structure import Settings

BRAKE = Settings.model_validate({"bracket": {"kind": "body"}, "piston": {"kind": "body"}, "pad": {"contact_points": 2}})


def test_every_body_gets_more_elements_in_every_direction():
    made = finer(BRAKE, REFINEMENTS, 1.5)
    assert (made.disc.web_cells, made.disc.ring_cells, made.disc.angular_cells) == (6, 15, 135)
    assert (made.pad.cells_per_patch, made.pad.lining_layers) == (3, 3)
    assert (made.caliper.radial_cells, made.caliper.angular_cells, made.caliper.bridge_cells) == (6, 12, 5)
    assert made.bracket.element_size == made.piston.element_size == pytest.approx(0.01 / 1.5)
    assert made.piston.angular_cells == 24 and finer(BRAKE, ["piston_mesh"], 1.1).piston.angular_cells == 20
    assert made.pad.contact_points == 2     # on more faces
    assert BRAKE.disc.web_cells == 4


def test_one_part_at_a_time_leaves_the_others():
    made = finer(BRAKE, ["disc_mesh"], 1.5)
    assert made.pad == BRAKE.pad and made.bracket == BRAKE.bracket and made.disc != BRAKE.disc
    assert finer(BRAKE, ["bases"], 1.5) == BRAKE


def test_contact_alone_has_more_points_on_a_face_or_smaller_patches():
    assert finer(BRAKE, ["contact"], 1.5).pad.contact_points == 3
    assert finer(BRAKE, ["contact"], 1.5, 5).pad.contact_points == 5
    patches = finer(Settings(), ["contact"], 1.5).pad
    assert (patches.patches_angular, patches.patches_radial, patches.cells_per_patch) == (12, 6, 1)


def test_files_and_bodies_that_are_none_are_not_refined(tmp_path):
    (tmp_path / "disc.inp").write_text("")
    given = Settings.model_validate({"disc": {"mesh_file": str(tmp_path / "disc.inp")}})
    assert refined(given, REFINEMENTS) == ("contact", "pad_mesh", "caliper_mesh", "bases")
    assert left_out(given, REFINEMENTS) == {"disc_mesh": "comes from a file"}
    assert left_out(given, ("contact", "pad_mesh", "disc_mesh", "bases")) == {
        "disc_mesh": "comes from a file", "caliper_mesh": "was not asked for"}
    assert left_out(BRAKE, REFINEMENTS) == {}
    assert set(left_out(BRAKE, ("bases",))) == set(REFINEMENTS) - {"bases"}

"""The chapter of the brake: its bodies and its joints by name."""

from pipeline.views.chapters import structure as chapter
from pipeline.views.figures import mode_shapes
from pipeline.views.figures.number_format import quantity
from tests.views import products_for_views as small


def test_every_body_is_drawn_and_listed_by_name():
    product = small.structure()
    names = [row[0] for row in chapter._bodies(product).rows]
    assert names == ["disc", "pad outer", "pad inner", "caliper", "bracket", "piston"]
    assert len(mode_shapes.assembly(product).solids) == 6
    assert {str(n) for n in product.body_name} <= set(mode_shapes.BODY_COLOURS) & set(chapter._BODY_COLOURS)


def test_joints_are_listed_with_what_they_connect():
    rows = {row[0]: row[1:] for row in chapter._joints(small.structure()).rows}
    assert rows["abutment outer leading"][:2] == ("pad outer and ground", "1")
    assert rows["abutment outer trailing"][:2] == ("pad outer and bracket", "1")
    assert rows["fluid column"][2] == quantity(4e8, "N/m")


def test_springs_of_one_kind_share_a_row():
    product = small.structure()
    both = small.filled(type(product.joint_rows), rows=2, row=[0, 1], body=[1, 1], weight=[1.0, 1.0], node=[0, 0],
                        axis=[0, 1])
    alike = small.filled(type(product), body_name=product.body_name, joint_rows=both, joint_stiffness=[1e7, 1e7],
                         joint_name=["abutment_outer_leading_radial", "abutment_outer_trailing_radial"],
                         fluid_stiffness=[], fluid_loss_factor=[])
    (row,) = chapter._joints(alike).rows
    assert row[:3] == ("abutment outer radial", "pad outer and ground", "2")


def test_notes_on_the_mesh_file_are_shown():
    product = small.filled(type(small.structure()), mesh_note=["disc: not read: *TIE"])
    assert chapter._mesh_notes(product) == ("Mesh file, disc: not read: *TIE.",)

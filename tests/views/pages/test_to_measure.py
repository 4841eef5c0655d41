"""What the report lists to be measured first."""

from dataclasses import replace
from types import SimpleNamespace

from pipeline.contract.context import CaseSummary
from pipeline.views.pages.to_measure import statement, to_measure
from tests.views import products_for_views as small

CASE = CaseSummary(
    settings={"structure": {"joints.finger_stiffness": 4e8, "joints.abutment_stiffness": 5e7, "disc.young": 1.2e11,
                            "disc.angular_cells": 90, "pad.lining_loss_factor": 0.03, "disc.density": 7200.0},
              "complex_modes": {"damping_speed": 1.0}},
    origins={"structure": {"pad.lining_loss_factor": {"origin": "assumed"}, "disc.density": {"origin": "user"}}},
    units={"structure": {"joints.finger_stiffness": "N/m", "joints.abutment_stiffness": "N/m", "disc.young": "Pa"},
           "complex_modes": {"damping_speed": "m/s"}})


def names(products):
    return [row[0] for table in to_measure(CASE, products) for row in table.rows]


def test_defaults_come_before_what_is_assumed_and_numerics_are_left_out():
    assert names({}) == ["complex_modes.damping_speed", "structure.joints.abutment_stiffness",
                         "structure.joints.finger_stiffness", "structure.disc.young",
                         "structure.pad.lining_loss_factor"]
    assert statement(CASE, {}).startswith(
        "Of the values that decide this verdict, 4 are defaults of the program and 1 is assumed:")


def test_what_is_known_of_their_influence_orders_them():
    """A source of scatter speaks for the values of its group."""
    probable = SimpleNamespace(value=[[1.0]], source=["joint_stiffness:finger", "damping_speed", "body_loss"],
                               sensitivity=[0.6, 0.2, 0.9])
    assert names({"probability": probable})[:2] == ["structure.joints.finger_stiffness", "complex_modes.damping_speed"]
    assert names({"probability": probable})[-1] == "structure.pad.lining_loss_factor"
    assert "60\u202f% of the variance" in to_measure(CASE, {"probability": probable})[0].rows[0][3]


def test_sensitivities_order_them_where_they_are_known():
    """By their own names, by a value that stands for them, or by the factor of their group."""
    product = small.sensitivities()
    named = replace(product, parameter=["structure.joints.finger_stiffness", "structure.pad.lining_loss_factor",
                                        "friction", "structure.disc.young", "damping_speed"])
    probable = SimpleNamespace(value=[[1.0]], source=["damping_speed"], sensitivity=[0.9])
    both = {"sensitivities": named, "probability": probable}
    assert names(both)[:2] == ["structure.joints.finger_stiffness", "structure.disc.young"]
    said = [row[3] for table in to_measure(CASE, both) for row in table.rows]
    assert said[0] == "+120\u202f1/s by one standard deviation, of the mode at 10.9\u202fkHz" and "—" in said
    assert "−60" in said[names(both).index("structure.pad.lining_loss_factor")]


def test_other_systems_have_no_such_list():
    other = CaseSummary(settings={"complex_modes": {"damping_speed": 1.0}})
    assert to_measure(other, {}) == () and statement(other, {}) == ""


def test_values_that_a_mesh_file_gives_are_no_defaults():
    joints = ["finger_normal_leading_inner", "abutment_outer_leading_radial"]
    given = {"structure": SimpleNamespace(mesh_given=["disc.young", "disc.density"], joint_name=joints)}
    assert "structure.disc.young" in names({}) and "structure.disc.young" not in names(given)
    assert "3 are defaults of the program" in statement(CASE, given)


def test_values_without_effect_are_not_asked_for():
    """The density of the rubber of a shim of no thickness; whether there is a shim is asked for."""
    settings = {"structure": {"pad.shim_rubber_density": 1200.0, "pad.shim_rubber_thickness": 0.0}}
    idle = {"structure": {"pad.shim_rubber_density": "pad.shim_rubber_thickness"}}
    assert len(to_measure(CaseSummary(settings=settings), {})[0].rows) == 2
    left = to_measure(CaseSummary(settings=settings, idle=idle), {})[0].rows
    assert [row[0] for row in left] == ["structure.pad.shim_rubber_thickness"]


def test_loss_factors_of_joints_that_the_brake_lacks_are_not_asked_for():
    """Nor the shim below a piston that is no body, though its seal is a joint of pistons."""
    case = CaseSummary(settings={"structure": {"joints.bolt_loss_factor": 0.0, "joints.abutment_loss_factor": 0.0,
                                               "joints.shim_stiffness": 4e8, "joints.piston_stiffness": 1e5}})
    brake = SimpleNamespace(mesh_given=[], joint_name=["abutment_outer", "piston_normal"])
    found = {row[0] for table in to_measure(case, {"structure": brake}) for row in table.rows}
    assert found == {"structure.joints.abutment_loss_factor", "structure.joints.piston_stiffness"}
    brake.joint_name += ["seal_axial_1", "bolt_1"]
    assert sum(len(table.rows) for table in to_measure(case, {"structure": brake})) == 4


def test_joints_that_the_brake_lacks_are_not_asked_for():
    """A fixed caliper has no fingers."""
    fixed = {"structure": SimpleNamespace(mesh_given=[], joint_name=["abutment_outer_leading_radial"])}
    assert set(names({})) - set(names(fixed)) == {"structure.joints.finger_stiffness"}

"""Points of a design space: shares and back, what they change, what they cost."""

import numpy as np
import pytest

from pipeline.case_models.design_search.declared import stated
from pipeline.case_models.design_search.space import _spelt, space_of
from tests.case_models.design_search.sections import sections

FINGER, THICKNESS, KIND = 0, 1, 2


@pytest.fixture
def brake(tmp_path):
    filled = sections(tmp_path, more="  weight: {price: 3.0, mass: 10.0}\n")
    return space_of(filled["design_search"], stated(filled))


def test_the_case_is_a_point_and_costs_nothing(brake):
    assert brake.own == (4e8, 0.011, 0) and brake.cost(brake.own) == 0 and not brake.moved(brake.own).any()
    assert brake.ranges == [FINGER, THICKNESS] and brake.lists == [KIND] and brake.combinations() == 2


def test_shares_lead_to_points_and_back(brake):
    point = brake.at([0.5, 0.5], brake.own)
    assert point[FINGER] == pytest.approx(10**8.5, rel=1e-5) and point[THICKNESS] == pytest.approx(0.0105)
    np.testing.assert_allclose(brake.shares(point), [0.5, 0.5], atol=1e-5)
    assert brake.at(brake.shares(brake.own), brake.own) == brake.own, "the case as it is, whatever its digits"
    assert brake.at([0.0, 1.0], brake.own)[:2] == (1e8, 0.012)


def test_the_slope_of_a_value_over_its_share_is_that_of_its_scale(brake):
    for k in (FINGER, THICKNESS):
        value, step = brake.values[k], 1e-3
        slope = (value.at(0.4 + step) - value.at(0.4 - step)) / (2 * step)
        assert slope == pytest.approx(value.scale(value.at(0.4)), rel=5e-3)


def test_what_a_point_changes_is_written_as_a_case_does(brake):
    assert brake.changes((2e8, 0.0105, 1)) == {
        "structure.joints.finger_stiffness": "200 MN/m", "structure.pad.lining_thickness": "10.5 mm",
        "structure.bracket.kind": "body"}


def test_costs_grow_with_the_way_from_the_case(brake):
    point = (4e8, 0.0095, 1)
    assert brake.costs(point) == {"price": ("EUR", pytest.approx(2 * 0.5 + 10)), "mass": ("kg", pytest.approx(0.05))}
    assert brake.cost(point) == pytest.approx(3 * 11 + 10 * 0.05)
    slopes, step = brake.cost_slopes(point), 1e-3
    beside = brake.at(brake.shares(point) + [0, step], point)
    assert (brake.cost(beside) - brake.cost(point)) / step == pytest.approx(slopes[1], rel=1e-3) and slopes[1] < 0


def test_a_case_outside_the_space_is_no_point_of_it(tmp_path):
    outside = "\n    structure.pad.lining_thickness: {from: 12 mm, to: 14 mm}\n"
    filled = sections(tmp_path, outside)
    brake = space_of(filled["design_search"], stated(filled))
    assert brake.own is None and brake.values[0].case == (0.011, "11 mm") and brake.values[0].start == 0


def test_numbers_without_a_unit_are_written_bare(tmp_path):
    filled = sections(tmp_path, "\n    structure.pad.lining_loss_factor: {from: 0, to: 0.2}\n")
    brake = space_of(filled["design_search"], stated(filled))
    assert brake.changes((0.1,)) == {"structure.pad.lining_loss_factor": 0.1} and brake.values[0].case == (0.0, 0.0)


@pytest.mark.parametrize("written, unit, spelt", [
    ("100 MN/m", "N/m", ("MN/m", 1e6)), ("1e-3m", "m", ("m", 1.0)), ("50 deg", "rad", ("deg", np.pi / 180)),
    ("20 degC", "K", ("K", 1.0)), (0.1, "1", ("", 1.0))])
def test_values_are_written_in_the_unit_of_the_case(written, unit, spelt):
    assert _spelt(written, unit) == (spelt[0], pytest.approx(spelt[1]))


def test_a_list_holds_the_case_in_any_unit(tmp_path):
    filled = sections(tmp_path, "\n    structure.pad.lining_thickness: {values: [9 mm, 1.1 cm]}\n"
                                "    structure.pad.lining_loss_factor: {values: [0.5, 0.25]}\n")
    brake = space_of(filled["design_search"], stated(filled))
    assert brake.values[0].own == 1 and brake.values[0].case == (1.0, "1.1 cm")
    assert brake.values[1].own is None and brake.values[1].case == (-1.0, 0.0) and brake.own is None
    assert brake.every_combination() == [(0, 0), (0, 1), (1, 0), (1, 1)]

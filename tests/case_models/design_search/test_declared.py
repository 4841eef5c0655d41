"""Spaces that cannot be searched are refused in one sentence, before anything is computed."""

import pytest

from pipeline.case_models.design_search.declared import at_ends, columns, ends, numbers, stated
from pipeline.contract import ConfigError
from tests.case_models.design_search.sections import loaded, sections


@pytest.mark.parametrize("space, message", [
    ("structure.pad.lining_thickness: {from: 12 mm, to: 9 mm}", "expected a lower end below the upper one, found from"
     " 12 mm to 9 mm; exchange them"),
    ("structure.pad.lining_thickness: {from: 9 kg, to: 12 kg}", "lining_thickness.from: expected a quantity in m"),
    ("structure.pad.lining_thickness: {from: 9, to: 12}", "9.0 without a unit"),
    ("structure.pad.linning_thickness: {from: 9 mm, to: 12 mm}", "did you mean 'structure.pad.lining_thickness'"),
    ("structure.caliper.added_mass: {from: 0 g, to: 50 g}", "expected a setting that is a number"),
    ("pads.mass: {from: 9 mm, to: 12 mm}", "expected 'stage.key' with a stage of the chain"),
    ("probability.draws: {values: [5, 10]}", "which modes depend on"),
    ("structure.pressures: {values: [1 MPa, 2 MPa]}", "operating points are compared one by one"),
    ("structure.pad.lining_thickness: {}", "expected from and to, or values"),
    ("structure.pad.lining_thickness: {from: 9 mm}", "lining_thickness.to: expected from and to"),
    ("structure.pad.lining_thickness: {from: 9 mm, to: 12 mm, values: [9 mm, 10 mm]}", "found both"),
    ("structure.pad.lining_thickness: {values: [9 mm]}", "at least two values"),
    ("structure.pad.lining_thickness: {values: [9 mm, 9 mm]}", "each once"),
    ("structure.pad.patches_radial: {from: 2, to: 4}", "or state values"),
    ("structure.pad.lining_loss_factor: {from: 0, to: 0.2, log: true}", "above 0 where log is true"),
    ("structure.pad.lining_thickness: {from: -1 mm, to: 12 mm}", "variant design_search.space.structure.pad.lining_thic"
     "kness.from of design_search: .*greater than 0"),
    ("structure.bracket.kind: {values: [ground, bdoy]}", "bracket"),
    ("structure.pad.lining_thickness: {from: 9 mm, to: 12 mm, cost: {price: much}}", "price: expected a number"),
    ("structure.pad.lining_thickness: {form: 9 mm, to: 12 mm}", "form: unknown key; did you mean 'from'")])
def test_bad_spaces_are_refused(tmp_path, space, message):
    with pytest.raises(ConfigError, match=message) as error:
        loaded(tmp_path, f"\n    {space}\n")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("more, message", [
    ("  budget: 3\n", "design_search.budget: expected at least one brake for each of the 4 starts, found 3"),
    ("  weight: {prise: 2}\n", "weight.prise: expected a column of costs of the space: price, mass"),
    ("  starts: 0\n", "starts: input should be greater than or equal to 1")])
def test_budgets_and_weights_that_do_not_fit_are_refused(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        loaded(tmp_path, more=more)


def test_costs_of_a_column_have_one_unit(tmp_path):
    space = "\n    structure.pad.lining_thickness: {from: 9 mm, to: 12 mm, cost: {mass: 0.1 kg}}" \
            "\n    structure.disc.ring_thickness: {from: 6 mm, to: 7 mm, cost: {mass: 100 g}}\n"
    with pytest.raises(ConfigError, match="cost.mass: expected kg, as in the values before, found 'g'"):
        loaded(tmp_path, space)


def test_an_empty_space_searches_nothing(tmp_path):
    assert sections(tmp_path, space="")["design_search"].space == {}


def test_ends_are_in_si_and_checked_one_at_a_time(tmp_path):
    filled = sections(tmp_path)
    known, settings = numbers(stated(filled)), filled["design_search"]
    name = "structure.pad.lining_thickness"
    assert known[name] == (0.011, "m") and ends(name, settings.space[name], "m") == pytest.approx((0.009, 0.012))
    assert list(at_ends(settings).values())[:2] == [
        {"structure.joints.finger_stiffness": "100 MN/m"}, {"structure.joints.finger_stiffness": "1000 MN/m"}]
    assert list(at_ends(settings).values())[-1] == {"structure.bracket.kind": "body"}
    assert columns(settings) == {"price": ("EUR", {name: 2.0, "structure.bracket.kind": 10.0}),
                                 "mass": ("kg", {name: 0.1})}

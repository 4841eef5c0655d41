"""The best design: as a countermeasure, as YAML that reads back, and beside declared variants."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from pipeline.case_models.design_search.best import as_text, best_changes, check_beside, fragment, searched
from pipeline.contract import ConfigError
from tests.case_models.design_search.sections import loaded, sections


def product(best=1):
    return SimpleNamespace(
        parameter=np.array(["structure.pad.lining_thickness", "structure.bracket.kind", "structure.disc.loss_factor"]),
        written=np.array([["0.011 m", "ground", "0"], ["0.01 m", "ground", "0.02"]]), best=best, computed=12,
        case_value=np.array(["0.011 m", "ground", "0"]), cost_name=["price"], cost_unit=["EUR"], best_cost=[2.0],
        objective=np.array([50.0, 3.0]))


def test_the_best_design_is_a_variant_with_its_cost():
    variant = searched(product())["best_design"]
    assert variant.change == {"structure.pad.lining_thickness": "0.01 m", "structure.disc.loss_factor": 0.02}
    assert variant.cost == {"price": "2 EUR"} and variant.note == "best of 12 brakes of a search"
    assert searched(None) == {} == searched(product(0)) == searched(product(-1)) == best_changes(product(0))


def test_the_fragment_is_yaml_that_a_case_takes(tmp_path):
    text = fragment(product(), "brake")
    assert "objective 3 1/s, 50 1/s in brake" in text
    written = yaml.safe_load(text)["structure"]
    assert written["pad"]["lining_thickness"] == {"value": "0.01 m", "origin": "tuned",
                                                  "source": "design_search of brake"}
    assert sections(tmp_path, space="", rest=text)["structure"].disc.loss_factor == 0.02


@pytest.mark.parametrize("value, text", [("body", "body"), (0.5, "0.5"), (True, "true"), (None, "null"),
                                         ({"kind": "body"}, '{"kind": "body"}')])
def test_values_are_text_that_yaml_reads_back(value, text):
    assert as_text(value) == text and yaml.safe_load(text) == value


@pytest.mark.parametrize("variant, message", [
    ("best_design: {change: {structure.pad.lining_thickness: 8 mm}}", "best_design: expected another name"),
    ("thin: {change: {structure.pad.lining_thickness: 8 mm}, cost: {mass: 3 g}}", "cost.mass: expected g")])
def test_declared_variants_leave_it_its_name_and_units(tmp_path, variant, message):
    with pytest.raises(ConfigError, match=message):
        loaded(tmp_path, rest=f"countermeasures:\n  variants:\n    {variant}\n")


def test_a_chain_without_a_search_has_nothing_to_check():
    check_beside({"countermeasures": SimpleNamespace(variants={"best_design": None})})

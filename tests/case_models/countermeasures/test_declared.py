"""Declared countermeasures: what is refused, and columns of costs."""

import pytest

from pipeline.case_models.countermeasures.declared import (
    Variant,
    changes,
    check_declared,
    check_different,
    costs,
)
from pipeline.case_models.operating_points import MODES_ALONE
from pipeline.contract import ConfigError, Quantities, Section, option

KNOWN = ("surface", "structure", "complex_modes", "probability", "countermeasures", "report")


class Brake(Section):
    """Stands for the section structure."""

    pressures: Quantities("Pa") = option(("1 MPa",), "pressures")
    loss: float = 0.01


class Modes(Section):
    """Stands for the section complex_modes."""

    speeds: Quantities("rad/s") = option(("8 rad/s",), "speeds")
    friction_steps: int = 9
    residual_tolerance: float | None = 1e-6
    followed: int = 12
    squeal_from: float = 1e3


def variants(**given):
    return {name: Variant.model_validate(values) for name, values in given.items()}


@pytest.mark.parametrize("change, message", [
    ({}, "shim.change: expected at least one setting that it changes, found none"),
    ({"structur.loss": 1}, "found 'structur.loss'; did you mean 'structure'"),
    ({"structure": {}}, "'stage.key' with a stage of the chain, found 'structure'"),
    ({"multibody.step": "1 us"}, "with a stage of the chain"),
    ({"report.dots_per_inch": 90}, "expected settings of surface, structure, complex_modes, which modes depend on"),
    ({"probability.draws": 5}, "which modes depend on, found 'probability.draws'"),
    ({"complex_modes.friction_steps": 5}, "in the reduced model, without a sweep"),
    ({"structure.pressures": ["2 MPa"]}, "operating points are compared one by one")])
def test_changes_that_say_nothing_are_refused(change, message):
    with pytest.raises(ConfigError, match=message):
        check_declared(variants(shim={"change": change}), KNOWN)


def test_what_varies_is_computed_in_the_reduced_model_without_a_sweep():
    given = variants(shim={"change": {"structure.loss": 0.1}})
    check_declared(given, KNOWN)
    assert changes(given, {"probability.draws": 3}) == {
        "countermeasures.shim": {"structure.loss": 0.1, **MODES_ALONE, "probability.draws": 3}}


def sections(loss=0.01, steps=9, **more):
    brake = Brake.model_validate({"loss": loss, **more})
    return {"structure": brake, "complex_modes": Modes(friction_steps=steps), "report": Brake()}


def test_variants_that_are_no_different_are_refused():
    base = sections()
    check_different(base, {"countermeasures.a": sections(0.1, steps=2), "countermeasures.b": sections(0.2, steps=2)})
    with pytest.raises(ConfigError, match="variants.a: expected settings that differ .*found those of the case"):
        check_different(base, {"countermeasures.a": sections(steps=2)})
    with pytest.raises(ConfigError, match="variants.b: .*found those of a; change another value"):
        check_different(base, {f"countermeasures.{name}": sections(0.1, steps=2) for name in "ab"})
    with pytest.raises(ConfigError, match="variants.a: expected the structure.pressures of the case"):
        check_different(base, {"countermeasures.a": sections(pressures=("2 MPa",))})


def test_costs_are_columns_of_ones_own():
    made = costs(variants(shim={"cost": {"mass": "0.1 kg", "price": 2}}, slot={"cost": {"price": 1.5}},
                          mount={"cost": {"mass": "1.2e-1 kg", "tools": "3 EUR/part"}}))
    assert made == [("mass", "kg", {"shim": 0.1, "mount": 0.12}), ("price", "", {"shim": 2.0, "slot": 1.5}),
                    ("tools", "EUR/part", {"mount": 3.0})]
    with pytest.raises(ConfigError, match="slot.cost.mass: expected kg, as in the variants before, found 'g'"):
        costs(variants(shim={"cost": {"mass": "0.1 kg"}}, slot={"cost": {"mass": "90 g"}}))
    with pytest.raises(ConfigError, match="shim.cost.mass: expected a number"):
        costs(variants(shim={"cost": {"mass": "little"}}))

"""Stage countermeasures: which variants it asks for, and what its product says of a brake of a few elements."""

from dataclasses import replace
from functools import cache
from types import MappingProxyType, SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError, Context, Section, case
from pipeline.contract.store import read, write
from pipeline.products import Countermeasures
from stages import CHAINS, load
from stages.countermeasures import Settings, countermeasures
from stages.probability import Settings as Draws
from stages.probability import probability
from tests.case_models.countermeasures.two_brakes import brake, convergence
from tests.diagnosis.small_rig import effects
from tests.stages.two_processes import TwoProcesses

SOURCES = ({"kind": "joint_stiffness", "variation": 0.3}, {"kind": "friction", "variation": 0.05})
VARIANTS = {
    "damped": {"change": {"structure.joints.loss_time": "6 us"}, "cost": {"mass": "0.1 kg", "price": 2},
               "note": "more damping of joints"},
    "rougher": {"change": {"micro_friction.third_body_factor": 1.1}, "cost": {"price": 0}}}
BRAKES = {"damped": {"loss": 3.0}, "rougher": {"friction": 0.62}}


class Sampled(Section):
    """Stands for the section probability."""

    draws: int = 10


@cache
def drawn(draws, **changed):
    """Draws of the brake, or of one that is changed."""
    given = brake(**changed)
    return probability(given.model, given.friction_map, given.modes, settings=Draws(
        draws=draws, checked=0, training=2, sources=SOURCES))


def made(variants=VARIANTS, draws=20, of_variants=None, context=None, search=None, more=MappingProxyType({}),
         **settings):
    base, empty = brake(), effects({})
    changed = {f"countermeasures.{name}": {**BRAKES, **more}[name] for name in (*variants, *more)}
    others = {name: brake(**change) for name, change in changed.items()}
    return countermeasures(
        base.modes, base.model, base.friction_map, empty, convergence(), drawn(draws), search,
        varied_modes={name: other.modes for name, other in others.items()},
        varied_models={name: other.model for name, other in others.items()},
        varied_maps={name: other.friction_map for name, other in others.items()},
        varied_effects=dict.fromkeys(others, empty),
        varied_probabilities={name: drawn(draws if of_variants is None else of_variants, **change)
                              for name, change in changed.items()},
        settings=Settings.model_validate({"variants": variants, **settings}), context=context or Context())


@pytest.fixture(scope="module")
def product():
    return made()


def test_what_helps_and_what_makes_worse_is_told(product):
    assert list(product.variant) == ["damped", "rougher"] and product.change[0] == "structure.joints.loss_time: 6 us"
    of = [product.state[product.mode_variant == k] for k in range(2)]
    assert set(of[0]) == {"gone"} and set(of[1]) == {"stronger", "new"}
    assert product.overall_change[0] < 0 < product.overall_change[1]
    assert product.overall_change_interval[0, 1] < 0, "the change exceeds its interval"
    np.testing.assert_allclose(product.variant_overall - product.overall, product.overall_change, atol=1e-12)
    np.testing.assert_allclose(product.variant_probability - product.probability, product.probability_change,
                               atol=1e-12)
    assert product.paired.all() and product.draws == 20
    used = product.band_probability > 0
    assert used.any() and (product.variant_band_probability[0] <= product.band_probability)[used].all()
    assert (product.band_change_interval[1, :, 1] > 0).all()


def test_the_number_of_workers_changes_no_bit(product):
    again = made(context=TwoProcesses())
    assert list(again.state) == list(product.state)
    np.testing.assert_array_equal(again.after, product.after)
    np.testing.assert_array_equal(again.mac, product.mac)


def test_costs_are_those_stated(product):
    assert list(product.cost_name) == ["mass", "price"] and list(product.cost_unit) == ["kg", ""]
    np.testing.assert_array_equal(product.cost, [[0.1, 2], [0, 0]])
    np.testing.assert_array_equal(product.cost_known, [[1, 1], [0, 1]])


def test_its_product_survives_its_file(product, tmp_path):
    write(product, tmp_path / "countermeasures.h5", {})
    again = read(Countermeasures, tmp_path / "countermeasures.h5")
    np.testing.assert_array_equal(again.after, product.after)
    assert list(again.state) == list(product.state)


SEARCHED = SimpleNamespace(
    best=1, computed=7, parameter=np.array(["structure.joints.loss_time"]), case_value=np.array(["5 us"]),
    written=np.array([["5 us"], ["6 us"]]), cost_name=["price"], cost_unit=[""], best_cost=[3.0])


def test_the_best_design_of_a_search_is_one_more_variant():
    settings = Settings.model_validate({"variants": VARIANTS, "draws": 5})
    sections = {"countermeasures": settings, "probability": Sampled()}
    asked = countermeasures.further(sections, {"search": SEARCHED}, None)
    changes = asked["countermeasures.best_design"]
    assert list(asked) == ["countermeasures.best_design"] and changes["structure.joints.loss_time"] == "6 us"
    assert changes["probability.draws"] == 5 and changes["complex_modes.followed"] == 0
    assert countermeasures.further(sections, {"search": None}, None) == {}


def test_the_best_design_is_compared_beside_the_declared_variants():
    product = made(search=SEARCHED, more={"best_design": {"loss": 3.0}})
    assert list(product.variant) == ["damped", "rougher", "best_design"]
    assert product.note[2] == "best of 7 brakes of a search" and product.cost[2, 1] == 3.0
    assert set(product.state[product.mode_variant == 2]) == {"gone"}


def test_without_variants_nothing_is_compared():
    nothing = made(variants={})
    assert not len(nothing.variant) and not len(nothing.before) and nothing.variant_probability.shape == (0, 4)


@pytest.mark.parametrize("settings", [{"probability": False}, {"of_variants": 10}], ids=["modes", "fewer"])
def test_probabilities_are_left_out_or_of_fewer_draws(settings):
    product = made({"damped": VARIANTS["damped"]}, **settings)
    assert set(product.state) == {"gone"}
    assert list(product.variant_draws) == [settings.get("of_variants", 0)] and not product.paired.any()
    assert len(product.sampled_speed) == (4 if "of_variants" in settings else 0)


@pytest.mark.parametrize("settings, draws, expected", [
    ({}, 10, None), ({"draws": 5}, 10, 5), ({"probability": False}, 10, 0), ({"draws": 5}, 0, 0)])
def test_variants_are_drawn_as_asked_for(settings, draws, expected):
    sections = {"countermeasures": Settings.model_validate({"variants": VARIANTS, **settings}),
                "probability": Sampled(draws=draws)}
    changes = countermeasures.variants(sections)
    assert list(changes) == ["countermeasures.damped", "countermeasures.rougher"]
    assert changes["countermeasures.damped"].get("probability.draws") == expected
    assert changes["countermeasures.rougher"]["micro_friction.third_body_factor"] == 1.1


@pytest.mark.parametrize("variants, message", [
    ("shim: {change: {structure.pad.linig_thickness: 9 mm}}",
     "variant countermeasures.shim of countermeasures: .*linig_thickness: unknown key; did you mean 'lining_thick"),
    ("shim: {change: {structure.pad.lining_thickness: 9 kg}}", "lining_thickness: expected a quantity in m"),
    ("shim: {change: {structure.pad.lining_thickness: 9 mm}}\n    two: {change: {structure.pad.lining_thickness:"
     " 0.9 cm}}", "variants.two: expected settings that differ"),
    ("shim: {cost: {mass: 0.1 kg}}", "shim.change: expected at least one setting"),
    ("a/b: {change: {structure.pad.lining_thickness: 9 mm}}", "a name of letters"),
    ("shim: {change: {structure.pressures: [1 MPa]}}", "operating points are compared one by one")])
def test_a_case_with_bad_variants_is_refused_at_once(tmp_path, variants, message):
    path = tmp_path / "brake.yaml"
    path.write_text(f"chain: own_brake\ncountermeasures:\n  variants:\n    {variants}\n")
    with pytest.raises(ConfigError, match=message):
        case.load(path, CHAINS, load)


def test_a_shape_that_the_variant_lacks_is_not_compared():
    """A variant whose surface has nothing in common with that of the case: no match is forced."""
    from pipeline.case_models.countermeasures.matching import compared_modes

    other = brake(loss=3.0)
    far = replace(other, model=replace(other.model, visible_position=other.model.visible_position + 10.0))
    rows = compared_modes(brake(), far, convergence(), 1e-6)
    assert {row.state for row in rows} == {"gone"} and all(row.after is None and not row.clear for row in rows)

"""Stage design_search on a brake of a few elements: a planted remedy is found, by rounds as a run computes them."""

import csv

import numpy as np
import pytest
import yaml

from pipeline.contract import Context
from pipeline.contract.case import CaseText
from pipeline.contract.store import read, write
from pipeline.products import DesignSearch
from stages.design_search import Settings, design_search
from stages.sensitivities import Settings as Derivatives
from stages.sensitivities import sensitivities
from tests.case_models.countermeasures.two_brakes import brake
from tests.case_models.design_search.sections import loaded

#: settings that stand for factors on damping and on the stiffness of joints of the small brake
LOSS, STIFFNESS = "structure.pad.lining_loss_factor", "structure.disc.loss_factor"
SPACE = f"""
    {LOSS}: {{from: 0.5, to: 4, cost: {{price: 2 EUR}}}}
    {STIFFNESS}: {{from: 0.8, to: 1.25, log: true}}
"""
REST = "structure: {pad: {lining_loss_factor: 1.0}, disc: {loss_factor: 1.0}}\n"


def products(changes):
    """{argument: product} of the small brake with what a variant changes."""
    made = brake(loss=changes.get(LOSS, 1.0), stiffness=changes.get(STIFFNESS, 1.0))
    derived = sensitivities(made.model, made.friction_map, made.modes, None, None, None, varied={},
                            settings=Derivatives(modes=0))
    return {"varied_modes": made.modes, "varied": derived}


def run(folder, space=SPACE, more="  budget: 12\n  starts: 2\n  seed: 4\n", rest=REST):
    """(product, {name of a brake: its products}, sections, number of rounds) of a search that is computed in rounds."""
    case = loaded(folder, space, more, rest)
    sections, base, done, rounds = case.sections, products({}), {}, 0
    given = {"modes": base["varied_modes"], "sensitivities": base["varied"]}

    while new := {name: changes for name, changes in
                  design_search.further(sections, given, lambda name, _: done.get(name)).items() if name not in done}:
        done.update((name, products(changes)) for name, changes in new.items())
        rounds += 1
    varied = {key: {name: each[key] for name, each in done.items()} for key in base}
    made = design_search(base["varied_modes"], base["varied"], **varied, settings=sections["design_search"],
                         context=Context(case=case.card("")))
    return made, done, sections, rounds


@pytest.fixture(scope="module")
def searched(tmp_path_factory):
    return run(tmp_path_factory.mktemp("case"))


def test_the_planted_remedy_is_found(searched):
    """Three times the damping makes every mode of this brake stable, as the test of countermeasures has it."""
    product = searched[0]
    best = int(product.best)
    assert product.growth[0] > 0 and product.growth[best] == 0 and product.unstable[best] == 0
    assert product.value[best, 0] > 1.0 and not product.growth_after.any() and product.growth_before.max() > 0
    assert product.computed == len(product.brake) - 1 <= 12


def test_the_course_holds_every_brake_with_its_growth(searched):
    product, done, _, rounds = searched
    assert list(product.brake) == ["case", *done] and rounds > 1 and product.round.max() == rounds - 1
    for name, growth in zip(product.brake[1:], product.growth[1:], strict=True):
        roots = done[name]["varied_modes"].unstable_reduced
        assert growth == roots.real.max(initial=0.0)
    text = design_search.companions(product, CaseText("brake", {}))["design_search.csv"]
    rows = list(csv.DictReader(text.splitlines()))
    assert len(rows) == len(product.brake) and sum(row["best"] == "best" for row in rows) == 1


def test_the_best_design_is_a_piece_of_yaml(searched):
    product = searched[0]
    text = design_search.companions(product, CaseText("brake", {}))["best_design.yaml"]
    value = yaml.safe_load(text)["structure"]["pad"]["lining_loss_factor"]["value"]
    assert value == product.value[int(product.best), 0]


def test_what_was_not_searched_is_said(searched):
    product = searched[0]
    text = " ".join(product.not_searched)
    assert "settings that are numbers" in text and "box of 2 ranges" in text and "no better design exists" in text
    assert list(product.slope) == ["differences", "differences"] and len(product.start_ended) == 2


def test_the_same_brakes_are_asked_for_again(searched):
    _, done, sections, _ = searched
    base = products({})
    given = {"modes": base["varied_modes"], "sensitivities": base["varied"]}
    assert list(design_search.further(sections, given, lambda name, _: done[name])) == list(done)


def test_brakes_are_computed_in_the_reduced_model_without_draws(searched):
    _, _, sections, _ = searched
    base = products({})
    asked = design_search.further(sections, {"modes": base["varied_modes"], "sensitivities": base["varied"]},
                                  lambda *_: None)
    for changes in asked.values():
        assert changes["probability.draws"] == 0 and changes["complex_modes.residual_tolerance"] is None
        assert changes["sensitivities.modes"] is None and {LOSS, STIFFNESS} < changes.keys()


def test_its_product_survives_its_file(searched, tmp_path):
    product = searched[0]
    write(product, tmp_path / "design_search.h5", {})
    again = read(DesignSearch, tmp_path / "design_search.h5")
    np.testing.assert_array_equal(again.value, product.value)
    assert list(map(list, again.written)) == list(map(list, product.written))


def test_weighted_costs_leave_a_remedy_that_is_too_dear(tmp_path):
    product, *_ = run(tmp_path, more="  budget: 6\n  starts: 1\n  weight: {price: 1e6}\n")
    assert product.best == 0 and list(product.best_cost) == [0.0] and product.objective[1:].min() > product.objective[0]
    assert design_search.companions(product, CaseText("brake", {})).keys() == {"design_search.csv"}


def test_lists_alone_are_tried_whole(tmp_path):
    product, done, *_ = run(tmp_path, f"\n    {LOSS}: {{values: [1, 2, 3]}}\n", "  starts: 1\n  budget: 2\n")
    assert len(done) == 2 and product.written[int(product.best), 0] in ("2", "3") and product.slope[0] == "list"
    assert "Every design of the space was tried" in " ".join(product.not_searched)


def test_without_a_space_nothing_is_searched():
    base = products({})
    product = design_search(base["varied_modes"], base["varied"], varied_modes={}, varied={}, settings=Settings())
    assert product.best == -1 and not len(product.brake) and not len(product.not_searched)
    assert design_search.companions(product, CaseText("brake", {})) == {}

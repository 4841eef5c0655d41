"""A search on a brake on coarse grids: a planted remedy is found among values that do little, and is compared."""

import csv

import numpy as np
import pytest

from pipeline.case_models.design_search.declared import stated
from pipeline.case_models.design_search.objective import evaluation
from pipeline.case_models.design_search.space import space_of
from pipeline.contract import case, store
from pipeline.products import ComplexModes, Countermeasures, DesignSearch, Sensitivities
from stages import CHAINS, load
from tests.commands import brakechain

#: soft fingers are what this brake squeals by; the pins and the seal hardly matter
SEARCHED = """based_on: my_brake_quick.yaml
title: soft fingers
structure: {joints: {finger_stiffness: 300 MN/m}}
probability: {draws: 0}
limit_cycle: {checks: []}
design_search:
  budget: 6
  starts: 1
  space:
    structure.joints.finger_stiffness: {from: 200 MN/m, to: 1000 MN/m, log: true, cost: {price: 1 EUR}}
    structure.joints.guide_pin_stiffness: {from: 15 MN/m, to: 25 MN/m}
    structure.joints.seal_loss_factor: {from: 0.05, to: 0.15}
"""


def slope_at_the_case(folder):
    """Change of the growth by the stiffness of the fingers, in shares of its range, as the search takes it."""
    sections = case.load(folder / "soft.yaml", CHAINS, load).sections
    space = space_of(sections["design_search"], stated(sections))
    modes, derived = (store.read(each, folder / "run" / f"{each.name}.h5") for each in (ComplexModes, Sensitivities))
    return evaluation(space, space.own, modes, derived, "largest").slopes[0]


def secant(product):
    """The same from the case to the first step, in which all else hardly moves."""
    shares = np.log(product.value[:2, 0] / product.lower[0]) / np.log(product.upper[0] / product.lower[0])
    return np.diff(product.growth[:2])[0] / np.diff(shares)[0]


@pytest.mark.slow
@pytest.mark.study
def test_a_planted_remedy_is_found_and_compared(tmp_path):
    brakechain("new", tmp_path / "my_brake", "--quick")
    (tmp_path / "soft.yaml").write_text(SEARCHED)
    command = ("run", tmp_path / "soft.yaml", "--run", tmp_path / "run", "--workers", "1")
    brakechain(*command)
    product = store.read(DesignSearch, tmp_path / "run" / "design_search.h5")
    best, finger = int(product.best), product.value[:, 0]
    assert product.objective[best] < 0.7 * product.objective[0] and finger[best] > 6e8
    assert set(map(str, product.slope)) == {"analytic"} and product.computed == len(product.brake) - 1 <= 6
    assert slope_at_the_case(tmp_path) == pytest.approx(secant(product), rel=0.35), "to first order, over a third"
    made = store.read(Countermeasures, tmp_path / "run" / "countermeasures.h5")
    assert list(made.variant) == ["best_design"] and list(made.cost_name) == ["price"]
    known = made.after[made.after_known == 1].real.max()
    assert known == pytest.approx(product.growth[best], rel=0.15), "moved by what full matrices move roots of the case"
    rows = list(csv.DictReader((tmp_path / "run" / "design_search.csv").read_text().splitlines()))
    assert [row["role"] for row in rows][:2] == ["case", "line search"] and rows[best]["best"] == "best"
    page = (tmp_path / "run" / "report.html").read_text()
    assert 'id="design-search"' in page and "What was not searched" in page
    assert "nothing to compute" in brakechain(*command).stdout
    (tmp_path / "better.yaml").write_text("based_on: soft.yaml\ndesign_search: {space: {}}\n"
                                          + (tmp_path / "run" / "best_design.yaml").read_text())
    better = case.load(tmp_path / "better.yaml", CHAINS, load).sections["structure"]
    assert better.joints.finger_stiffness == pytest.approx(finger[best], rel=1e-5)

"""Least Bayesian information criterion: against its formula, and on a case that it gets right."""

import numpy as np
import pytest

from pipeline.blind_trial.baselines.bic_library import answer, criterion
from pipeline.blind_trial.baselines.regression import Equations, Term


def test_it_names_what_is_large(hidden):
    found = answer(hidden)
    assert [(e["name"], e["place"]) for e in found["effects"]] == [("cubic_stiffness", "link_0")]
    assert 0.5 < found["effects"][0]["posterior"] <= 1


@pytest.mark.exact
def test_the_criterion_is_schwarzs():
    term = Term("law", "place")
    found = Equations(np.array([1.0, 2, 3, 5]), np.ones((4, 1)), {term: np.array([0.0, 1, 2, 3])})
    assert criterion(found, ()) == pytest.approx(4 * np.log(8.75 / 4) + np.log(4))
    assert criterion(found, (term,)) == pytest.approx(4 * np.log(0.3 / 4) + 2 * np.log(4))

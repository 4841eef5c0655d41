"""Forces left of measured motions: their place by an exact share of what noise explains, their sign that of a cause."""

import numpy as np
import pytest

from pipeline.diagnosis.signals.balance_residual import DescribeBalance
from pipeline.inference.procedure import diagnose
from tests.diagnosis.small_rig import HIDDEN
from tests.diagnosis.test_force_balance import asked


@pytest.mark.exact
def test_the_force_is_that_of_the_hidden_spring_with_the_sign_of_a_cause():
    given = asked(HIDDEN)
    found = diagnose(given.problem, given.budget, given.candidates)
    described = given.describe(found, given.axes(found))
    assert isinstance(given.describe, DescribeBalance)
    for run in described.runs.values():
        slope = np.polynomial.polynomial.polyfit(run.displacement, run.force, 3)[3]
        assert slope < 0, "a hardening spring pushes back"
        assert run.std == pytest.approx(np.full(len(run.force), 0.2))

"""Forces left of measured motions: their place by an exact share of what noise explains, their sign that of a cause."""

import numpy as np
import pytest

from pipeline.diagnosis.signals.balance_residual import DescribeBalance
from tests.diagnosis.small_rig import HIDDEN
from tests.diagnosis.test_force_balance import asked


@pytest.mark.exact
def test_the_force_is_that_of_the_hidden_spring_with_the_sign_of_a_cause():
    given = asked(HIDDEN)
    found = given.solved()
    described = given.latent.described(found, given.locator.located(found))
    assert isinstance(given.latent, DescribeBalance)
    for run in described.runs.values():
        slope = np.polynomial.polynomial.polyfit(run.displacement, run.force, 3)[3]
        assert slope < 0, "a hardening spring pushes back"
        assert run.std == pytest.approx(np.full(len(run.force), 0.2))

"""What the step of a bench resolves."""

import numpy as np
import pytest

from pipeline.effects.resolved import felt_mass, resolved_stiffness, resolving_step
from tests.effects.benches import sprung

ROW = np.array([1.0])


@pytest.mark.exact
def test_step_and_stiffness_belong_together():
    """Eight steps in a period of the mass on the spring: (w h)^2 = .6."""
    bench = sprung(mass=2.0, step=1e-3)
    stiffness = resolved_stiffness(bench, ROW)
    assert felt_mass(bench, ROW) == pytest.approx(2.0)
    assert 2 * np.pi / np.sqrt(stiffness / 2.0) / 1e-3 == pytest.approx(8, rel=0.02)
    assert resolving_step(2.0, stiffness) == pytest.approx(1e-3)

"""A hidden mass on a spring at a point."""

import numpy as np
import pytest

from pipeline.effects import named
from tests.effects.benches import sprung, swung


@pytest.mark.exact
@pytest.mark.parametrize("w", [12.0, 19.0, 24.0])
def test_swings_as_two_masses_do(w):
    """k + i c w - m w^2 - m_a w^2 k_a / (k_a - m_a w^2), the absorber's spring with its damper complex."""
    frequency, ratio, mass = 20 / (2 * np.pi), 0.08, 0.2
    bench = named("tuned_absorber").on(sprung(damping=4.0), "sensor_0",
                                       {"mass": mass, "frequency": frequency, "damping_ratio": ratio})
    spring = mass * (20.0**2 + 2j * ratio * 20.0 * w)
    gain = 1 / (400 + 4j * w - w**2 - mass * w**2 * spring / (spring - mass * w**2))
    run, late, x = swung(bench, w, 16.0)
    np.testing.assert_allclose(x[late], np.real(gain * np.exp(1j * w * run.time[late])), atol=2e-4 * abs(gain))

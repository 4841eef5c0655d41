"""A mode of a body that the model takes as rigid."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.effects import named
from tests.effects.benches import rubbing, sprung, swung


@pytest.mark.exact
@pytest.mark.parametrize("w", [12.0, 22.0])
def test_swings_as_the_sum_of_the_modes_of_the_free_body_on_its_joint(w):
    """1 / H = 1 / (1 / (-m w^2) + phi^2 / (W^2 - w^2 + 2 i z W w)) + k + i c w."""
    share, own, ratio = 0.5, 40.0, 0.03
    bench = named("second_mode").on(sprung(mass=2.0, damping=4.0), "sensor_0",
                                    {"share": share, "frequency": own / (2 * np.pi), "damping_ratio": ratio})
    free = -1 / (2.0 * w**2) + share / 2.0 / (own**2 - w**2 + 2j * ratio * own * w)
    gain = 1 / (1 / free + 400 + 4j * w)
    run, late, x = swung(bench, w, 20.0)
    np.testing.assert_allclose(x[late], np.real(gain * np.exp(1j * w * run.time[late])), atol=2e-4 * abs(gain))


def test_what_moves_otherwise_takes_no_part():
    changed = named("second_mode").on(rubbing(), "sensor_0", {"share": 0.5, "frequency": 9.0, "damping_ratio": 0.1})
    np.testing.assert_allclose(changed.model.sensor_rows[:, -1], [np.sqrt(0.5), 0, 0])
    np.testing.assert_allclose(changed.model.joints.rows[:, -1], [np.sqrt(0.5), 0, 0])
    np.testing.assert_allclose(changed.model.contacts.tangent[:, -1], np.sqrt(0.5))


def test_a_damper_and_a_mode_below_the_joints_are_no_mode_of_a_body():
    """What is damped beyond that acts as a damper to the ground: another effect."""
    found = {p.name: p for p in named("second_mode").parameters(SimpleNamespace(period=0.5))}
    assert 0.2 < found["damping_ratio"].within[1] < 0.5
    assert found["frequency"].within[0] == pytest.approx(1 / np.pi) and found["frequency"].nominal > 1 / np.pi

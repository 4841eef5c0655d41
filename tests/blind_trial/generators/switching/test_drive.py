"""Excitations: sizes, rates of change and impulses in closed form; steps change at samples."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import drive
from pipeline.blind_trial.generators.switching.rig import LAYOUTS, Rig

ROW = np.array([1.0])


@pytest.mark.exact
@pytest.mark.parametrize("way", ["multisine", "sweep"])
def test_shakers_fade_in_and_out_and_tell_their_rate_of_change(way):
    signal, change, breaks = drive.course(np.random.default_rng(1), way, 5.0, 20.0, 4.0, 400.0)
    time = np.linspace(0, 4, 160_001)
    values = signal(time)
    assert breaks == () and values[0] == 0 and abs(values[-1]) < 1e-12
    np.testing.assert_allclose(change(time)[1:-1], (values[2:] - values[:-2]) / (2 * time[1]), atol=2e-3)
    assert 0.6 < np.sqrt(np.mean(values**2)) < 1.2
    push = drive.shaker(ROW, 3.0, (signal, change, breaks)).pushing(np.linspace(0, 4, 12_801))
    at = np.array([0.1234, 1.77, 3.9])
    np.testing.assert_allclose([push(t)[0] for t in at], 3 * signal(at), atol=2e-5)


def test_steps_hold_from_sample_to_sample():
    signal, change, breaks = drive.course(np.random.default_rng(2), "steps", 5.0, 20.0, 2.0, 400.0)
    assert change is None and len(breaks) > 10
    np.testing.assert_allclose(np.array(breaks) * 400, np.rint(np.array(breaks) * 400), atol=1e-6)
    samples = np.arange(801) / 400
    np.testing.assert_array_equal(signal(samples), signal(samples + 0.9 / 400))
    push = drive.shaker(ROW, 2.0, (signal, change, breaks)).pushing(samples)
    assert push(0.3)[0] == 2 * signal(0.3)


@pytest.mark.exact
def test_a_blow_has_its_impulse_and_a_wall_pushes_by_spring_and_damper():
    time = np.linspace(0, 1, 200_001)
    blow = drive.blow(ROW, 0.7, 0.31, 0.02)
    assert np.sum(blow.force(time)) * time[1] == pytest.approx(0.7, rel=1e-6) and blow.breaks == (0.31, 0.31 + 0.02)
    rig = Rig((1.0, 1.0), LAYOUTS["row"], (100.0, 50.0), (2.0, 1.0))
    wall = drive.wall(rig, 0, 0.01, (np.sin, np.cos, ()))
    assert wall.force(0.4) == pytest.approx(np.sin(0.4) + 0.02 * np.cos(0.4))
    stiffer = wall.scaled(3.0).of(rig.with_values({"stiffness.0": 200.0}))
    assert stiffer.force(0.4) == pytest.approx(3 * (2 * np.sin(0.4) + 0.02 * np.cos(0.4)))
    assert wall.shown(0.4) == pytest.approx(0.01 * np.sin(0.4)) and not drive.still(ROW).force(time).any()
    assert set(drive.WAYS) >= {"release", "blow"}

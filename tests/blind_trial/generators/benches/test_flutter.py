"""A shoe on a drum: its matrices, its steady sliding, its growth against its roots, and what it may use."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.benches import flutter, pin_bench
from tests.blind_trial.generators.imported import imported


def roots(bench):
    """Roots about steady sliding under Coulomb friction: f = (n + mu t) N, N = -k n q."""
    stiffness = np.diag(bench.mass * bench.squared) + bench.coupling + bench.contact * np.outer(
        bench.normal + bench.friction * bench.tangent, bench.normal)
    size = len(bench.mass)
    whole = np.block([[np.zeros((size, size)), np.eye(size)],
                      [-stiffness / bench.mass[:, None], -np.diag(bench.damping / bench.mass)]])
    return np.linalg.eigvals(whole)


def test_it_uses_nothing_of_what_solves_it():
    here = "pipeline.blind_trial.generators.benches"
    parts = {here, f"{here}.flutter", f"{here}.pin_bench", "pipeline.contract.errors"}
    assert imported(f"{here}.flutter") <= parts


@pytest.mark.exact
def test_its_springs_hold_as_they_are_drawn():
    """Lifted, the block pushed along its inclined spring alone stretches that and those to the wall."""
    bench, v = flutter.built(flutter.NOMINAL), flutter.NOMINAL
    stiffness = np.diag(bench.mass * bench.squared) + bench.coupling
    way = np.array([1.0, 1.0, -1.0]) / np.sqrt(2)
    energy = (v["along"] + v["onto"]) / 2 + v["inclined"] * 1.0
    assert way @ stiffness @ way == pytest.approx(energy)
    np.testing.assert_allclose(np.linalg.eigvalsh(stiffness) > 0, True)


@pytest.mark.exact
def test_small_motion_grows_with_its_root():
    """Over a whole number of turns, a free motion of the fluttering mode grows as exp(growth rate t)."""
    bench, _ = flutter.make(1)
    grows = max(roots(bench), key=lambda root: root.real)
    assert grows.real > 20
    velocity, _ = pin_bench._motion(bench, 15.0, 1.0, np.array([0.0, 1e-8]), 0.08)
    size = [np.abs(velocity[1, (time > a) & (time <= a + 0.01)]).max() for time in
            [pin_bench.STEP * np.arange(velocity.shape[1])] for a in (0.05, 0.07)]
    assert np.log(size[1] / size[0]) / 0.02 == pytest.approx(grows.real, rel=0.05)


@pytest.mark.parametrize("hidden", ["", "falling_friction", "moving_base", "contact_stiffness_law"])
def test_an_undisturbed_shoe_stays_where_it_slides(hidden):
    bench, _ = flutter.make(2, (hidden,) if hidden else ())
    velocity, _ = pin_bench._motion(bench, 15.0, 0.5, np.zeros(2), 0.002)
    assert abs(velocity).max() < 1e-8


def test_values_are_off_and_draws_repeat():
    _, told = flutter.make(7, ("runout",), ("sensor_gain",))
    exact = {name for name, factor in told.factors.items() if factor == 1}
    assert set(told.factors) == set(flutter.NOMINAL) and exact == {"pressing"}
    assert set(told.hidden) == {"runout", "sensor_gain"}
    assert flutter.make(7, ("runout",), ("sensor_gain",))[1] == told


def test_sensors_have_names_of_their_own(monkeypatch):
    monkeypatch.setattr(pin_bench, "DURATIONS", (0.004, 0.004))
    bench, _ = flutter.make(1)
    runs = flutter.record(bench, 1)
    assert set(runs["lifted_1"]["channels"]) == {"laser_tail", "laser_block", "accelerometer", "load_cell"}
    assert set(flutter.nominal()["bench"]["channels"]) == set(runs["lifted_1"]["channels"])

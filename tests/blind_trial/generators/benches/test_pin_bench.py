"""The practice bench: its beam against a closed form, its motion against known roots, and what it may use."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.benches import pin_bench
from pipeline.contract.errors import ConvergenceError
from pipeline.recordings.neutral import read_neutral, write_neutral
from tests.blind_trial.generators.imported import imported


def test_it_uses_nothing_of_this_project():
    """Neither itself nor anything that it imports: no effect, no diagnosis, no engine; but the form of its errors."""
    name = "pipeline.blind_trial.generators.benches.pin_bench"
    assert imported(name) == {name, "pipeline.contract.errors"}


@pytest.mark.exact
def test_its_beam_is_bernoullis():
    """f = (beta L)^2 / (2 pi L^2) sqrt(EI / rho A), modal mass rho A L / 4 with 1 at the tip (Rao, table 8.1)."""
    mass, frequency, slope, _ = pin_bench.beam_modes()
    wave = np.sqrt(70e9 * 1e-8 / 12 / (2700 * 1e-4)) / (2 * np.pi * 0.1515**2)
    np.testing.assert_allclose(frequency[:3], wave * np.array([1.875104, 4.694091, 7.854757]) ** 2, rtol=2e-5)
    np.testing.assert_allclose(mass, 2700 * 1e-4 * 0.1515 / 4, rtol=2e-4)
    np.testing.assert_allclose(slope[:2] * 0.1515, [1.3765, 4.7808], rtol=1e-3)


@pytest.mark.exact
def test_a_lifted_mode_rings_with_its_own_root():
    """With nothing touching, each coordinate is a damped oscillator: its velocity after a tap is known."""
    bench, _ = pin_bench.make(3)
    one = replace(bench, hit=bench.hit * (np.arange(len(bench.mass)) == 12))
    velocity, _ = pin_bench._motion(one, 0.0, 0.0, np.array([1e-4, 0.0]), 0.02)
    decay = bench.damping[12] / (2 * bench.mass[12])
    turn = np.sqrt(bench.squared[12] - decay**2)
    time = pin_bench.STEP * np.arange(velocity.shape[1])
    kick = 1e-4 * bench.hit[0, 12] / bench.mass[12] * bench.sensors[1, 12]
    shown = kick * np.exp(-decay * time) * (np.cos(turn * time) - decay / turn * np.sin(turn * time))
    np.testing.assert_allclose(velocity[1], shown, atol=1e-6 * abs(kick))


@pytest.mark.parametrize("hidden", ["contact_stiffness_law", "pressure_dependent_friction", "falling_friction",
                                    "moving_base", "runout", "contact_memory"])
def test_an_undisturbed_bench_stays_where_it_slides(hidden):
    """Steady sliding is an equilibrium of the march (runout turns on, slowly)."""
    bench, _ = pin_bench.make(5, (hidden,))
    velocity, _ = pin_bench._motion(bench, 15.0, 0.5, np.zeros(2), 0.002)
    assert abs(velocity).max() < (1e-4 if hidden == "runout" else 1e-8)


@pytest.mark.exact
@pytest.mark.parametrize(("gap", "open_"), [(0.9, False), (1.1, True)])
def test_a_turned_contact_does_not_pull(gap, open_):
    """The arm carries all of the load where the surface falls back by more than the arm alone would give way."""
    bench, _ = pin_bench.make(5)
    hidden = {name: pin_bench.hidden_values(bench, name) for name in pin_bench.HIDDEN}
    place = pin_bench._steady(bench, 15.0, 0.5, hidden, gap * 15.0 / bench.arm[-1])
    assert np.isclose(abs(bench.arm @ place), 15.0, rtol=1e-9) == open_


def test_a_steady_state_that_is_not_found_is_told(monkeypatch):
    monkeypatch.setattr(pin_bench, "_STEADY", 2)
    with pytest.raises(ConvergenceError, match="steady sliding within 2 iterations"):
        pin_bench.record(pin_bench.make(5)[0], 5)


def test_values_are_off_and_effects_hidden():
    _, truth = pin_bench.make(7, ("runout",), ("sensor_gain",))
    off = np.log(list(truth["factors"].values()))
    assert len(off) >= 18 and np.all(off != 0) and set(truth["hidden"]) == {"runout", "sensor_gain"}
    assert pin_bench.make(7, ("runout",), ("sensor_gain",))[1] == truth


def test_a_campaign_survives_the_neutral_file(tmp_path, monkeypatch):
    monkeypatch.setattr(pin_bench, "DURATIONS", (0.004, 0.004))
    bench, _ = pin_bench.make(1, ("runout",))
    campaign = pin_bench.record(bench, 1)
    write_neutral(tmp_path / "bench.h5", campaign)
    runs = read_neutral(tmp_path / "bench.h5")
    assert set(runs) == set(campaign) and str(runs["lifted_2"].repeat_of) == "lifted_1"
    assert runs["rest_8N_1"].conditions["press"].value[0] == 8.0
    shown = runs["lifted_1"].channels["accelerometer"]
    assert shown.unit == "m/s^2" and len(shown.samples) == pytest.approx(0.004 * pin_bench.RATE, abs=1)
    assert np.ptp(runs["turned_15N"].channels["load_cell"].samples) > 1.0, "runout under a stiff arm is a force"

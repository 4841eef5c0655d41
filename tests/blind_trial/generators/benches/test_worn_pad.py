"""The practice bench of worn pads: its contact and its laws against closed forms, and what it may use."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.benches import worn_pad
from pipeline.contract.errors import ConvergenceError
from pipeline.recordings.neutral import read_neutral, write_neutral
from tests.blind_trial.generators.imported import imported


def test_it_uses_nothing_of_the_diagnosis():
    """Neither itself nor anything that it imports: no effect, no diagnosis, no solver of the chain."""
    name = "pipeline.blind_trial.generators.benches.worn_pad"
    assert imported(name) == {name, "pipeline.contract.errors"}


def small(hidden="", **changes):
    bench, _ = worn_pad.make(4, hidden, nodes=48, cycles=20)
    return replace(bench, **changes)


@pytest.mark.exact
def test_a_wave_in_full_contact_is_westergaards():
    """p = P + p* cos(2 pi x / l), p* = pi E* h / l, where P > p* (Johnson, Contact Mechanics, 13.2)."""
    nodes, modulus = 64, 1e9
    wave = np.cos(2 * np.pi * np.arange(nodes) / nodes)[None].repeat(nodes, 0)
    swing = np.pi * modulus / (1 - worn_pad.POISSON**2) * 1e-7 / worn_pad.PATCH
    np.testing.assert_allclose(worn_pad.pressed(1e-7 * wave, 2 * swing, modulus), (2 + wave) * swing, rtol=1e-3)


@pytest.mark.exact
def test_nothing_pulls_and_the_load_is_carried():
    bench = small()
    found = worn_pad.pressed(bench.pad + bench.disc, 1e6, bench.values["modulus"])
    assert found.min() == 0 and found.mean() == pytest.approx(1e6, rel=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("hidden", ["", "transfer"])
def test_faces_lose_coefficient_times_pressure_times_way(hidden):
    bench = small(hidden)
    _, pad, disc = worn_pad.drag(bench, 2e6)
    lost = bench.values["pad_wear"] * 2e6 * worn_pad.WAYS[-1]
    share = bench.hidden.get("transfer", {"share": 0.0})["share"]
    assert np.mean(bench.pad - pad) == pytest.approx(lost, rel=1e-9)
    assert np.mean(bench.disc - disc) == pytest.approx(
        bench.values["disc_wear"] * 2e6 * worn_pad.WAYS[-1] - share * lost, rel=1e-9)


@pytest.mark.exact
def test_the_film_grows_over_the_way():
    """Its Euler steps against 1 + g p / p_0 (1 - exp(-s / d)), of the same drag without it: first order."""
    told = {"gain": 0.5, "distance": 2e-3, "pressure": 2e6}
    plain, _, _ = worn_pad.drag(small(cycles=100), 2.5e6)
    filmed, _, _ = worn_pad.drag(replace(small(cycles=100), hidden={"third_body": told}), 2.5e6)
    exact = 1 + 0.5 * 1.25 * (1 - np.exp(-np.array(worn_pad.WAYS) / 2e-3))
    np.testing.assert_allclose(filmed / plain, exact[:, None].repeat(3, 1), rtol=5e-3)


def test_values_are_off_and_draws_repeat():
    _, truth = worn_pad.make(7, "third_body")
    factors = np.array(list(truth["factors"].values()))
    assert len(factors) == 5 and np.all(factors != 1) and np.all(abs(np.log(factors)) <= 0.3)
    assert worn_pad.make(7, "third_body")[1] == truth and set(truth["hidden"]) == {"third_body"}


def test_a_campaign_survives_the_neutral_file(tmp_path, monkeypatch):
    monkeypatch.setattr(worn_pad, "PRESSURES", (1e6,))
    bench = small()
    campaign = worn_pad.record(bench, 4)
    write_neutral(tmp_path / "bench.h5", campaign)
    runs = read_neutral(tmp_path / "bench.h5")
    assert set(runs) == {"new", "drag_1MPa"}
    table = runs["drag_1MPa"].friction["load_cell"]
    assert len(table.friction) == 21 and np.all(table.pressure == 1e6) and np.all(table.friction_std == 0.005)
    seen = runs["new"].topography["pad_new"]
    assert (str(seen.body), str(seen.state)) == ("pad", "new") and seen.x[1] == pytest.approx(1e-3 / 48)
    assert np.std(seen.height - bench.pad) < 2e-6, "but for tilt, offset and noise"


def test_a_contact_that_does_not_converge_is_refused(monkeypatch):
    monkeypatch.setattr(worn_pad, "_MOST", 2)
    bench = small()
    with pytest.raises(ConvergenceError, match="practice bench"):
        worn_pad.pressed(bench.pad + bench.disc, 1e6, bench.values["modulus"])

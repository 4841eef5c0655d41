"""Recorded runs in the form of a bench, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.runs import check_units, joined, recorded
from pipeline.contract import ConfigError
from tests.diagnosis import pin_rig
from tests.diagnosis.small_rig import RATE, SAMPLES, force, laid_out, recording


def test_inputs_samples_and_conditions_arrive():
    one = recorded(recording(), laid_out())["level_2"]
    assert one.run.samples == SAMPLES and one.run.sample_rate == RATE and one.channels == ("x",)
    np.testing.assert_allclose(one.run.inputs["shaker"], force(5.0, 1))
    assert one.run.conditions == {"level": 5.0} and one.valid.all()


def test_missing_samples_are_masked():
    found = recording()
    run = found.runs["level_1"]
    gap = replace(run.channels["x"], missing=np.array([[3, 5]]))
    runs = {"level_1": replace(run, channels={**run.channels, "x": gap})}
    one = recorded(replace(found, runs=runs), laid_out())["level_1"]
    assert np.flatnonzero(~one.valid[0]).tolist() == [3, 4]


@pytest.mark.parametrize("more, said", [
    ({"channels": {"y": {"quantity": "displacement", "source": "block"}}}, "bench.channels"),
    ({"inputs": {"shaker": {"channel": "forc"}}}, "bench.inputs.shaker.channel")])
def test_channels_that_were_not_recorded_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        recorded(recording(), laid_out(**more))


def test_units_must_fit_what_a_channel_shows():
    settings = laid_out(channels={"x": {"quantity": "velocity", "source": "block"}})
    with pytest.raises(ConfigError, match="m/s"):
        check_units(recorded(recording(), settings), settings)


def test_the_begin_of_a_run_may_be_left_out():
    one = recorded(recording(), laid_out(settle="0.1 s"))["level_1"]
    assert np.flatnonzero(~one.valid[0]).tolist() == list(range(int(0.1 * RATE)))


def test_held_inputs_keep_their_samples_and_a_held_drive_is_refused():
    run = recorded(recording(), laid_out(inputs={"shaker": {"channel": "force", "hold": "step"}}))["level_2"].run
    assert run.held == ("shaker",)
    np.testing.assert_array_equal(run.inputs["shaker"], force(5.0, 1))
    with pytest.raises(ConfigError, match="bench.drive.hold"):
        recorded(recording(), laid_out(drive={"channel": "force", "hold": "step"}))


@pytest.mark.exact
def test_straight_lines_lose_nothing_of_a_tone_within_the_band():
    place = np.arange(200)
    drawn = np.interp(np.arange(0, 199, 0.05), place, joined(np.sin(0.6 * np.pi * place), "band_limited"))
    tone = np.exp(-0.6j * np.pi * np.arange(0, 199, 0.05))
    size = 2 * abs(np.mean((drawn * tone)[: 20 * 190]))
    assert size == pytest.approx(1.0, abs=2e-3)


def test_a_recorded_position_drives_by_its_rate_of_change():
    found = pin_rig.recording((5.0,), (4e-4,))
    run = found.runs["run_1"]
    moved = run.channels["position"]
    lost = replace(moved, missing=np.array([[60, 61]]), samples=np.where(np.arange(pin_rig.SAMPLES) == 60, 0.0,
                                                                         moved.samples))
    gappy = replace(found, runs={"run_1": replace(run, channels={**run.channels, "position": lost})})
    time = np.arange(pin_rig.SAMPLES) / pin_rig.RATE
    whole, patched = (recorded(r, pin_rig.laid_out())["run_1"].run.drive for r in (found, gappy))
    speed = 4e-4 * np.pi * pin_rig.FREQUENCY * np.cos(2 * np.pi * pin_rig.FREQUENCY * time)
    np.testing.assert_allclose(whole[1:-1], speed[1:-1], atol=2e-3 * speed.max())
    np.testing.assert_allclose(patched[1:-1], speed[1:-1], atol=0.03 * speed.max())

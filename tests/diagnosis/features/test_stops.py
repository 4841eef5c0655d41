"""Stops that squeal as features of a bench: the pole that grows, its spread over stops, and stops that tell none."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.runs import Recorded
from pipeline.case_models.virtual_rig import Onset
from pipeline.contract import ConfigError
from pipeline.diagnosis.features.poles import features, observed, predicted
from pipeline.diagnosis.features.stops import channels_of, squeals, stops_of
from pipeline.physics.signals.onsets.growth_rate import Growth
from pipeline.physics.virtual_rig.modes import modes, motions
from pipeline.physics.virtual_rig.response import Run
from pipeline.physics.virtual_rig.sensor import ACCELERATION
from tests.diagnosis.small_bench import bench, laid_out

RATE, SECONDS, LOADS = 4096.0, 3.2, {"soft": 5.0, "hard": 10.0}
SAMPLES = round(SECONDS * RATE) + 1
FALLING = {"falling_friction": {"contact": {"rise": 6.0, "decay_speed": "0.1 m/s"}}}
BAND = laid_out().poles.model_copy(update={"onset": Onset(), "resolution": 1e-4})


def squealing(whole, load, seed, channels=("laser", "accelerometer"), seconds=SECONDS, off=0.0):
    """Recorded stop of a bench: its pole grows from 0.4 s on and saturates, as Stuart and Landau have it, in noise."""
    random = np.random.default_rng(seed)
    run = Run(f"stop_{load}_{seed}", seconds, RATE, conditions={"press": LOADS[load], "speed": 0.5})
    root, shape = modes(whole, run)
    k = int(np.argmax(root.real))
    grows, shape = root[k] + off * (seed - 1), shape[k] / abs(shape[k]).max()
    time = np.arange(round(seconds * RATE) + 1) / RATE
    since = np.maximum(time - 0.4, 0.0)
    size = 2e-5 * np.exp(np.minimum(grows.real * since, 100.0)) * (time >= 0.4)
    wave = size / np.sqrt(1 + size**2) * np.exp(1j * grows.imag * since)
    samples = []
    for j, channel in enumerate(motions(whole)):
        power = grows if channel.measurand == ACCELERATION else 1.0
        samples.append((power * shape[j] * wave).real + 3e-5 * abs(power) * random.standard_normal(len(time)))
    samples = np.array([row for row, c in zip(samples, motions(whole), strict=True) if c.name in channels])
    unit = {"laser": "m/s", "accelerometer": "m/s^2"}
    return Recorded(run, channels, tuple(unit[c] for c in channels), samples, np.ones(samples.shape, bool), "")


def stops(whole, count=3, **more):
    """{run: Recorded} of ``count`` stops at each load, the first of which the others repeat."""
    records = {}
    for load in LOADS:
        for seed in range(count):
            record = squealing(whole, load, seed, **more)
            records[record.run.name] = replace(record, repeat_of=f"stop_{load}_0" if seed else "")
    return records


@pytest.fixture(scope="module")
def whole():
    return bench(FALLING)


def test_the_bench_that_squeals_shows_the_growth_that_was_recorded(whole):
    result = features(whole, stops(whole), BAND)
    observations, units = observed(result)
    assert set(result) == {"stop_soft_0", "stop_hard_0"} and set(units.values()) == {"Hz", "rad/s"}
    for run in observations:
        left = (run.samples - predicted(whole, result[run.name], run.channels))[:, 0] / run.noise_std
        assert max(abs(left)) < 3.5 and run.samples.shape == (2, 1)
        assert result[run.name].values["pole 1 growth rate"] > 0
        assert result[run.name].std["pole 1 growth rate"] < 0.05 * result[run.name].values["pole 1 growth rate"]


def test_the_direction_is_that_of_the_mode_in_velocities(whole):
    seen = features(whole, stops(whole, 1), BAND)["stop_hard_0"].seen
    root, shape = modes(whole, Run("", 0.1, RATE, conditions={"press": 10.0, "speed": 0.5}))
    true = shape[np.argmax(root.real)]
    assert seen.shape[0, 1] / seen.shape[0, 0] == pytest.approx(true[1] / true[0], rel=0.01)


def test_the_spread_over_stops_widens_the_error(whole):
    alike, spread = (stops_of(whole, stops(whole, off=off), BAND)["stop_hard_0"].seen.std[0] for off in (0.0, 1.5))
    assert alike < 0.05 and spread == pytest.approx(1.5 / np.sqrt(3), rel=0.1)


def test_channels_that_a_stop_lacks_are_left_out_of_its_shape(whole):
    records = stops(whole, 1, channels=("accelerometer",))
    result = features(whole, records, BAND)["stop_hard_0"]
    assert result.channels == (1,) and result.seen.shape.shape == (1, 1)
    assert predicted(whole, result, ("pole 1 growth rate",)).item() > 0
    assert channels_of(whole, records["stop_hard_0"]) == (1,)


def test_what_squeals_is_told_from_the_record_or_named(whole):
    stop = squealing(whole, "hard", 0)
    tap = replace(stop, samples=stop.samples[:, ::-1])
    assert squeals(whole, stop, Onset()) and not squeals(whole, tap, Onset()) and not squeals(whole, stop, None)
    assert squeals(whole, tap, Onset(runs=("stop_*",))) and not squeals(whole, stop, Onset(runs=("brake_*",)))
    resting = replace(stop, run=replace(stop.run, conditions={"press": 10.0, "speed": 0.0}))
    assert not squeals(whole, resting, Onset())


def test_a_stop_that_tells_no_growth_says_why_and_does_not_count(whole):
    records = stops(whole, 2)
    quiet = records["stop_hard_1"]
    records["stop_hard_1"] = replace(quiet, samples=3e-5 * np.random.default_rng(0).standard_normal((2, SAMPLES)))
    stop = stops_of(whole, records, BAND)["stop_hard_0"]
    assert isinstance(stop.stops["stop_hard_0"], Growth) and len(stop.seen.root) == 1
    assert "outgrows the noise floor" in stop.stops["stop_hard_1"]
    lost = replace(quiet, valid=np.arange(SAMPLES) != 100 * np.ones((2, 1)))
    assert stops_of(whole, {**records, "stop_hard_1": lost}, BAND)["stop_hard_0"].stops["stop_hard_1"] == \
        "1 lost samples"


def test_stops_of_which_none_tells_a_growth_have_no_pole(whole):
    record = squealing(whole, "hard", 0)
    record = replace(record, samples=record.samples[:, :1200])
    band = BAND.model_copy(update={"onset": Onset(runs=("stop_*",))})
    result = features(whole, {record.run.name: record}, band)
    assert not len(result["stop_hard_0"].seen.root) and result["stop_hard_0"].values == {}


def test_a_pressure_that_changes_while_it_grows_is_told(whole):
    record = squealing(whole, "hard", 0)
    ramp = 1e5 * (1 + 0.5 * np.linspace(0, 1, record.samples.shape[1]))
    held = replace(record, channels=(*record.channels, "pressure"), unit=(*record.unit, "Pa"),
                   samples=np.vstack((record.samples, ramp)), valid=np.ones((3, len(ramp)), bool))
    for most, expected in ((0.5, ""), (0.01, "pressure changes by")):
        band = BAND.model_copy(update={"onset": Onset(held={"pressure": most})})
        told, = stops_of(whole, {"stop_hard_0": held}, band)["stop_hard_0"].stops.values()
        assert told.startswith(expected) if expected else isinstance(told, Growth)
    band = BAND.model_copy(update={"onset": Onset(held={"speed": 0.1})})
    with pytest.raises(ConfigError, match="declare the channel"):
        stops_of(whole, {"stop_hard_0": held}, band)


def test_the_section_is_read():
    assert laid_out(poles={"onset": {"runs": ["stop_*"], "held": {"pressure": 0.02}}}).poles.onset.share == 0.2

"""Features of self-excited benches: what two records show, and what the model says of it."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.features.pairing import assigned, nearer
from pipeline.diagnosis.features.poles import _heard, _unbroken, features, observed, predicted
from pipeline.physics.signals.pole_identification import Poles
from pipeline.physics.virtual_rig.modes import modes
from tests.diagnosis.small_bench import bench, laid_out, recorded, run

BAND = laid_out().poles


@pytest.fixture(scope="module")
def told():
    """(bench, its features, the observed runs, units)."""
    whole = bench({"runout": {"contact": {"amplitude": "3 um", "order": 1, "phase": "0.7 rad"}}})
    found = features(whole, recorded(whole), BAND)
    return whole, found, *observed(found, ("fast",))


def test_the_true_bench_shows_what_was_recorded(told):
    whole, found, runs, _ = told
    left = [((one.samples - predicted(whole, found[one.name], one.channels))[:, 0] / one.noise_std)[one.valid[:, 0]]
            for one in runs]
    assert max(abs(np.concatenate(left))) < 4 and len(found["slow_10"].seen.root) == 2


def test_runs_share_their_channels_and_lack_some(told):
    _, _, runs, units = told
    assert {one.name for one in runs if one.held_out} == {"fast"} and len({one.channels for one in runs}) == 1
    assert units["pole 1 frequency"] == "Hz" and units["order 1 cosine of cell"] == "N"
    turned = next(one for one in runs if one.name == "turned")
    assert [c for c, v in zip(turned.channels, turned.valid[:, 0], strict=True) if v] == [
        f"order {n} {wave} of cell" for n in (1, 2, 3) for wave in ("cosine", "sine")]


def test_ratios_of_sensors_tell_gain_and_delay():
    whole = bench()
    late = whole.with_channels(lambda c: replace(c, gain=1.3, delay=1e-4) if c.name == "accelerometer" else c)
    found = features(whole, recorded(late), BAND)["rest"]
    assert found.values["gain of accelerometer over laser"] == pytest.approx(np.log(1.3), abs=0.01)
    assert found.values["delay of accelerometer behind laser"] == pytest.approx(1e-4, abs=3e-6)


def test_poles_that_two_sensors_do_not_hear_say_nothing_of_their_ratio():
    """Eight modes of another part against one of theirs: what they show of the eight is noise."""
    random = np.random.default_rng(1)
    noise = 1e-4 * (random.standard_normal((8, 2)) + 1j * random.standard_normal((8, 2)))
    shape = np.vstack((noise, [[1.0, 1.3]]))
    assert list(_heard(shape)) == [8]
    assert list(_heard(np.array([[1.0, 0.0], [0.0, 1.0]]))) == [0, 1], "all, where no pole moves both"


def test_every_peak_is_explained_by_a_root_of_its_own(told):
    whole, found, _, _ = told
    root, shape = modes(whole, run("slow_10"))
    assert list(assigned(found["slow_10"].seen, root, shape)) == [0, 1]


def test_a_peak_beyond_the_modes_of_the_model_falls_to_the_likeliest_and_is_missed_by_far(told):
    whole, found, _, _ = told
    root, shape = modes(whole, run("slow_10"))
    extra = Poles(*(np.insert(own, 1, added, axis=0) for own, added in zip(
        (found["slow_10"].seen.root, found["slow_10"].seen.std, found["slow_10"].seen.shape),
        (1.05 * root[0], found["slow_10"].seen.std[0], shape[0]), strict=True)))
    assert list(assigned(extra, root, shape)) == [0, 0, 1]
    assert abs(nearer(extra.root, root[[0, 0, 1]]) - extra.root)[1] > 0.04 * abs(root[0])


def test_a_record_without_a_sure_pole_says_nothing(monkeypatch):
    whole = bench()
    given = {name: one for name, one in recorded(whole).items() if "rest" in (name, one.repeat_of)}
    nothing = Poles(np.zeros(0, complex), np.zeros(0), np.zeros((0, 2), complex))
    monkeypatch.setattr("pipeline.diagnosis.features.poles.confirmed", lambda *_: nothing)
    found = features(whole, given, BAND)
    assert found["rest"].values == {} and predicted(whole, found["rest"], ("pole 1 frequency",)) == 0.0
    with pytest.raises(ConfigError, match="none of rest"):
        observed(found)
    turned = features(whole, {"turned": recorded(whole)["turned"]}, BAND)
    assert [one.name for one in observed({**found, **turned})[0]] == ["turned"]


def test_records_that_cannot_be_used_are_refused():
    whole = bench()
    given = recorded(whole)
    with pytest.raises(ConfigError, match="a repeat"):
        features(whole, {"rest": given["rest"]}, BAND)
    run = given["rest"].run
    ramp = replace(given["rest"], run=replace(run, drive=np.linspace(1.0, 1.2, run.samples)))
    with pytest.raises(ConfigError, match="a speed constant within 5%, .*found 1 to 1.2 rad/s"):
        features(whole, {**given, "rest": ramp}, BAND)
    short = replace(given["turned"], run=replace(given["turned"].run, conditions={"press": 10.0, "speed": 0.1}))
    with pytest.raises(ConfigError, match="a whole turn"):
        features(whole, {"turned": short}, BAND)


def test_a_record_is_read_from_where_all_channels_begin_and_not_across_a_gap():
    whole = bench()
    one = recorded(whole)["rest"]
    valid = one.valid.copy()
    valid[0, :3] = False
    assert _unbroken(replace(one, valid=valid)).shape == (len(one.channels), one.samples.shape[1] - 3)
    valid[1, 50:54] = False
    with pytest.raises(ConfigError, match="samples without a gap, of which poles can be read, found 4 lost ones"):
        features(whole, {**recorded(whole), "rest": replace(one, valid=valid)}, BAND)

"""Signals of the convention SEP 005, there and back."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.neutral import read_neutral
from pipeline.recordings.sep005 import run_of, save, signals_of

SIGNALS = [{"name": "pad", "data": np.array([1.0, -2.0, 3.0]), "unit_str": "g", "fs": 51200.0},
           {"name": "line", "data": [1, 2, 3], "unit_str": "bar", "time": [0.5, 0.6, 0.7], "quantity": "pressure"},
           {"name": "mu", "data": [0.4, 0.5], "unit_str": "", "fs": 10}]


def test_signals_become_channels_and_signals_again():
    run = run_of(SIGNALS)
    pad, line, mu = run.channels.values()
    assert (str(pad.unit), str(pad.measures), float(pad.rate)) == ("m/s^2", "acceleration", 51200.0)
    assert line.samples.tolist() == [1e5, 2e5, 3e5] and float(line.begin) == 0.5
    assert float(line.rate) == pytest.approx(10) and str(mu.unit) == "1" and str(mu.measures) == "value"
    again = run_of(signals_of(run)).channels
    for name, one in run.channels.items():
        np.testing.assert_allclose(again[name].samples, one.samples)
        assert [str(getattr(again[name], f)) for f in ("unit", "measures")] == [str(one.unit), str(one.measures)]
        assert float(again[name].begin) == pytest.approx(float(one.begin))


def test_compulsory_keys_are_there():
    """data, name, unit_str and fs or time, none of the prohibited 'timestamp' (SEP 005)."""
    for signal in signals_of(run_of(SIGNALS)):
        assert {"data", "name", "unit_str", "fs"} <= set(signal) and "timestamp" not in signal
        assert np.ndim(signal["data"]) == 1


def test_saved_signals_are_a_recording(tmp_path):
    save(SIGNALS, tmp_path / "stop.h5", "stop", "from a reader of the convention")
    run = read_neutral(tmp_path / "stop.h5")["stop"]
    assert str(run.description) == "from a reader of the convention" and list(run.channels) == ["line", "mu", "pad"]
    np.testing.assert_allclose(run.channels["pad"].samples, 9.80665 * np.array([1, -2, 3]), rtol=1e-6)


@pytest.mark.parametrize("change, told", [
    ({"unit_str": None, "drop": "unit_str"}, "pad: expected data, name, unit_str, and fs or time, found no unit_str"),
    ({"drop": "fs"}, "found no fs or time"), ({"name": "line"}, "line: expected each name once"),
    ({"time": [0.0, 1.0, 5.0]}, "times at one even interval"), ({"unit_str": "nounit"}, "a unit such as")])
def test_what_the_convention_does_not_allow_is_refused(change, told):
    first = {key: value for key, value in (SIGNALS[0] | change).items() if key not in ("drop", change.get("drop"))}
    with pytest.raises(ConfigError, match=told):
        run_of([first, SIGNALS[1]])


def test_no_signals_are_refused():
    with pytest.raises(ConfigError, match="at least one signal"):
        run_of([])


def test_gaps_and_begin_are_kept(tmp_path):
    gapped = {"name": "a", "data": np.array([1.0, np.nan, 3.0]), "unit_str": "N", "time": [1.5, 1.6, 1.7]}
    save([gapped], tmp_path / "a.h5")
    (one,) = read_neutral(tmp_path / "a.h5")["run"].channels.values()
    assert one.missing.tolist() == [[1, 2]] and float(one.begin) == 1.5


@pytest.mark.parametrize("change, message", [
    ({"data": "text"}, "pad: data: expected numbers, found"), ({"data": None}, "found no data"),
    ({"data": [[1.0]]}, r"data: expected numbers \(sample,\), found 2"), ({"fs": "fast"}, "fs: expected numbers"),
    ({"fs": [1.0]}, "fs: expected one number"), ({"unit_str": 3}, "unit_str: expected a text, found int"),
    ({"quantity": {}}, "quantity: expected a text, found dict"), ({"name": ["a"]}, "name: expected a text"),
    ({"name": "../a"}, "expected a name of letters"), ({"time": [{}, 1]}, "time: expected numbers")])
def test_signals_of_other_types_are_refused(change, message):
    with pytest.raises(ConfigError, match=message):
        run_of([SIGNALS[0] | change])


@pytest.mark.parametrize("signals", [{"name": "a"}, ["a"], 3, None])
def test_what_is_no_list_of_signals_is_refused(signals):
    with pytest.raises(ConfigError, match="signals: expected a list of dictionaries"):
        run_of(signals)

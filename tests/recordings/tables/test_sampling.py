"""From times to even samples: units, rates of heads, what is said and what is asked."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tables.sampling import sampled, time_unit

SAMPLES = np.arange(400.0)
TIME = SAMPLES / 1e4
NO = ("", None, 0.0)


def read(time, name="t", head=NO, measures=(), **stated):
    """(rate, begin, number of samples, what was said)."""
    told = []
    file = SimpleNamespace(**{"time": name, "time_unit": None, "sample_rate": None, "resample": None, **stated})
    values, rate, begin = sampled({"x": SAMPLES}, time, file, head, "here: time", told.append, measures)
    return rate, begin, len(values["x"]), " ".join(told)


@pytest.mark.parametrize("name, factor, head, stated, told", [
    ("t [ms]", 1e3, NO, {}, ""), ("Zeit / ms", 1e3, NO, {}, ""), ("t_us", 1e6, NO, {}, ""),
    ("Zeit in ms", 1e3, NO, {}, ""), ("t", 1e3, ("msec", None, 0.0), {}, ""), ("t", 1 / 60, ("min", None, 0.0), {}, ""),
    ("t", 1e3, NO, {"time_unit": "ms"}, ""), ("t", 1e3, ("", 1e4, 0.0), {}, ""),
    ("Time (Sekunden)", 1, NO, {}, ""), ("t", 1, NO, {}, "t states no unit: read in s, which gives 10000 Hz")])
def test_units_of_times(name, factor, head, stated, told):
    rate, begin, count, said = read(factor * TIME, name, head, **stated)
    assert rate == pytest.approx(1e4) and begin == 0 and count == 400 and told in said and bool(said) == bool(told)


def test_a_unit_of_times_that_is_none_is_asked_for():
    with pytest.raises(ConfigError, match=r"here: time_unit: .* found 'rel' at t \[rel\]; state it: time_unit: s"):
        read(TIME, "t [rel]")
    for name in ("data(:,1)", "X_Value (2)", "s(3).t"):
        assert time_unit(name, None, NO, TIME, "here") == ("s", True)
    assert time_unit("t [rel]", "ms", NO, TIME, "here") == ("ms", False)


def test_vibrations_slower_than_anyone_records_them_ask_for_the_unit():
    with pytest.raises(ConfigError, match="10 Hz in s, 10000 Hz in ms, 1e[+]07 Hz in us, for acceleration; state it"):
        read(1e3 * TIME, measures=["pressure", "acceleration"])
    assert read(1e3 * TIME, measures=["pressure"])[0] == pytest.approx(10)
    assert read(1e3 * TIME, measures=["acceleration"], time_unit="s")[0] == pytest.approx(10)


def test_rounded_times_are_told_and_a_stated_rate_or_one_of_the_head_goes_before():
    time = np.round(SAMPLES / 51200, 6)
    rate, _, count, said = read(time, "t [s]")
    assert rate == 51200 and count == 400 and "rounded to 1e-06 s: read as an even grid of 51200 Hz" in said
    coarse = np.round(SAMPLES / 51200, 4)
    assert read(coarse, "t [s]", ("", 51200.0, 0.0))[0] == 51200
    assert read(coarse, "t [s]", sample_rate=51200.0)[:3] == (51200.0, 0.0, 400)
    with pytest.raises(ConfigError, match="expected rising times on a grid of 40000 Hz"):
        read(coarse, "t [s]", sample_rate=40000.0)


def test_lost_samples_stay_gaps_where_times_are_rounded_to_less_than_an_interval():
    lost = np.delete(np.round(np.arange(403) / 51200, 5), [100, 200, 201])
    rate, _, count, _ = read(lost, "t [s]", sample_rate=51200.0)
    assert rate == 51200 and count == 403


def test_without_times_the_head_tells_rate_and_begin():
    assert read(None, None, ("", 2e4, 0.5))[:3] == (2e4, 0.5, 400)
    assert read(None, None, ("", 2e4, 0.5), sample_rate=1e4)[:2] == (1e4, 0.0)


def test_rows_behind_the_end_of_all_columns_are_left_out():
    time = np.append(TIME[:-2], [np.nan, np.nan])
    with pytest.raises(ConfigError, match="at least two finite times"):
        read(time, "t [s]")
    values = {"x": np.where(np.isnan(time), np.nan, SAMPLES)}
    file = SimpleNamespace(time="t [s]", time_unit=None, sample_rate=None, resample=None)
    found, rate, _ = sampled(values, time, file, NO, "here", lambda text: None)
    assert len(found["x"]) == 398 and rate == pytest.approx(1e4)

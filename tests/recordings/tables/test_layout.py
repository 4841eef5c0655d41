"""Where a text table has its names, units and numbers."""

from pathlib import Path

import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tables.layout import Form, layout, rate_of, spelt, unlike


def seen(text, **stated):
    return layout(text.split("\n"), Path("a.csv"), Form(**stated), "utf-8")


def test_the_head_of_a_table_of_dewesoft():
    """Events above the table look like rows, but not like those below."""
    head = seen("File name:\ta.dxd\nSample rate:\t10000\n\nEvents\nType\tEvent\tTime\n1\tstarted\t0.0\n\nData1\n"
                "Time (s)\ta (m/s2)\tp (bar)\n0.0\t1.5\t2\n0.1\t1.6\t3\n0.2\t1.7\t3\n0.3\t1.7\t3\n0.4\t1.7\t3\n")
    assert head.names == ["Time (s)", "a (m/s2)", "p (bar)"] and head.first == 9 and head.rate == 10000
    assert "names in line 9" in head.shown and "numbers from line 10" in head.shown


def test_names_and_units_of_a_scope_stand_beside_labels():
    head = seen('"Model","DL850"\n"TraceName","CH1","CH2"\n"VUnit","V","A"\n"SampleRate",1.0E+04,1.0E+04\n\n'
                ',1.5,2.5\n,1.6,2.6\n,1.7,2.7\n,1.8,2.8\n,1.9,2.9\n,2.0,3.0\n')
    assert head.names == ["CH1", "CH2"] and head.units == {"CH1": "V", "CH2": "A"} and head.rate == 1e4
    assert head.positions == [1, 2]


@pytest.mark.parametrize("text, stated, told", [
    ("a,b\n1\n", {}, "a.csv:2: expected 2 values, as many as names in line 1, found 1; else state delimiter"),
    ("Bench\nno numbers\n", {}, "line 1: 'Bench'; line 2: 'no numbers'; state delimiter, decimal"),
    ("t;x\n1;2\n3;4", {"delimiter": "::"}, "a text table whose columns '::' separates"),
    ("t;x\n1;2\n3;4", {"units_row": True}, "a row of names above the row of units"),
    ("t;x", {}, "a header and")])
def test_what_is_not_clear_is_shown(text, stated, told):
    with pytest.raises(ConfigError, match=told):
        seen(text, **stated)


def test_units_that_are_written_out_and_names_that_repeat():
    assert [spelt(unit) for unit in ("Sekunden", "msec", "Volts", "ms")] == ["s", "msec", "V", "ms"]
    assert unlike(["t", "a", "a"]) == ["t", "a (1)", "a (2)"]


@pytest.mark.parametrize("key, values, rate", [
    ("sampling frequency", ["51.2 kHz"], 51200), ("sample rate [khz]", ["2"], 2000), ("sample rate [kHz]", ["2"], 2000),
    ("delta_x", ["1.0E-4", "1.0E-4"], 1e4), ("delta_x", ["1.0E-4", "2.0E-4"], None), ("samplerate", ["5 kS/s"], 5000),
    ("operator", ["3"], None)])
def test_what_a_head_says_of_the_sampling(key, values, rate):
    assert rate_of([(key, values)], ".") == pytest.approx(rate)

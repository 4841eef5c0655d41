"""LabVIEW measurements in all their forms."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tables.text import text_table

FORCE = [0.5, 1.5, 2.5, 3.5]


def measurement(separator, decimal, columns, segments):
    """A file of segments [(X0, names, rows of numbers)] as the writer of LabVIEW makes it."""
    mark = {"Tab": "\t", "Comma": ","}[separator]
    lines = ["LabVIEW Measurement" + mark, f"Separator{mark}{separator}", f"Decimal_Separator{mark}{decimal}",
             f"X_Columns{mark}{columns}", f"***End_of_Header***{mark}", mark]
    for begin, names, rows in segments:
        channels = [n for n in names if n not in ("X_Value", "Comment")]
        lines += [mark.join(["Channels", str(len(channels))]), mark.join(["Y_Unit_Label", *["N"] * len(channels)]),
                  mark.join(["X_Dimension", *["Time"] * len(channels)]),
                  mark.join(["X0", *[f"{begin:E}".replace(".", decimal)] * len(channels)]),
                  mark.join(["Delta_X", *["0.25".replace(".", decimal)] * len(channels)]),
                  f"***End_of_Header***{mark}", mark.join(names)]
        lines += [mark.join("" if v is None else str(v).replace(".", decimal) for v in row) for row in rows] + [""]
    return "\n".join(lines)


@pytest.mark.parametrize("separator, decimal", [("Tab", "."), ("Tab", ","), ("Comma", ".")])
@pytest.mark.parametrize("columns, names, rows", [
    ("One", ["X_Value", "F", "Comment"], [(1 + k / 4, f) for k, f in enumerate(FORCE)]),
    ("No", ["X_Value", "F", "Comment"], [(None, f) for f in FORCE]),
    ("Multi", ["X_Value", "F", "X_Value", "G", "Comment"], [(1 + k / 4, f, 1 + k / 4, f)
                                                             for k, f in enumerate(FORCE)])])
def test_times_and_forces_come_back(tmp_path, separator, decimal, columns, names, rows):
    (tmp_path / "a.lvm").write_text(measurement(separator, decimal, columns, [(1.0, names, rows)]))
    table = text_table(tmp_path / "a.lvm")
    assert table.columns["X_Value"].tolist() == [1, 1.25, 1.5, 1.75] and table.columns["F"].tolist() == FORCE
    assert table.units["F"] == "N" and table.units["X_Value"] == "s" and table.rate == 4


def test_segments_follow_one_another_and_a_shorter_channel_ends_early(tmp_path):
    names = ["X_Value", "F", "X_Value", "G", "Comment"]
    segments = [(0.0, names, [(0.0, 1.0, 0.0, 5.0), (0.25, 2.0, 0.5, 6.0)]), (0.5, names, [(0.5, 3.0), (0.75, 4.0)])]
    (tmp_path / "a.lvm").write_text(measurement("Tab", ".", "Multi", segments))
    columns = text_table(tmp_path / "a.lvm").columns
    assert columns["F"].tolist() == [1, 2, 3, 4] and columns["X_Value (1)"].tolist() == [0, 0.25, 0.5, 0.75]
    assert columns["X_Value (2)"][1] == 0.5 and np.isnan(columns["G"][2:]).all()
    other = [segments[0], (0.5, ["X_Value", "H"], [(0.5, 3.0)])]
    (tmp_path / "b.lvm").write_text(measurement("Tab", ".", "Multi", other))
    with pytest.raises(ConfigError, match="the channels of the first segment, X_Value, F, X_Value, G, Comment"):
        text_table(tmp_path / "b.lvm")


def test_comments_beside_numbers_are_none(tmp_path):
    (tmp_path / "a.lvm").write_text(measurement("Tab", ".", "One", [
        (0.0, ["X_Value", "F", "Comment"], [(0.0, 1.0, "begin"), (0.25, 2.0)])]))
    assert list(text_table(tmp_path / "a.lvm").columns) == ["X_Value", "F"]
    (tmp_path / "b.lvm").write_text("LabVIEW Measurement\n***End_of_Header***\n")
    with pytest.raises(ConfigError, match="a LabVIEW measurement with channels"):
        text_table(tmp_path / "b.lvm")


def of_two(columns, starts=("0.5", "0.5"), steps=("0.25", "0.25")):
    """Two channels with these X0 and Delta_X, in one segment."""
    names = ["X_Value", "F", "X_Value", "G"] if columns == "Multi" else ["X_Value", "F", "G"]
    clocks = [[float(a) + float(b) * k for k in range(4)] for a, b in zip(starts, steps, strict=True)]
    times = iter([[""] * 4] if columns == "No" else clocks)
    made = [next(times) if name == "X_Value" else FORCE for name in names]
    return "\n".join(["LabVIEW Measurement", "Separator\tTab", f"X_Columns\t{columns}", "***End_of_Header***", "",
                      "\t".join(["X0", *starts]), "\t".join(["Delta_X", *steps]), "***End_of_Header***",
                      "\t".join(names), *("\t".join(map(str, row)) for row in zip(*made, strict=True)), ""])


@pytest.mark.parametrize("columns", ["One", "No", "Multi"])
def test_without_times_the_head_tells_rate_and_begin(tmp_path, columns):
    (tmp_path / "a.lvm").write_text(of_two(columns))
    table = text_table(tmp_path / "a.lvm")
    assert (table.rate, table.begin) == (4.0, 0.5) and table.columns["G"].tolist() == FORCE


@pytest.mark.parametrize("more", [{"starts": ("0", "2")}, {"steps": ("0.25", "0.5")}])
def test_channels_that_begin_apart_or_have_other_rates_are_never_on_one_clock(tmp_path, more):
    for columns in ("One", "No"):
        (tmp_path / "a.lvm").write_text(of_two(columns, **more))
        with pytest.raises(ConfigError, match="one (X0|Delta_X) of all channels, .* save it with a column"):
            text_table(tmp_path / "a.lvm")
    (tmp_path / "a.lvm").write_text(of_two("Multi", **more))
    table = text_table(tmp_path / "a.lvm")
    table.on_clock({"F.column": "F"}, "X_Value (1)")
    table.on_clock({"G.column": "G"}, "X_Value (2)")
    assert table.rate is None
    with pytest.raises(ConfigError, match="G.column: .* found 'G', which stands behind 'X_Value .2.'; list the"):
        table.on_clock({"F.column": "F", "G.column": "G"}, "X_Value (1)")


def test_segments_with_a_pause_between_them_have_no_rate(tmp_path):
    names = ["X_Value", "F"]
    for later, rate in ((0.5, 4.0), (3.0, None)):
        segments = [(0.0, names, [(None, 1.0), (None, 2.0)]), (later, names, [(None, 3.0), (None, 4.0)])]
        (tmp_path / "a.lvm").write_text(measurement("Tab", ".", "No", segments))
        assert text_table(tmp_path / "a.lvm").rate == rate

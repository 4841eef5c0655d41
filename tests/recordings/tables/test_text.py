"""Text tables as instruments, spreadsheets and libraries write them."""

import io

import numpy as np
import pandas
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tables.layout import Form
from pipeline.recordings.tables.text import read_table, text_table


@pytest.mark.parametrize("mark", ["\t", ";", ","])
def test_tables_find_their_delimiter_and_mark_missing_samples(tmp_path, mark):
    path = tmp_path / "a.txt"
    path.write_text("made by a bench\n" + mark.join(("time", "force [N]")) + "\n" + mark.join(("0", "1e3")) + "\n"
                    + mark.join(("0.1", "n/a")) + "\n")
    found = read_table(path, Form(skip=1))
    assert found["time"].tolist() == [0, 0.1] and found["force [N]"][0] == 1000 and np.isnan(found["force [N]"][1])


@pytest.mark.parametrize("text, message", [
    ("a,b\n1,2\n1,x\n", r"a\.csv:3: expected a number, found 'x'"),
    ("a,b\n1\n", r"a\.csv:2: expected 2 values, as many as names in line 1, found 1"),
    ("a,b\n", "expected a header and at least one line"),
])
def test_tables_tell_the_line_of_a_mistake(tmp_path, text, message):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(ConfigError, match=message):
        read_table(path)


@pytest.mark.parametrize("text, told", [
    ("t,x\n0,1_5\n", "2: expected a number, found '1_5'"), ("t,x\n0,0x1A\n", "a number"),
    ("t,x\n0.0,1.2345\n0.1,1.2346\n0.2,1.2", "4: expected a last number as long as those above it"),
    ("t,x\n0,infinity\n", "a number")])
def test_numbers_that_are_none_and_a_last_one_that_is_cut_are_refused(tmp_path, text, told):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(ConfigError, match=told):
        read_table(tmp_path / "a.csv")


def test_a_table_that_ends_without_a_line_break_is_read_where_its_last_number_is_whole(tmp_path):
    (tmp_path / "a.csv").write_text("t,x\n0,10\n1,9\n2,8")
    assert read_table(tmp_path / "a.csv")["x"].tolist() == [10, 9, 8]


@pytest.mark.parametrize("rows, cut, refused", [
    ("-0.25 0.50 -0.75", 1, True), ("0.25 -0.50 0.75", 2, True), ("0.25 10.50 100.75", 1, True),
    ("1.5 22.25 3.125", 1, False)])
def test_a_table_cut_off_within_its_last_number(tmp_path, rows, cut, refused):
    """It has fewer digits, or fewer decimals, than all others of its column; where those differ, nothing tells."""
    (tmp_path / "a.csv").write_text("x\n" + "\n".join(rows.split())[:-cut])
    if refused:
        with pytest.raises(ConfigError, match="the file is cut off"):
            read_table(tmp_path / "a.csv")
    else:
        assert read_table(tmp_path / "a.csv")["x"][-1] == 3.12


@pytest.mark.parametrize("content, units", [
    ("Time,a\n(ms),(V)\n\n0.1,1.5\n0.2,2.5\n", {"Time": "ms", "a": "V"}), ("Time;a\r\n0,1;1,5\r\n0,2;2,5\r\n", {}),
    ("# Time a\n0.1 1.5\n0.2   2.5\n", {}),
    ("LabVIEW Measurement\t\n***End_of_Header***\t\n\t\nChannels\t2\n***End_of_Header***\t\t\nTime\ta\tComment\n"
     "0.1\t1.5\n0.2\t2.5\n", {})])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_tables_of_other_programs(tmp_path, content, units, encoding):
    (tmp_path / "a.txt").write_bytes(content.encode(encoding))
    read = text_table(tmp_path / "a.txt")
    columns, found = read.columns, read.units
    assert {name: values.tolist() for name, values in columns.items()} == {"Time": [0.1, 0.2], "a": [1.5, 2.5]}
    assert found == units


def test_a_table_of_windows_is_read_and_one_of_bytes_is_none(tmp_path):
    (tmp_path / "a.csv").write_bytes("Zeit [s];Weg [µm]\n0,1;5\n".encode("cp1252"))
    assert list(read_table(tmp_path / "a.csv")) == ["Zeit [s]", "Weg [µm]"]
    (tmp_path / "b.csv").write_bytes(b"t,x\n\x01\xff\x00,2\n")
    with pytest.raises(ConfigError, match="a readable text table"):
        read_table(tmp_path / "b.csv")


def test_a_comma_is_no_decimal_where_it_separates_or_points_stand_beside_it(tmp_path):
    (tmp_path / "a.csv").write_text("t;x\n1.5;2,5\n")
    with pytest.raises(ConfigError, match="2: expected a number, found '2,5'"):
        read_table(tmp_path / "a.csv")


TIME = np.arange(50) / 1e4
VOLT = np.sin(2 * np.pi * 50 * TIME)


def rows(mark, decimal=".", first=TIME, form="%.6f"):
    """Rows of times and volts as the C library prints them."""
    lines = (mark.join(form % v for v in pair) for pair in zip(first, VOLT, strict=True))
    return "".join(line.replace(".", decimal) + "\n" for line in lines)


def the_same(table, time, volt, factor=1.0):
    np.testing.assert_allclose(table.columns[time], factor * TIME, atol=1e-6 * factor)
    np.testing.assert_allclose(table.columns[volt], VOLT, atol=1e-5)


def written_by_pandas(**how):
    stream = io.StringIO()
    pandas.DataFrame({"t": TIME, "U": VOLT}).to_csv(stream, **how)
    return stream.getvalue()


def written_by_numpy(**how):
    stream = io.StringIO()
    np.savetxt(stream, np.column_stack([TIME, VOLT]), **how)
    return stream.getvalue()


@pytest.mark.parametrize("text", [
    written_by_pandas(), written_by_pandas(index=False, sep=";", decimal=","), written_by_pandas(index=False, sep="\t"),
    written_by_pandas(index=False, quoting=1), written_by_pandas(index=False, quoting=1, decimal=","),
    written_by_pandas(index=False, float_format="%.8e"), written_by_numpy(header="t U"),
    written_by_numpy(header="t,U"), written_by_numpy(header="t;U", delimiter=";", comments="% "),
    written_by_numpy(header="bench 3\nt U", fmt="%12.6f"),
    pandas.DataFrame({"t": TIME, "U": VOLT}).to_string(index=False, float_format="%.8f") + "\n"])
def test_tables_of_libraries(tmp_path, text):
    (tmp_path / "a.csv").write_text(text)
    the_same(text_table(tmp_path / "a.csv"), "t", "U")


@pytest.mark.parametrize("head, body, time, volt, units", [
    ("sep=;\nt;U\n", rows(";", ","), "t", "U", {}),
    ("t;U;\n", rows(";").replace("\n", ";\n"), "t", "U", {}),
    ("t;U\n", rows(";").replace("\n", ";\n"), "t", "U", {}),
    ("Bench 3, test 17\nOperator: N.N.\n\nt,U\ns,V\n", rows(","), "t", "U", {"t": "s", "U": "V"}),
    ("x-axis,1\nsecond,Volt\n", rows(",", form="%+.6E"), "x-axis", "1", {"x-axis": "s", "1": "V"}),
    ("Name;U\nEinheit;V\nSensor;4711\n", rows(";", ","), "Name", "U", {"U": "V"}),
    ("      t         U\n    [s]       [V]\n", rows("    ", form="%9.6f"), "t", "U", {"t": "s", "U": "V"}),
    ("Model,MSO\nSample Interval,1E-4\n\nTIME,CH1\n", rows(","), "TIME", "CH1", {}),
    ("t (sec)\tU (V)\n", rows("\t"), "t (sec)", "U (V)", {}), ("", rows("  "), "column 1", "column 2", {})])
def test_heads_of_instruments(tmp_path, head, body, time, volt, units):
    (tmp_path / "a.txt").write_text(head + body)
    table = text_table(tmp_path / "a.txt")
    the_same(table, time, volt)
    assert table.units == units


@pytest.mark.parametrize("written", [
    "04.05.2024 23:59:59,{:04d}", "2024-05-04T23:59:59.{:04d}Z", "5/4/2024 11:59:59.{:04d} PM", "23:59:59.{:04d}"])
def test_time_stamps_are_seconds_from_the_first_and_go_on_behind_midnight(tmp_path, written):
    first = [written.format(k) for k in range(9980, 10000)]
    later = written
    for night, day in (("59:59", "00:00"), ("23:", "00:"), ("11:", "12:"), ("PM", "AM"), ("04.05", "05.05"),
                       ("05-04", "05-05"), ("5/4", "5/5")):
        later = later.replace(night, day)
    later = [later.format(k) for k in range(10)]
    (tmp_path / "a.csv").write_text("t;U\n" + "".join(f"{stamp};1\n" for stamp in first + later))
    table = text_table(tmp_path / "a.csv")
    np.testing.assert_allclose(table.columns["t"], np.arange(30) / 1e4, atol=1e-9)
    assert table.units["t"] == "s" and "time stamps" in table.remarks[0]


def test_a_column_of_texts_counts_only_where_it_is_used(tmp_path):
    (tmp_path / "a.csv").write_text("t,U,state\n0.1,1,OK\n0.2,2,OK\nEnd of file\n")
    table = text_table(tmp_path / "a.csv")
    assert list(table.columns) == ["t", "U"] and "lines from 4 on are left out" in table.remarks[0]
    assert list(read_table(tmp_path / "a.csv", wanted={"here": "U"})) == ["t", "U"]
    with pytest.raises(ConfigError, match=r"a.csv:2: expected a number, found 'OK' in state; read as utf-8"):
        table.used({"here": "state"})


def test_names_that_stand_twice_are_numbered_unless_they_hold_the_same(tmp_path):
    (tmp_path / "a.csv").write_text("t,U,t,U\n0,1,0,2\n1,3,1,4\n")
    assert {k: v.tolist() for k, v in text_table(tmp_path / "a.csv").columns.items()} == {
        "t": [0, 1], "U (1)": [1, 3], "U (2)": [2, 4]}


def test_what_the_case_states_goes_before_what_the_lines_show(tmp_path):
    (tmp_path / "a.csv").write_bytes("時間;m\n1,234;x\n2,345;5\n".encode("shift_jis"))
    stated = Form(encoding="shift_jis", delimiter="semicolon", missing=("x",), units_row=False)
    table = text_table(tmp_path / "a.csv", stated)
    assert table.columns["時間"].tolist() == [1.234, 2.345] and np.isnan(table.columns["m"][0])
    with pytest.raises(ConfigError, match="one of 時間, m, found 'n'; read as shift_jis, columns by ';', decimal ','"):
        table.used({"here": "n"})


def test_rates_of_the_head(tmp_path):
    for head in ("Sample rate: 51.2 kHz\n", "Abtastrate;51200\n", "Sampling Interval: 19.53125 us\n"):
        (tmp_path / "a.csv").write_text(head + "\nU;V\n1;2\n3;4\n")
        assert text_table(tmp_path / "a.csv").rate == pytest.approx(51200)


@pytest.mark.parametrize("rows, stated, told", [
    ("0;12,345\n1;99,125\n2;10,500\n", {}, "numbers such as 12,345 are read with the decimal mark ','"),
    ("0;12.345\n1;99.125\n2;10.500\n", {}, "numbers such as 12.345 are read with the decimal mark '.'"),
    ("0;12,345\n1;99,125\n2;10,500\n", {"decimal": ","}, ""), ("0;12,345\n1;0,125\n2;10,500\n", {}, ""),
    ("0.5;12.345\n1.5;99.125\n2.5;10.500\n", {}, ""), ("0;12\n1;99\n2;10\n", {}, "")])
def test_marks_that_may_set_thousands_apart_are_told(tmp_path, rows, stated, told):
    (tmp_path / "a.csv").write_text("t;x\n" + rows)
    remarks = text_table(tmp_path / "a.csv", Form(**stated)).remarks
    assert (told in remarks[0] and "state decimal:" in remarks[0]) if told else not remarks


def test_single_columns_and_units_in_brackets_within_brackets(tmp_path):
    (tmp_path / "a.csv").write_text('"load [N]"\n"1.5"\n"2.5"\n"3.5"\n')
    assert text_table(tmp_path / "a.csv").columns["load [N]"].tolist() == [1.5, 2.5, 3.5]
    (tmp_path / "b.csv").write_text("Time;p;M\n[ms];[bar(g)];[N m]\n0;1;2\n1;1;3\n2;1;4\n")
    table = text_table(tmp_path / "b.csv")
    assert list(table.columns) == ["Time", "p", "M"] and table.units == {"Time": "ms", "p": "bar(g)", "M": "N m"}

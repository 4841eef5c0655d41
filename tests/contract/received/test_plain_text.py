"""Numbers, time stamps, encodings and marks of texts of instruments."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.plain_text import (
    cells,
    decoded,
    delimiter_of,
    lines_of,
    marks,
    number,
    seconds_of,
    stamp,
)


@pytest.mark.parametrize("text, decimal, value", [
    ("1.5", ".", 1.5), ("-1,5E-3", ",", -1.5e-3), (" 7 ", ",", 7), ("1.234,5", ",", 1234.5), ("1,234.5", ".", 1234.5),
    ("1'234.5", ".", 1234.5), ("1.5D+03", ".", 1500), ("\N{MINUS SIGN}2", ".", -2), ("\N{INFINITY}", ".", np.inf)])
def test_numbers(text, decimal, value):
    assert number(text, decimal) == value


@pytest.mark.parametrize("text, decimal", [("1.5", ","), ("1,5", "."), ("1_5", "."), ("0x1A", "."), ("infinity", "."),
                                          ("1 200", ".")])
def test_texts_that_are_none(text, decimal):
    assert number(text, decimal) is None


def test_missing_numbers():
    assert all(np.isnan(number(text)) for text in ("", "NaN", "n/a", "#N/A", "---", "1.#QNAN"))


@pytest.mark.parametrize("encoding, answer", [
    ("utf-8", "utf-8"), ("utf-8-sig", "utf-8-sig"), ("utf-16", "utf-16"), ("utf-16-le", "utf-16-le"),
    ("utf-16-be", "utf-16-be"), ("utf-32", "utf-32"), ("cp1252", "cp1252")])
def test_encodings(tmp_path, encoding, answer):
    (tmp_path / "a.txt").write_bytes("Weg [\u00b5m]\r\n1;2\r\n3;4\r\n5;6\r\n".encode(encoding))
    text, found = decoded(tmp_path / "a.txt")
    assert lines_of(text)[0] == "Weg [\u00b5m]" and found == answer
    with pytest.raises(ConfigError, match="state the encoding of the file"):
        decoded(tmp_path / "a.txt", "no encoding")


@pytest.mark.parametrize("line, delimiter, texts", [
    ('"1,5","a ""b"""', ",", ["1,5", 'a "b"']), ("  1   2\t3", " ", ["1", "2", "3"]), ("1;2;", ";", ["1", "2", ""])])
def test_cells(line, delimiter, texts):
    assert cells(line, delimiter) == texts


@pytest.mark.parametrize("heads, rows, found", [
    (["a;b"], ["1,5;2"], (";", ",")), (["a"], ["1,5"], ("\t", ",")), (["a,b"], ["1,5"], (",", ".")),
    ([], ["1,5 2,5"], (" ", ",")), ([], ["0.1, 0.2"], (",", ".")), ([], ['"0,1","0,2"'], (",", ",")),
    ([], ["1|2"], ("|", "."))])
def test_marks(heads, rows, found):
    assert marks(heads, rows) == found
    assert delimiter_of("tab") == "\t" and delimiter_of("  ") == " " and delimiter_of(None) is None


def test_days_and_months_are_told_by_the_shorter_record():
    texts = ["03/04/2024 23:59:59.5", "04/04/2024 00:00:00.5"]
    assert seconds_of([stamp(t) for t in texts]).tolist() == [0, 1]
    assert seconds_of([stamp("3/31/2024"), stamp("4/1/2024")]).tolist() == [0, 86400]
    assert stamp("4711") is None and stamp("1.5.") is None and seconds_of([stamp("40.40.2024")]) is None

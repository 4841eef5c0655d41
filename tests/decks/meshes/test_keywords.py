"""Lines of Abaqus decks: parameters, continuation, comments, quotation marks."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.keywords import blocks, number, numbers

pytestmark = pytest.mark.exact


def test_parameters_and_rows(tmp_path):
    text = '** comment\n*solid  Section , ELSET = "a, b",\n  material=Iron\n 1., ,3.\n\n** more\n4\n*End Step\n'
    (tmp_path / "a.inp").write_text(text)
    first, last = blocks(tmp_path / "a.inp")
    assert first.name == "SOLID SECTION" and first.given == {"ELSET": "a, b", "MATERIAL": "Iron"}
    assert [fields for _, fields in first.rows] == [["1.", "", "3."], ["4"]]
    assert first.rows[1][0].endswith("a.inp:7") and first.where.endswith("a.inp:2") and last.name == "END STEP"
    assert numbers(first.rows, 3, "X") == [1, 3, 4]
    with pytest.raises(ConfigError, match="4 numbers of .X, found 3"):
        numbers(first.rows, 4, "X")
    with pytest.raises(ConfigError, match=r"\*END STEP with NAME=, found none"):
        last.need("NAME")


def test_numbers_of_fortran():
    assert number("1.5D+3", "") == 1500 and number(" 2e-3", "") == 2e-3 and number("", "", 0.0) == 0
    with pytest.raises(ConfigError, match="here: expected a number, found '1,2'"):
        number("1,2", "here")


def test_a_file_that_is_none(tmp_path):
    with pytest.raises(ConfigError, match="a text file that can be read"):
        list(blocks(tmp_path / "none.inp"))

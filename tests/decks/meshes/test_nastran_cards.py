"""Fields of Nastran: fixed, wide and free, continuations with and without marks, includes, faults."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.nastran_cards import cards, number

pytestmark = pytest.mark.exact


def read(folder, text):
    (folder / "a.bdf").write_text(text)
    head, members = cards(folder / "a.bdf")
    return head, list(members)


@pytest.mark.parametrize("text", [
    "CHEXA   1       2       11      12      13      14      15      16      +A\n+A      17      18      \n",
    "CHEXA   1       2       11      12      13      14      15      16\n        17      18\n",
    "chexa\t1\t2\t11\t12\t13\t14\t15\t16\n\t17\t18\n",
    "CHEXA,1,2,11,12,13,14,15,16\n,17,18\n", "CHEXA, 1, 2, 11,12,13,14,15,16,+\n+,17,18 $ comment\n",
    "CHEXA*                 1               2              11              12*\n"
    "*                     13              14              15              16*B\n"
    "*B                    17              18\n", "CHEXA*,1,2,11,12,*\n*,13,14,15,16,*\n*,17,18\n"])
def test_one_card_in_every_form(tmp_path, text):
    head, (card,) = read(tmp_path, f"SOL 103\n$\nCEND\nBEGIN BULK\n{text}ENDDATA\nrubbish\n")
    assert head == ["SOL 103", "CEND"] and card.name == "CHEXA" and card.where.endswith("a.bdf:5")
    assert [card.get(k) for k in range(2, 12)] == ["1", "2", *map(str, range(11, 19))] and card.get(99) == ""


def test_numbers_without_a_letter():
    values = [number(text, "") for text in ("1.5-3", "2.D+4", "-1.6E-14", "7.", "-.5+2", "3")]
    assert values == [1.5e-3, 2e4, -1.6e-14, 7, -50, 3]
    for text in ("x", "nan", "1.5-", ""):
        with pytest.raises(ConfigError, match="here: expected a number"):
            number(text, "here")


def test_includes(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "grids.bdf").write_text("GRID,1,,0.,0.,0.\n")
    _, members = read(tmp_path, "INCLUDE 'sub/\n   grids.bdf'\ninclude sub/grids.bdf\nGRID,2,,0.,0.,0.\n")
    assert [card.get(2) for card in members] == ["1", "1", "2"]
    with pytest.raises(ConfigError, match="a.bdf:1: expected an include within"):
        read(tmp_path, "INCLUDE '../a.bdf'\n")
    with pytest.raises(ConfigError, match="a.bdf:1: expected a file to include, found none"):
        read(tmp_path, "INCLUDE 'none.bdf'\n")
    with pytest.raises(ConfigError, match="found a.bdf within itself"):
        read(tmp_path, "INCLUDE 'a.bdf'\n")


@pytest.mark.parametrize("text, message", [
    ("+,1,2\n", "a.bdf:1: expected a card before its continuation"),
    ("CHEXA,1,2,3,4,5,6,7,8,+A\n+B,1\n", "a.bdf:2: expected the continuation 'A' of the line before, found 'B'; sort"),
    ("CHEXA,1,2,3,4,5,6,7,8,+,10,11\n", "at most 8 fields in a line, found 11"),
    ("GRID,1,,0.,0.,0.\nGRID,*(1),=,=,=,*(1.)\n", "cards that are written out, found a replication"),
    ("BEGIN BULK\nBEGIN SUPER=1\n", "one section of bulk data, found BEGIN SUPER=1"),
])
def test_faults_have_one_sentence(tmp_path, text, message):
    with pytest.raises(ConfigError, match=message):
        read(tmp_path, text)

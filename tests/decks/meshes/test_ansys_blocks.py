"""Commands of Ansys archives, and fields of fixed width that may touch each other."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.ansys_blocks import commands

pytestmark = pytest.mark.exact


def read(folder, text):
    (folder / "a.cdb").write_text(text)
    return list(commands(folder / "a.cdb"))


def test_fields_of_fixed_width(tmp_path):
    text = "/PREP7\nNBLOCK,6,SOLID ! nodes\n(3i4,6e8.2e1)\n123456789012-1.00E+0-2.00E+0\n\n  12   0   0\n  -1\n" \
           "et,1,186\n"
    first, block, last = read(tmp_path, text)
    assert first.name == "/PREP7" and block.values == ["6", "SOLID"] and block.get(5) == "" and last.name == "ET"
    rows = list(block.table())
    assert [row[1:] for row in rows[1:]] == [([12, 0, 0], [])]
    assert rows[0][1] == [1234, 5678, 9012] and rows[0][2] == [-1, -2] and rows[0][0].endswith("a.cdb:4")


def test_numbers_that_touch(tmp_path):
    block, = read(tmp_path, "NBLOCK,3\n(1i9,3e20.9e3)\n        1   -1.500000000E+000    2.500000000E+000\n-1\n1\n")
    assert list(block.table()) == [(block.rows[1][0], [1], [-1.5, 2.5])]


@pytest.mark.parametrize("text, message", [
    ("1, 2\n", "a.cdb:1: expected a command such as /PREP7"),
    ("NBLOCK,6\n1 2 3\n", "a format such as .* below NBLOCK, found '1 2 3'"),
    ("NBLOCK,6\n", "below NBLOCK, found none"),
    ("NBLOCK,6\n(3i4,3e8.1)\n  1x   0   0\n", "a.cdb:3: expected a whole number, found '1x'"),
    ("NBLOCK,6\n(3i4,3e8.1)\n   1   0   0     y\n", "a.cdb:3: expected a number, found 'y'"),
])
def test_faults_have_one_sentence(tmp_path, text, message):
    with pytest.raises(ConfigError, match=message):
        for command in read(tmp_path, text):
            list(command.table())

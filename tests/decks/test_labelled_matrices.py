"""Matrices of Abaqus and Nastran: labels, one triangle, fields of both widths, numbers without their letter."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.labelled_matrices import abaqus, nastran

DENSE = np.array([[4.0, -1.5, 0.0], [-1.5, 5.0, 0.25], [0.0, 0.25, 6.0]])
LABELS = [[7, 1], [7, 3], [12, 1]]


def written(path, text):
    path.write_text(text)
    return path


def test_abaqus_by_node_and_direction_gives_one_triangle(tmp_path):
    found = abaqus(written(tmp_path / "k.mtx", "** matrix\n7,1, 7,1, 4.0\n7,3,7,1,-1.5\n7,3, 7,3, 5.0\n12,1,7,3,0.25\n"
                                               "12,1,12,1,6.\n"))
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE)
    assert found.label.tolist() == LABELS and found.halved


def test_abaqus_by_row_and_column(tmp_path):
    lines = [f"{i + 1} {j + 1} {v:.16e}" for (i, j), v in np.ndenumerate(DENSE) if v]
    found = abaqus(written(tmp_path / "k.mtx", "\n".join(lines)))
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE)
    assert found.label is None and not found.halved


@pytest.mark.parametrize("text, told", [
    ("1 1 1.0\n1 2\n", "2 in entry 2"), ("1 1\n", "expected lines of 3 numbers .* found 2"), ("", "found no"),
    ("0 1 2.0\n", "rows and columns from 1 on"), ("1 1 x\n", "could not convert")])
def test_other_lines_are_told(tmp_path, text, told):
    with pytest.raises(ConfigError, match=told):
        abaqus(written(tmp_path / "k.mtx", text))


WIDE = """DMIG    KAAX           0       6       1       0                       3
DMIG*   KAAX                           7               1
*                      7               1 4.000000000D+00
*                      7               3-1.500000000D+00
DMIG*   KAAX                           7               3
*                      7               3 5.000000000D+00
*                     12               1           2.5-1
DMIG*   KAAX                          12               1
*                     12               1 6.000000000D+00
DMIG    MAAX           0       1       1       0                       3
DMIG*   MAAX                           7               1
*                      7               1 1.000000000D+00
"""
NARROW = """DMIG    KAAX           0       6       1       0                       3
DMIG    KAAX           7       1               7       1     4.0
               7       3    -1.5
DMIG    KAAX           7       3               7       3     5.0
+             12       1    .25
DMIG,KAAX,12,1,,12,1,6.0
"""


@pytest.mark.parametrize("text", [WIDE, NARROW], ids=["wide", "narrow"])
def test_nastran_in_fields_of_either_width(tmp_path, text):
    found = nastran(written(tmp_path / "k.pch", text), "KAAX")
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE)
    assert found.label.tolist() == LABELS and found.halved


def test_nastran_of_several_matrices_asks_for_a_name(tmp_path):
    path = written(tmp_path / "k.pch", WIDE)
    assert nastran(path, "MAAX").matrix().toarray().tolist() == [[1.0]]
    with pytest.raises(ConfigError, match="found KAAX, MAAX"):
        nastran(path)
    with pytest.raises(ConfigError, match="k.pch:3: expected a number, found 'xx'"):
        nastran(written(path, WIDE.replace("4.000000000D+00", "xx             ")), "KAAX")

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


HALF = "7,1, 7,1, 4.0\n7,3,7,1,-1.5\n7,3, 7,3, 5.0\n12,1,7,3,0.25\n12,1,12,1,6.\n"


def test_abaqus_by_node_and_direction_is_as_it_stands(tmp_path):
    """One triangle, of which the file does not say whether it is half of a symmetric matrix."""
    found = abaqus(written(tmp_path / "k.mtx", "** matrix\n" + HALF))
    np.testing.assert_array_equal(found.matrix().toarray(), np.tril(DENSE))
    assert found.label.tolist() == LABELS and found.form == "" and found.halves


def test_abaqus_says_its_type(tmp_path):
    head = "*MATRIX INPUT, NAME=K, TYPE={}\n".format
    found = abaqus(written(tmp_path / "k.mtx", head("SYMMETRIC") + HALF))
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE)
    assert found.form == "symmetric"
    found = abaqus(written(tmp_path / "k.mtx", head("Unsymmetric") + HALF))
    np.testing.assert_array_equal(found.matrix().toarray(), np.tril(DENSE))
    assert found.form == "general" and not found.halves
    assert abaqus(written(tmp_path / "k.mtx", "*matrix input, name=K\n" + HALF)).halves


def test_abaqus_numbers_the_nodes_that_it_adds_below_0(tmp_path):
    found = abaqus(written(tmp_path / "k.mtx", "7,1,7,1,4.\n-1,1,7,1,1.\n-1,2,7,1,-1.\n"))
    assert found.label.tolist() == [[-1, 1], [-1, 2], [7, 1]]
    np.testing.assert_array_equal(found.matrix().toarray(), [[0, 0, 1], [0, 0, -1], [0, 0, 4]])


@pytest.mark.parametrize("spelt", ["{:.16e}", "{:.16E}"], ids=["c", "fortran"])
def test_abaqus_by_row_and_column(tmp_path, spelt):
    lines = [f"{i + 1} {j + 1} {spelt.format(v).replace('E', 'D')}" for (i, j), v in np.ndenumerate(DENSE) if v]
    found = abaqus(written(tmp_path / "k.mtx", "\n".join(lines)))
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE)
    assert found.label is None and found.form == ""


@pytest.mark.parametrize("text, told", [
    ("1 1 1.0\n1 2\n", "k.mtx:2: .* found another number of them"), ("", "found none"),
    ("1 1\n", "expected lines of 3 numbers .* found 2"), ("1 1 x\n", "k.mtx:1: expected a number"),
    ("** x\n1 1 2.\n0 1 2.0\n", "k.mtx:3: .* rows and columns from 1 on"),
    ("1,1,1.5,1,2.\n", "whole numbers of nodes and directions, found 1 1 1.5 1")])
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
    assert found.label.tolist() == LABELS and found.form == "symmetric"


def test_nastran_says_the_form(tmp_path):
    """1 is square and taken as it stands; a symmetric one has one of two opposite entries; others are no matrices."""
    path = tmp_path / "k.pch"
    found = nastran(written(path, NARROW.replace("0       6", "0       1")))
    np.testing.assert_array_equal(found.matrix().toarray(), np.tril(DENSE))
    assert found.form == "general"
    with pytest.raises(ConfigError, match="k.pch: expected KAAX of the form 1 .square. or 6 .symmetric., found '2'"):
        nastran(written(path, NARROW.replace("0       6", "0       2")))
    with pytest.raises(ConfigError, match="a symmetric matrix.* found 0.5 and 0.25 at node 7 direction 3 and node 12"):
        nastran(written(path, NARROW + "DMIG,KAAX,12,1,,7,3,0.5\n"))


def test_nastran_of_complex_numbers_is_told(tmp_path):
    head, lines = "DMIG,K,0,6,{},0\n".format, "DMIG,K,7,1,,7,1,4.0,{}\n".format
    path = tmp_path / "k.pch"
    assert nastran(written(path, head(3) + lines("0.0"))).value.tolist() == [4.0]
    assert nastran(written(path, head(2) + lines("0.5"))).value.tolist() == [4.0]
    with pytest.raises(ConfigError, match="k.pch:2: expected real entries, found an imaginary part, 0.5"):
        nastran(written(path, head(3) + lines("0.5")))


def test_nastran_of_several_matrices_asks_for_a_name(tmp_path):
    path = written(tmp_path / "k.pch", WIDE)
    assert nastran(path, "MAAX").matrix().toarray().tolist() == [[1.0]]
    with pytest.raises(ConfigError, match="found KAAX, MAAX"):
        nastran(path)
    with pytest.raises(ConfigError, match="k.pch:3: expected a number, found 'xx'"):
        nastran(written(path, WIDE.replace("4.000000000D+00", "xx             ")), "KAAX")

"""Entries of a matrix: sums, checks, the other side of a diagonal."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.entries import GENERAL, SKEW, SYMMETRIC, Entries, named, sound


def of(matrix, label=None):
    row, column = np.nonzero(matrix)
    return Entries(row, column, np.asarray(matrix, float)[row, column], len(matrix), label)


def test_entries_of_one_place_are_summed():
    found = Entries(np.array([0, 1, 1]), np.array([0, 1, 1]), np.array([1.0, 2.0, 3.0]), 2)
    np.testing.assert_array_equal(found.matrix().toarray(), np.diag([1.0, 5.0]))


def test_complex_entries_without_an_imaginary_part_are_real():
    found = sound("f", Entries([0], [0], np.array([2 + 0j]), 1, form=GENERAL))
    assert found.value.dtype == float and found.row.dtype == np.int64 and found.form == GENERAL
    with pytest.raises(ConfigError, match="complex"):
        sound("f", Entries([0], [0], np.array([2 + 1j]), 1))


@pytest.mark.parametrize("form, sign", [(SYMMETRIC, 1), (SKEW, -1)])
def test_one_side_of_the_diagonal_gives_the_other(form, sign):
    """Whichever side each entry is on, in one part or in two; both sides are left as they are."""
    diagonal = np.diag([1e36, 5.0, 6.0]) * (form == SYMMETRIC)
    whole = diagonal + np.array([[0, 2.0, 0], [2 * sign, 0, 3], [0, 3 * sign, 0]])
    mixed = whole.copy()
    mixed[1, 0] = mixed[1, 2] = 0
    for half in (np.tril(whole), np.triu(whole), mixed, whole):
        found = of(half).whole("f", form)
        np.testing.assert_array_equal(found.matrix().toarray(), whole)
        assert found.form == form
    parts = Entries(np.array([1, 1]), np.array([0, 0]), np.array([0.5, 1.5]) * sign, 2).whole("f", form)
    np.testing.assert_array_equal(parts.matrix().toarray(), [[0, 2], [2 * sign, 0]])


def test_sides_that_contradict_the_form_are_refused():
    label = np.array([[7, 1], [7, 3]])
    with pytest.raises(ConfigError, match="f: expected a symmetric matrix.* found 2 and 3 at node 7 direction 1 and"
                                          " node 7 direction 3; say that it is general"):
        of([[1.0, 2], [3, 1]], label).whole("f", SYMMETRIC)
    with pytest.raises(ConfigError, match="found 2 and 2 at row 1 and row 2"):
        of([[0.0, 2], [2, 0]]).whole("f", SKEW)
    with pytest.raises(ConfigError, match="whose diagonal is 0, found 1 on the diagonal, row 2"):
        of([[0.0, 2], [0, 1]]).whole("f", SKEW)
    with pytest.raises(ConfigError, match="found 4 and 0 at row 1 and row 3"):
        of([[1.0, 2, 4], [2, 1, 0], [0, 0, 1]]).whole("f", SYMMETRIC)


def test_rows_are_named_by_node_or_number():
    assert named(np.array([[-2, 1]]), 0) == "node -2 direction 1"
    assert named(None, 4) == named(np.empty((0, 2), int), 4) == "row 5"

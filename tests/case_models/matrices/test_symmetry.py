"""Entries on one side of a diagonal: half of a symmetric matrix, a term of friction, or asked back."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy

from pipeline.case_models.matrices.sections import Term
from pipeline.case_models.matrices.symmetry import as_meant, one_sided
from pipeline.contract import ConfigError
from pipeline.decks.entries import Entries

CHAIN = 1e7 * (2 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1))
GYRO = np.eye(4, k=-1) - np.eye(4, k=1)
#: forces along directions 1 and 2 of the nodes 1 and 2 from motion in direction 3
FRICTION = np.zeros((4, 4))
FRICTION[0, 2], FRICTION[1, 3] = -2e6, 3e6


def entries(matrix, **more):
    row, column = np.nonzero(matrix)
    return Entries(row, column, np.asarray(matrix, float)[row, column], len(matrix), **more)


def meant(matrix, kind="stiffness", symmetry=None, friction=False, size=4, **more):
    term = Term.model_construct(file=Path("a.mtx"), symmetry=symmetry)
    found, remark = as_meant(entries(matrix, **more), kind, term, friction, size, f"matrices.{kind}.a")
    return found.matrix().toarray(), remark


def test_one_side_is_seen_in_whatever_order():
    rows = np.random.default_rng(1).permutation(4)
    for matrix, one in ((np.tril(CHAIN), True), (np.triu(CHAIN), True), (CHAIN, False), (GYRO, False),
                        (np.eye(4), False), (FRICTION, True), (CHAIN + FRICTION, False)):
        for ordered in (matrix, matrix[np.ix_(rows, rows)]):
            sparse = scipy.sparse.csr_matrix(ordered)
            assert one_sided(sparse) == one_sided(scipy.sparse.csc_array(sparse)) == one


@pytest.mark.parametrize("kind", ["stiffness", "damping", "loss", "mass"])
def test_the_lower_triangle_of_abaqus_is_half(kind):
    held = np.diag([0, 0, 0, 1e36])
    found, remark = meant(np.tril(CHAIN) + held, kind, halves=True)
    np.testing.assert_array_equal(found, CHAIN + held)
    assert remark.startswith(f"matrices.{kind}.a: a.mtx holds the lower triangle") and "symmetry: general" in remark


def test_nodes_that_abaqus_adds_have_no_place_in_the_order():
    """A constraint between two nodes: its multiplier comes first by its label, and has no diagonal."""
    label = np.array([[-1, 1], [3, 1], [4, 1], [5, 1]])
    half = np.zeros((4, 4))
    half[1:, 1:] = np.tril(CHAIN[1:, 1:])
    half[0, 2], half[0, 3] = 1.0, -1.0
    found, _ = meant(half, halves=True, label=label)
    np.testing.assert_array_equal(found, half + half.T - np.diag(half.diagonal()))


@pytest.mark.parametrize("kind", ["stiffness", "damping"])
@pytest.mark.parametrize("matrix", [FRICTION, FRICTION.T], ids=["upper", "lower"])
@pytest.mark.parametrize("halves", [True, False])
def test_friction_on_one_side_is_taken_as_it_stands(kind, matrix, halves):
    found, remark = meant(matrix, kind, friction=True, halves=halves)
    np.testing.assert_array_equal(found, matrix)
    assert "taken as it stands" in remark


@pytest.mark.parametrize("matrix, more", [
    (np.tril(CHAIN), {}),                                       # .mat and .npz say nothing
    (np.tril(CHAIN), {"form": "general"}),                      # Matrix Market says general
    (np.triu(CHAIN), {"halves": True}),                         # Abaqus writes the lower triangle
    (np.tril(CHAIN), {"halves": True, "size": 5}),              # and stiffness for all that can move
    (FRICTION.T, {"halves": True}),                             # friction without 'times'
    (FRICTION.T + np.diag([1e6, 0, 1e6, 0]), {"halves": True}),
    (np.tril(CHAIN), {"halves": True, "friction": True}),       # half of a damping by friction, or not
    (np.tril(GYRO), {"kind": "damping", "halves": True}), (np.triu(np.ones((4, 4))), {"kind": "mass"})])
def test_what_may_mean_either_is_asked_back(matrix, more):
    kind = more.get("kind", "stiffness")
    with pytest.raises(ConfigError, match=f"matrices.{kind}.a.symmetry: expected symmetric.* as a.mtx has, found none; "
                                          "write 'symmetry: symmetric'"):
        meant(matrix, **more)
    found, remark = meant(matrix, **more, symmetry="general")
    np.testing.assert_array_equal(found, matrix)
    assert not remark


@pytest.mark.parametrize("form, whole", [("symmetric", CHAIN), ("skew-symmetric", GYRO)])
def test_the_case_says_the_form(form, whole):
    for half in (np.tril(whole), np.triu(whole), whole):
        found, remark = meant(half, symmetry=form, form="general")
        np.testing.assert_array_equal(found, whole)
        assert not remark
    with pytest.raises(ConfigError, match=f"matrices.stiffness.a: a.mtx: expected a {form} matrix"):
        meant(CHAIN + FRICTION - np.diag(CHAIN.diagonal()), symmetry=form)


def test_the_file_and_the_case_agree():
    found, remark = meant(CHAIN, form="symmetric")
    assert not remark and found[0, 1] == found[1, 0]
    assert meant(CHAIN, form="symmetric", symmetry="symmetric")[0][1, 0] == found[1, 0]
    with pytest.raises(ConfigError, match="a.symmetry: expected symmetric, as a.mtx says, found general"):
        meant(CHAIN, form="symmetric", symmetry="general")


def test_both_sides_are_left_as_they_are():
    for matrix in (CHAIN + FRICTION, GYRO, np.eye(4)):
        for more in ({}, {"form": "general"}, {"halves": True}, {"halves": True, "friction": True}):
            found, remark = meant(matrix, **more)
            np.testing.assert_array_equal(found, matrix)
            assert not remark


def test_zeros_that_are_written_are_no_entries():
    given = entries(np.tril(CHAIN), halves=True)
    zeros = replace(given, row=np.append(given.row, 0), column=np.append(given.column, 1),
                    value=np.append(given.value, 0.0))
    assert one_sided(zeros.matrix())

"""Matrices from files: the same entries, whatever wrote them; one sentence for what is none."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.decks.matrix_files import _opened, read

DENSE = np.array([[4.0, -1.5, 0.0], [-1.5, 5.0, 0.25], [0.0, 0.25, 6.0]])
SPARSE = scipy.sparse.csr_matrix(DENSE)


def held(path, variable=None):
    return read(path, variable).matrix().toarray()


def test_the_entries_are_those_that_were_written(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"K": SPARSE})
    scipy.io.mmwrite(tmp_path / "a.mtx", SPARSE)
    scipy.io.mmwrite(tmp_path / "full.mtx", DENSE, symmetry="general")
    scipy.sparse.save_npz(tmp_path / "a.npz", SPARSE)
    np.savez(tmp_path / "b.npz", K=DENSE, M=np.eye(3))
    for name in ("a.mat", "a.mtx", "full.mtx", "a.npz"):
        np.testing.assert_array_equal(held(tmp_path / name), DENSE)
    np.testing.assert_array_equal(held(tmp_path / "b.npz", "M"), np.eye(3))


def test_one_of_several_matrices_is_named(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"K": DENSE, "M": np.eye(3), "note": "x"})
    np.testing.assert_array_equal(held(tmp_path / "a.mat", "K"), DENSE)
    with pytest.raises(ConfigError, match="expected one matrix, or its name as 'variable', found K, M"):
        read(tmp_path / "a.mat")
    with pytest.raises(ConfigError, match="expected the matrix 'C', found K, M"):
        read(tmp_path / "a.mat", "C")


SKEW = np.array([[0.0, -1.5, 0.0], [1.5, 0.0, -0.25], [0.0, 0.25, 0.0]])


@pytest.mark.parametrize("kind", [np.asarray, scipy.sparse.coo_matrix], ids=["array", "coordinate"])
@pytest.mark.parametrize("matrix, form", [(DENSE, "symmetric"), (SKEW, "skew-symmetric"), (SKEW, "general"),
                                          (np.tril(DENSE), "general"), (DENSE, "hermitian")])
def test_the_head_of_matrix_market_says_the_form(tmp_path, kind, matrix, form):
    """SciPy writes one triangle where it may; the whole comes back."""
    with gzip.open(tmp_path / "a.mtx.gz", "wb") as file:
        scipy.io.mmwrite(file, kind(matrix + 0j if form == "hermitian" else matrix), symmetry=form)
    found = _opened(tmp_path / "a.mtx.gz", None)
    np.testing.assert_array_equal(found.matrix().toarray(), matrix)
    assert found.form == form.replace("hermitian", "symmetric") and not found.halves


def market(path, head, *lines):
    path.write_text("\n".join((f"%%{head}", "% made by hand", *lines)) + "\n")
    return _opened(Path(path), None)


def test_matrix_market_of_other_writers(tmp_path):
    """Fortran's exponents, which SciPy reads as 1; a head in other letters; the upper triangle, or both sides."""
    path, symmetric = tmp_path / "a.mtx", "MatrixMarket matrix coordinate real symmetric"
    for head, lines in ((symmetric, ("1 1 4.D0", "2 1 -.15d+01", "2 2 0.5D+1")),
                        ("MATRIXMARKET Matrix Coordinate Real Symmetric", ("1 1 4", "1 2 -1.5", "2 2 5"))):
        found = market(path, head, "2 2 3", *lines)
        np.testing.assert_array_equal(found.matrix().toarray(), DENSE[:2, :2])
    found = market(path, symmetric, "2 2 4", "1 1 4", "1 2 -1.5", "2 1 -1.5", "2 2 5")
    np.testing.assert_array_equal(found.matrix().toarray(), DENSE[:2, :2])
    with pytest.raises(ConfigError, match="a symmetric matrix.* found -1.5 and 3 at row 1 and row 2"):
        market(path, symmetric, "2 2 4", "1 1 4", "1 2 -1.5", "2 1 3", "2 2 5")
    with pytest.raises(ConfigError, match="expected entries with values, found a head that says 'pattern'"):
        market(path, "MatrixMarket matrix coordinate pattern symmetric", "2 2 1", "1 1")
    with pytest.raises(ConfigError, match="expected a head '%%MatrixMarket matrix'"):
        market(path, "MatrixMarket vector", "2 2 1", "1 1")


@pytest.mark.parametrize("matrix, told", [
    (DENSE[:2], "expected a square matrix, found 2 x 3"), (1j * DENSE, "expected finite real entries, found complex"),
    (np.where(DENSE == 5, np.nan, DENSE), "expected finite real entries"),
    (np.zeros((3, 3)), "found 3 rows, 0 entries")])
def test_what_is_no_matrix_of_a_model_is_refused(tmp_path, matrix, told):
    scipy.io.savemat(tmp_path / "a.mat", {"K": matrix})
    with pytest.raises(ConfigError, match=told):
        read(tmp_path / "a.mat")


def test_damaged_and_unknown_files_are_one_sentence(tmp_path):
    for name in ("a.mat", "a.mtx", "a.npz", "a.pch", "a.op2"):
        (tmp_path / name).write_bytes(b"%%MatrixMarket nonsense\n" + bytes(range(200)))
        with pytest.raises(ConfigError) as error:
            read(tmp_path / name)
        assert len(str(error.value)) < 700 and "expected" in str(error.value)

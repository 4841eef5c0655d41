"""Matrices from files: the same entries, whatever wrote them; one sentence for what is none."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.decks.matrix_files import read

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

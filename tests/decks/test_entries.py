"""Entries of a matrix: sums, checks."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.entries import Entries, sound


def test_entries_of_one_place_are_summed():
    found = Entries(np.array([0, 1, 1]), np.array([0, 1, 1]), np.array([1.0, 2.0, 3.0]), 2)
    np.testing.assert_array_equal(found.matrix().toarray(), np.diag([1.0, 5.0]))


def test_complex_entries_without_an_imaginary_part_are_real():
    found = sound("f", Entries([0], [0], np.array([2 + 0j]), 1))
    assert found.value.dtype == float and found.row.dtype == np.int64
    with pytest.raises(ConfigError, match="complex"):
        sound("f", Entries([0], [0], np.array([2 + 1j]), 1))

"""Large arrays are lent to other processes: the same numbers, one's own to write to, none left behind."""

import os
import pickle

import numpy as np
import pytest

from pipeline.contract.executors import LocalProcesses
from pipeline.contract.executors.lent_arrays import Lender

pytestmark = pytest.mark.skipif(not hasattr(os, "memfd_create"), reason="arrays are sent here")
LARGE = np.arange(600_000.0).reshape(600, 1000)


def descriptors():
    return len(os.listdir("/proc/self/fd"))


@pytest.mark.parametrize("array", [LARGE, np.asfortranarray(LARGE), LARGE.astype(np.complex64), LARGE[:300].T])
def test_it_is_the_same_and_lies_the_same(array):
    lender = Lender()
    packed = lender.packed({"whole": array, "again": [array], "gaps": array[::2, ::2]})
    assert len(packed.content) < array.nbytes
    there = pickle.loads(packed.content)
    lender.take_back(packed)
    assert (there["whole"] == array).all() and there["whole"].dtype == array.dtype
    assert there["whole"].strides == array.strides and there["again"][0] is there["whole"]
    assert (there["gaps"] == array[::2, ::2]).all() and there["gaps"].flags.c_contiguous


def test_to_write_to_it_changes_it_for_nobody_else():
    lender = Lender()
    packed = lender.packed(LARGE)
    one, other = pickle.loads(packed.content), pickle.loads(packed.content)
    one[0, 0] = -1.0
    assert other[0, 0] == LARGE[0, 0] == 0.0
    lender.take_back(packed)
    assert other[-1, -1] == LARGE[-1, -1]       # what was borrowed stays


def test_an_array_is_written_once_and_let_go_with_the_last_value_that_borrows_it():
    before, lender = descriptors(), Lender()
    values = [lender.packed((LARGE, k)) for k in range(5)]
    assert descriptors() == before + 1
    for value in values:
        lender.take_back(value)
    assert descriptors() == before


def test_what_cannot_be_packed_borrows_nothing():
    before = descriptors()
    with pytest.raises((pickle.PicklingError, AttributeError)):
        Lender().packed((LARGE, lambda: None))
    assert descriptors() == before


def _sum(array):
    array[0] = 0.0
    return float(array.sum())


def test_processes_borrow():
    before, pool = descriptors(), LocalProcesses(2)
    try:
        assert pool.map(_sum, [LARGE] * 3, lambda: None) == [LARGE[1:].sum()] * 3
    finally:
        pool.close()
    assert not pool._lender._lent and descriptors() <= before + 2 and LARGE[0, 1] == 1.0

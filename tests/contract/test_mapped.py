"""Large arrays: in files, mapped, in blocks."""

import pickle
import resource

import numpy as np
import pytest

from pipeline.contract import ProductError, mapped, store
from pipeline.contract.mapped import LARGE, Growing, Slices, blocks, map_of
from tests.contract.toy.products import Inner

#: more than LARGE bytes
NUMBERS = np.arange(300_000.0)


def grown(values, dtype=float, folder=None, step=777):
    growing = Growing(dtype, folder)
    for first in range(0, len(values), step):
        growing.append(values[first:first + step])
    return growing.array()


@pytest.mark.parametrize("count", [0, 10, len(NUMBERS)])
def test_what_grows_by_blocks_is_whole_and_fixed(count):
    """In memory while it is small, else in a file without a name."""
    array = grown(NUMBERS[:count], np.float32)
    np.testing.assert_array_equal(array, NUMBERS[:count].astype(np.float32))
    assert array.dtype == np.float32 and not array.flags.writeable
    assert (map_of(array) is not None) == (array.nbytes >= LARGE)


def test_what_was_given_may_change_afterwards():
    growing, block = Growing(float), np.ones(3)
    growing.append(block)
    block[:] = 7.0
    assert growing.array().tolist() == [1, 1, 1]


@pytest.mark.parametrize("array", [np.float64(3.0), np.arange(10.0), np.ones((7, 3)), np.empty(0), NUMBERS,
                                   grown(NUMBERS), grown(NUMBERS).reshape(-1, 4)])
def test_blocks_are_the_array(array):
    array = np.asarray(array)
    parts = list(blocks(array, 1000))
    np.testing.assert_array_equal(np.concatenate([np.atleast_1d(part) for part in parts] or [array]), array)
    assert max((part.nbytes for part in parts), default=0) <= 1000


def test_slices_of_a_mapped_array_do_not_depend_on_it():
    array = grown(NUMBERS)
    part = Slices(array)[5:9]
    assert len(Slices(array)) == len(NUMBERS) and part.tolist() == [5, 6, 7, 8] and map_of(part) is None
    assert Slices(NUMBERS)[5:9].base is NUMBERS


def test_a_file_in_a_folder_keeps_its_name(tmp_path):
    file = map_of(grown(NUMBERS, folder=tmp_path))
    assert [str(path) for path in tmp_path.iterdir()] == [file.path]
    np.testing.assert_array_equal(np.fromfile(file.path), NUMBERS)
    assert map_of(grown(NUMBERS)).path is None


def test_no_room_is_told(tmp_path):
    with pytest.raises(ProductError, match="gone: expected room for the samples of a record"):
        grown(NUMBERS, folder=tmp_path / "gone")


def test_more_channels_than_files_that_are_usually_open(monkeypatch):
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    monkeypatch.setattr(mapped, "LARGE", 8)
    mapped._lift_limit.cache_clear()
    resource.setrlimit(resource.RLIMIT_NOFILE, (256, limits[1]))
    try:
        every = [grown(np.full(5, float(k))) for k in range(400)]
        assert [array[4] for array in every] == list(range(400))
    finally:
        every.clear()
        resource.setrlimit(resource.RLIMIT_NOFILE, limits)
        mapped._lift_limit.cache_clear()


@pytest.fixture
def product(tmp_path):
    store.write(Inner(position=np.arange(300_000.0).reshape(-1, 3)), tmp_path / "inner.h5", {})
    return store.read(Inner, tmp_path / "inner.h5")


def test_a_product_goes_to_other_processes_by_its_place(product, tmp_path):
    sent = pickle.dumps(product)
    np.testing.assert_array_equal(pickle.loads(sent).position, product.position)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(Inner(position=product.position[5:90_000]))).position,
                                  product.position[5:90_000])
    assert len(sent) < 1000
    whole = store.read(Inner, tmp_path / "inner.h5", whole=True)
    assert len(pickle.dumps(whole)) > product.position.nbytes


def test_a_product_that_was_written_since_is_not_taken_for_it(product, tmp_path):
    sent, before = pickle.dumps(product), product.position.sum()
    store.write(Inner(position=np.zeros((100_000, 3))), tmp_path / "inner.h5", {})
    with pytest.raises(ProductError, match="expected the file as it was opened, found one written since"):
        pickle.loads(sent)
    assert product.position.sum() == before         # the old file lasts as long as what is mapped of it


def test_without_its_file_a_product_goes_whole(product, tmp_path):
    (tmp_path / "inner.h5").unlink()
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(product)).position, product.position)


def test_what_an_array_is_not_a_part_of(product):
    assert map_of(product.position[1:, 0]) is map_of(product.position) is not None
    assert map_of(np.array(product.position)) is None and map_of("text") is None
    assert mapped.sent("text") == "text"

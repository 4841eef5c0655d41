"""The checksum behind a product tells every change of its bytes, before HDF5 sees any."""

import random

import h5py
import pytest

from pipeline.contract import ProductError, store
from pipeline.contract.integrity import checksum
from tests.contract.test_product import GOOD
from tests.contract.toy.products import Source


@pytest.fixture
def written(tmp_path):
    store.write(Source(**GOOD), tmp_path / "source.h5", {"stage": "source"})
    return tmp_path / "source.h5"


def test_a_whole_file_and_what_follows_from_its_digest(written):
    assert checksum.flaw(written) == ""
    assert checksum.digest_of_file(written) == checksum.digest_of(written.read_bytes())
    with h5py.File(written) as h5:
        assert h5.attrs["product"] == "source"


def test_each_of_240_damaged_files_is_found_before_hdf5_opens_it(written, monkeypatch):
    whole, draw = written.read_bytes(), random.Random(1)
    monkeypatch.setattr(h5py, "File", lambda *_, **__: pytest.fail("opened"))
    for k in range(240):
        place, content = draw.randrange(len(whole)), bytearray(whole)
        if k % 3 == 0:
            content[place] ^= 1 << draw.randrange(8)
        elif k % 3 == 1:
            del content[place:]
        else:
            content[place:place + 64] = bytes(b ^ 0xFF for b in content[place:place + 64])
        written.write_bytes(content)
        assert checksum.flaw(written) in (checksum.WRONG, checksum.MISSING)
        assert store.identity(written) is None
        with pytest.raises(ProductError, match="truncated or damaged file"):
            store.read(Source, written)


def test_an_edited_number_is_found(written):
    with h5py.File(written, "a") as h5:
        h5["data/signal"][0, 0] = 7.0
    assert checksum.flaw(written) == checksum.MISSING

"""Products on disk: round trip, identity, damage."""

import os
from pathlib import Path

import h5py
import numpy as np
import pytest

from pipeline.cli.inspect import describe
from pipeline.contract import ProductError, store
from pipeline.contract.integrity import checksum
from pipeline.contract.mapped import map_of
from pipeline.products import FrictionMap, Surface
from tests.contract.test_product import GOOD
from tests.contract.toy.products import Doubled, Inner, Shelf, Source


@pytest.fixture
def written(tmp_path):
    path = tmp_path / "source.h5"
    store.write(Source(**GOOD), path, {"stage": "source"})
    return path


def test_round_trip(written):
    back = store.read(Source, written)
    assert store.content_hash(back) == store.content_hash(Source(**GOOD)) == store.identity(written)[2]
    assert list(back.label) == ["a"] and back.inner.position.shape == (2, 3) and back.root[0] == 1j
    assert store.provenance(written) == {"stage": "source"} and not list(written.parent.glob(".*"))


def test_parts_come_back_by_name_and_order_counts_for_nothing(tmp_path):
    first, last = (Inner(position=np.full((n, 3), float(n))) for n in (2, 5))
    path = tmp_path / "shelf.h5"
    store.write(Shelf(points={"b": last, "a.1": first}), path, {})
    back = store.read(Shelf, path)
    assert list(back.points) == ["b", "a.1"] and np.array_equal(back.points["b"].position, last.position)
    assert store.content_hash(back) == store.content_hash(Shelf(points={"a.1": first, "b": last}))
    assert store.content_hash(back) != store.content_hash(Shelf(points={"a.1": last, "b": first}))
    assert store.content_hash(Shelf(points={})) != store.content_hash(Shelf(points={"a": first}))


def test_content_hash_sees_values_and_not_provenance(tmp_path, written):
    other = tmp_path / "other.h5"
    store.write(Source(**GOOD), other, {"stage": "elsewhere"})
    assert store.identity(other) == store.identity(written)
    assert store.content_hash(Source(**{**GOOD, "scale": 2.0})) != store.identity(written)[2]
    assert store.content_hash(Source(**{**GOOD, "label": ["b"]})) != store.identity(written)[2]


def test_xarray_sees_named_dimensions_and_units(written):
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(written, engine="h5netcdf", group="data") as data:
        assert data.signal.dims == ("channel", "time") and data.signal.attrs["units"] == "Pa"
        np.testing.assert_array_equal(data.time, [0.0, 1.0])


def test_refuses_another_product_and_version(written):
    with pytest.raises(ProductError, match="expected doubled version 1, found source version 1"):
        store.read(Doubled, written)
    with h5py.File(written, "a") as h5:
        h5.attrs["version"] = 99
    checksum.seal(written)
    with pytest.raises(ProductError, match="expected source version 1, found source version 99; rerun"):
        store.read(Source, written)


def test_refuses_another_unit(written):
    with h5py.File(written, "a") as h5:
        h5["data/signal"].attrs["units"] = "bar"
    checksum.seal(written)
    with pytest.raises(ProductError, match="signal: expected units Pa, found bar"):
        store.read(Source, written)


def test_refuses_truncated_changed_or_missing_files(written):
    whole = written.read_bytes()
    with h5py.File(written, "a") as h5:
        h5["data/signal"][0, 0] = 7.0
    with pytest.raises(ProductError, match="no checksum at its end"):
        store.read(Source, written)
    written.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ProductError, match="truncated or damaged"):
        store.read(Source, written)
    written.unlink()
    with pytest.raises(ProductError, match="expected the product source, found no file; run 'brakechain source' first"):
        store.read(Source, written)


@pytest.mark.parametrize("error", [KeyError("bad object header"), RuntimeError("no link"), ValueError("shape"),
                                   TypeError("class"), AttributeError("asstr"), MemoryError("1e19 bytes")])
def test_whatever_damaged_bytes_raise_is_told_as_damage(written, monkeypatch, error):
    def damaged(*_):
        raise error

    monkeypatch.setattr(store, "_read_group", damaged)
    with pytest.raises(store.DamagedFile, match="truncated or damaged"):
        store.read(Source, written)
    with pytest.raises(store.DamagedFile), store.damage_told(written):
        raise error
    with pytest.raises(ProductError, match="units") as told, store.damage_told(written):
        raise ProductError("signal", "units Pa", "bar")
    assert not isinstance(told.value, store.DamagedFile)


@pytest.mark.measured
@pytest.mark.parametrize("name", ["product_friction_map.h5", "product_surface.h5"])
def test_damaged_products_of_others_give_one_sentence(name):
    path = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "hostile" / name
    with pytest.raises(ProductError, match="truncated or damaged file .*; rerun the stage"):
        list(describe(path))
    with pytest.raises(ProductError):
        store.read(FrictionMap if "map" in name else Surface, path)


def test_large_arrays_stay_in_the_file(tmp_path):
    position, path = np.arange(300_000.0).reshape(-1, 3), tmp_path / "inner.h5"
    store.write(Inner(position=position), path, {})
    back, whole = store.read(Inner, path), store.read(Inner, path, whole=True)
    assert map_of(back.position).path == str(path) and map_of(whole.position) is None
    for item in (back, whole):
        np.testing.assert_array_equal(item.position, position)
        assert store.content_hash(item) == store.content_hash(Inner(position=position)) and item.position.flags.aligned
    assert Inner(position=back.position).position is back.position
    store.write(back, path, {})         # onto the file that it is a map of
    np.testing.assert_array_equal(store.read(Inner, path).position, position)
    content = path.read_bytes()
    path.write_bytes(content[:len(content) // 2])
    with pytest.raises(ProductError, match="truncated or damaged"):
        store.read(Inner, path)


def test_an_interrupted_write_leaves_the_old_product(written, monkeypatch):
    before = written.read_bytes()
    monkeypatch.setattr(store, "_write_group", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        store.write(Source(**{**GOOD, "scale": 3.0}), written, {})
    assert written.read_bytes() == before


def test_a_product_that_was_damaged_and_sealed_again_ends_with_the_process_that_shows_it(written, monkeypatch):
    """Its checksum is right; what HDF5 does not survive is one sentence, and so is what it stumbles over."""
    content = written.read_bytes()
    where = content.index(b"TREE")
    written.write_bytes(content[:where] + bytes(64) + content[where + 64:len(content) - checksum._BEHIND])
    checksum.seal(written)
    with pytest.raises(ProductError, match="truncated or damaged|stops its reader"):
        describe(written)

"""Products on disk: one HDF5 file each, atomic, versioned, with provenance. The door of h5py.

Layout: root attributes ``product``, ``version``, ``content``; datasets under ``/data`` (nested
products are groups) with ``units`` and ``long_name`` and dimension scales in the netCDF-4 manner,
so that xarray (engine h5netcdf, group "data") sees named dimensions; ``/provenance`` attributes.
"""

import errno
import hashlib
import os
from contextlib import contextmanager, suppress
from dataclasses import fields
from pathlib import Path

import h5py

from pipeline.contract.errors import ProductError
from pipeline.contract.integrity import checksum, examined, seen
from pipeline.contract.mapped import LARGE, blocks, mapped, opened
from pipeline.contract.product import held_by, is_product
from pipeline.contract.received import files, hdf5


class DamagedFile(ProductError):
    """An HDF5 file that is truncated or damaged."""


#: characters shown of what a library says
_LONGEST = 200
#: what h5py and numpy raise of damaged bytes
_DAMAGE = (KeyError, OSError, RuntimeError, TypeError, ValueError, AttributeError, MemoryError)
#: large arrays begin at multiples of so many bytes, where they can be mapped
_PAGE = 4096
_NO_COORDINATE = "This is a netCDF dimension but not a netCDF variable."


def content_hash(item):
    """SHA-256 of names, units, version and values; blind to provenance."""
    digest = hashlib.sha256(f"{item.name}/{item.version}".encode())
    for f in fields(item):
        value = getattr(item, f.name)
        if is_product(f.type):
            digest.update(f"{f.name}/{content_hash(value)}".encode())
            continue
        if held_by(f.type):
            digest.update("".join(f"{f.name}/{name}/{content_hash(value[name])}/" for name in sorted(value)).encode())
            continue
        digest.update(f"{f.name}/{f.metadata['unit']}/{value.dtype.str}/{value.shape}".encode())
        for part in ("\0".join(value.flat).encode(),) if value.dtype.kind == "O" else blocks(value):
            digest.update(part)
    return digest.hexdigest()


def write(item, path, provenance, content=None):
    """Write ``item`` to ``path`` completely or not at all: temporary name, checksum, sync, rename."""

    def fill(partial):
        with h5py.File(files.cleared(partial), "x", track_order=True, alignment_threshold=LARGE,
                       alignment_interval=_PAGE) as h5:
            h5.attrs.update(product=item.name, version=item.version, content=content or content_hash(item))
            _write_group(h5.create_group("data", track_order=True), item)
            h5.create_group("provenance").attrs.update(provenance)
        checksum.seal(partial)

    _whole(Path(path), fill)
    examined.trust(path)


def write_companion(path, content):
    """Write text or bytes beside a product, completely or not at all."""
    content = content.encode() if isinstance(content, str) else content
    _whole(Path(path), lambda partial: files.write_new(partial, content))


@contextmanager
def new_hdf5(path):
    """A new HDF5 file of another layout than that of products, open to be written; none stays where that fails."""
    path = Path(path)
    partial = path.with_name(f".{path.name}.partial")
    try:
        with h5py.File(files.cleared(partial), "x") as h5:
            yield h5
        publish(partial, path)
    except (OSError, RuntimeError) as error:
        raise _unwritable(path, error) from error
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def _whole(path, fill):
    """Publish what ``fill`` writes to a temporary name; nothing of it stays where that fails."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        fill(partial)
        publish(partial, path)
    except (OSError, RuntimeError) as error:        # h5py raises the latter where it cannot write its last bytes
        raise _unwritable(path, error) from error
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def publish(partial, path):
    """Sync the finished ``partial`` file and give it its name."""
    with open(partial, "rb") as stream:
        os.fsync(stream.fileno())
    os.replace(partial, path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def _write_group(group, item):
    scales = {}
    for f in fields(item):
        value = getattr(item, f.name)
        if is_product(f.type):
            _write_part(group, f.name, value, f.metadata["meaning"])
            continue
        if held_by(f.type):
            inner = group.create_group(f.name, track_order=True)
            inner.attrs.update(long_name=f.metadata["meaning"])
            for name, each in value.items():
                _write_part(inner, name, each, held_by(f.type).__doc__)
            continue
        dataset = _write_array(group, f.name, value)
        dataset.attrs.update(units=f.metadata["unit"], long_name=f.metadata["meaning"])
        if f.metadata["dims"] == (f.name,):
            dataset.make_scale(f.name)
            scales[f.name] = dataset
    for f in fields(item):
        if "dims" in f.metadata:
            _attach_dimensions(group, f, scales)


def _write_array(group, name, value):
    if value.dtype.kind == "O" or value.nbytes < LARGE:
        return group.create_dataset(name, data=value, dtype=h5py.string_dtype() if value.dtype.kind == "O" else None)
    dataset, first = group.create_dataset(name, value.shape, value.dtype), 0
    for part in blocks(value):
        dataset[first:first + len(part)] = part
        first += len(part)
    return dataset


def _write_part(group, name, item, meaning):
    inner = group.create_group(name, track_order=True)
    inner.attrs.update(product=item.name, version=item.version, long_name=meaning)
    _write_group(inner, item)


def _attach_dimensions(group, f, scales):
    dataset = group[f.name]
    for axis, dim in enumerate(f.metadata["dims"]):
        if dim == f.name:
            continue
        if dim not in scales:
            scales[dim] = group.create_dataset(dim, shape=(dataset.shape[axis],), dtype="f4")
            scales[dim].make_scale(f"{_NO_COORDINATE}{dataset.shape[axis]:10d}")
        dataset.dims[axis].attach_scale(scales[dim])


def read(cls, path, whole=False):
    """Read a ``cls`` back; refuses another product, version or unit, and a damaged file.

    Large arrays stay in the file, which is mapped; ``whole``: all are read into memory.
    """
    with _opened(path, checksum.flaw) as h5:
        _check_identity(h5, cls, path)
        return _read_group(_member(h5, "data", path), cls, path, None if whole else opened(path))


def identity(path):
    """(product, version, content hash) of a file, or None where there is none or a damaged one."""
    if not Path(path).exists():
        return None
    try:
        with _opened(path, seen.flaw) as h5:
            return tuple(h5.attrs[k] for k in ("product", "version", "content"))
    except DamagedFile:
        return None


def provenance(path):
    """The provenance attributes of a product file, as a dict."""
    with _opened(path, seen.flaw) as h5:
        return dict(h5["provenance"].attrs)


@contextmanager
def _opened(path, flaw):
    """The open file; what is raised of damaged bytes while it is read says so.

    ``flaw(path)``: what is wrong with the bytes of the file, before HDF5 sees any: it may not survive them.
    """
    with _file(path, flaw) as h5, damage_told(path):
        yield h5


@contextmanager
def damage_told(path):
    """Whatever h5py raises of damaged bytes of the file at ``path`` as DamagedFile."""
    try:
        yield
    except _DAMAGE as error:
        raise _damaged(path, error) from None


def _file(path, flaw):
    if not Path(path).exists():
        product = Path(path).stem
        command = f"brakechain {product.replace('_', '-')}"
        raise ProductError(path, f"the product {product}", "no file", f"run '{command}' first")
    try:
        told = flaw(path) or examined.flaw(path)
        if told:
            raise _damaged(path, told)
        return h5py.File(path, "r")
    except (PermissionError, BlockingIOError) as error:
        raise ProductError(path, "a file that can be read", error.strerror or str(error),
                           "check its permissions, and that no other program writes it") from None
    except OSError as error:
        raise _damaged(path, error) from None


def _unwritable(path, error):
    number = getattr(error, "errno", None)
    if number in (errno.ENOSPC, errno.EDQUOT):
        return ProductError(path, "a file that can be written", "a full disk",
                            "free space, then run the same command again: finished stages are kept")
    return ProductError(path, "a file that can be written", os.strerror(number) if number else str(error),
                        "check space and permissions")


def _damaged(path, error):
    told = " ".join(str(error).split())[:_LONGEST]
    return DamagedFile(path, "a complete HDF5 product", f"a truncated or damaged file ({told})",
                       "rerun the stage that writes it")


def _check_identity(h5, cls, path):
    name, version = h5.attrs.get("product"), h5.attrs.get("version")
    if (name, version) != (cls.name, cls.version):
        content = f"{name} version {version}" if name else "a file without product name"
        raise ProductError(path, f"{cls.name} version {cls.version}", content, "rerun the stage that writes it")


def _read_group(group, cls, path, file):
    values = {}
    for f in fields(cls):
        if is_product(f.type):
            values[f.name] = _read_group(_member(group, f.name, path), f.type, path, file)
            continue
        if held_by(f.type):
            inner = _member(group, f.name, path)
            values[f.name] = {name: _read_group(_member(inner, name, path), held_by(f.type), path, file)
                              for name in inner}
            continue
        dataset = _member(group, f.name, path)
        if dataset.attrs["units"] != f.metadata["unit"]:
            raise ProductError(f"{path}: {f.name}", f"units {f.metadata['unit']}", dataset.attrs["units"])
        is_text = h5py.check_string_dtype(dataset.dtype) is not None
        values[f.name] = dataset.asstr()[()] if is_text else _array(dataset, file)
    return cls(**values)


def _member(group, name, path):
    """The member ``name`` of a group; refused where it takes its data from elsewhere."""
    told = hdf5.flaw(group, name)
    if told:
        raise _damaged(path, f"{name}: {told}")
    return group[name]


def _array(dataset, file):
    """The array of a dataset: a large one where it lies in ``file``, the FileMap of its file, if any."""
    offset, dtype = dataset.id.get_offset(), dataset.dtype
    if file is None or dataset.nbytes < LARGE or not offset or offset % dtype.alignment or not dtype.isnative:
        return dataset[()]
    return mapped(file, dtype, dataset.shape, offset)


def walk(path):
    """Yield (name, attributes, dataset or None) for every group and dataset of a product file; refuses others."""
    with _opened(path, checksum.flaw) as h5:
        if "product" not in h5.attrs:
            raise ProductError(path, "a product of brakechain", "an HDF5 file without product name",
                               "for recordings see 'brakechain data format'")
        yield "/", dict(h5.attrs), None
        rows = []
        hdf5.refuse_outside(h5, path)
        h5["data"].visititems(lambda name, node: rows.append((f"data/{name}", node)))
        for name, node in rows:
            is_array = isinstance(node, h5py.Dataset)
            yield name, dict(node.attrs), node if is_array else None
        yield "provenance", dict(h5["provenance"].attrs), None


def dimensions(dataset):
    """Names of the dimensions of a dataset of a product file."""
    return [scale[0].name.rpartition("/")[2] if len(scale) else "" for scale in dataset.dims]


def is_placeholder(dataset):
    """True for the scale of a dimension that has no coordinate values."""
    name = dataset.attrs.get("NAME", b"")
    return (name if isinstance(name, str) else name.decode()).startswith(_NO_COORDINATE)

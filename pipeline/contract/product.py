"""A data product: a frozen bundle of arrays with named dimensions and SI units."""

import re
from dataclasses import dataclass, field, fields
from typing import get_args, get_origin

import numpy as np

from pipeline.contract.errors import ProductError
from pipeline.contract.mapped import blocks, map_of, sent
from pipeline.contract.received.names import EXPECTED, is_name
from pipeline.contract.units import SI

Array = np.ndarray


def quantity(unit, dims, meaning, dtype=float, narrow=False):
    """Declare one array: SI unit, space-separated dimension names ("" = scalar), meaning.

    ``narrow``: float32 stays float32, the precision of the file that it comes from.
    """
    if unit not in SI:
        raise ProductError(f"unit {unit!r} is not in the SI vocabulary of units.py")
    return field(metadata={"unit": unit, "dims": tuple(dims.split()), "meaning": meaning,
                           "dtype": np.dtype(dtype), "narrow": narrow})


def count(dims, meaning):
    """Declare one array of whole numbers (indices, counts, flags 0/1)."""
    return quantity("1", dims, meaning, np.int64)


def text(dims, meaning, empty=False):
    """Declare one array of strings (names, notes); ``empty``: a list of them, without any where none are given."""
    one = quantity("1", dims, meaning, str)
    return field(default=(), metadata=one.metadata) if empty else one


def part(meaning):
    """Declare a nested product; its class is the annotation of the field."""
    return field(metadata={"meaning": meaning})


def parts(meaning, empty=False):
    """Declare nested products by name; the annotation of the field is ``dict[str, Product]``.

    ``empty``: there are none where none are given; else a product without them is refused.
    """
    return field(default_factory=dict, metadata={"meaning": meaning}) if empty else part(meaning)


def held_by(hint):
    """The product class of a field annotated ``dict[str, Product]``, else None."""
    inner = get_args(hint)[-1] if get_origin(hint) is dict else None
    return inner if is_product(inner) else None


def is_product(cls):
    """True for a class made by ``@product``."""
    return isinstance(cls, type) and "version" in cls.__dict__ and "name" in cls.__dict__


def snake(name):
    """'ReducedModel' -> 'reduced_model'."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def product(version):
    """Class decorator: freeze, name, version and validate a data product.

    Arrays become read-only. A product refuses shapes whose named dimensions
    disagree, a dtype that does not fit and values that are not finite.
    """

    def decorate(cls):
        cls.__post_init__, cls.__getstate__ = _validate, _state
        cls = dataclass(frozen=True, eq=False, kw_only=True)(cls)
        _check_names(cls)
        cls.name, cls.version = snake(cls.__name__), version
        return cls

    return decorate


def _check_names(cls):
    """A field may carry the name of a dimension only as its coordinate (HDF5 dimension scale)."""
    plain = {f.name: f.metadata.get("dims") for f in fields(cls)}
    if plain.keys() & {"name", "version"}:
        raise ProductError(f"product {cls.__name__}", "no field called 'name' or 'version'", "one", "rename it")
    for dim in {d for dims in plain.values() for d in dims or ()}:
        if dim in plain and plain[dim] != (dim,):
            raise ProductError(f"{snake(cls.__name__)}.{dim}", f"the 1-D coordinate of dimension '{dim}'",
                                   f"dimensions {plain[dim]}")


def _state(self):
    """What is pickled: arrays in files of products stay there."""
    return {name: sent(value) for name, value in self.__dict__.items()}


def _validate(self):
    sizes = {}
    for f in fields(self):
        where = f"{self.name}.{f.name}"
        value = getattr(self, f.name)
        if is_product(f.type):
            _check_part(value, f.type, where)
            continue
        if held_by(f.type):
            object.__setattr__(self, f.name, _as_parts(value, held_by(f.type), where))
            continue
        dtype = np.dtype(np.float32) if f.metadata["narrow"] and _narrow(value) else f.metadata["dtype"]
        array = _as_array(value, dtype, where)
        _check_dimensions(array, f.metadata["dims"], sizes, where)
        strange = sum(part.size - np.isfinite(part).sum() for part in blocks(array)) if array.dtype.kind in "fc" else 0
        if strange:
            raise ProductError(where, "finite values", f"{strange} that are not")
        object.__setattr__(self, f.name, array)


def _narrow(value):
    return isinstance(value, np.ndarray) and value.dtype == np.float32


def _check_part(value, cls, where):
    if not isinstance(value, cls):
        raise ProductError(where, f"a {cls.name}", type(value).__name__)


def _as_parts(value, cls, where):
    if not isinstance(value, dict):
        raise ProductError(where, f"a mapping of names to {cls.name}", type(value).__name__)
    for name, inner in value.items():
        if not is_name(name):
            raise ProductError(f"{where}: a name", EXPECTED, repr(name))
        _check_part(inner, cls, f"{where}.{name}")
    return dict(value)


def _as_array(value, dtype, where):
    if dtype.kind == "U":
        array = np.array(value, dtype=object)
        wrong = [v for v in array.flat if not isinstance(v, str)]
        if wrong:
            raise ProductError(where, "strings", repr(wrong[0]))
    else:
        array = np.asarray(value)
        if array.size == 0 or array.dtype.kind == "b":
            array = array.astype(dtype)
        if not np.can_cast(array.dtype, dtype, "same_kind"):
            raise ProductError(where, str(dtype), str(array.dtype))
        if array.dtype == dtype and array.flags.c_contiguous and _fixed(array):
            return array
        array = np.array(array, dtype=dtype, order="C")
    array.setflags(write=False)
    return array


def _fixed(array):
    """Whether nothing can write to an array: neither to itself nor to what it is a view of, as that of a product."""
    if map_of(array) is not None:
        return True
    while isinstance(array, np.ndarray):
        if array.flags.writeable:
            return False
        array = array.base
    return array is None


def _check_dimensions(array, dims, sizes, where):
    if array.ndim != len(dims):
        raise ProductError(where, f"dimensions {dims}", f"shape {array.shape}")
    for dim, size in zip(dims, array.shape, strict=True):
        if sizes.setdefault(dim, size) != size:
            raise ProductError(where, f"{sizes[dim]} along '{dim}' as in the fields before", f"{size}")

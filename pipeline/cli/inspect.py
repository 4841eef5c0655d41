"""The output of 'brakechain inspect' for a product file."""

import json
from pathlib import Path

import numpy as np

from pipeline.contract import store
from pipeline.contract.errors import ConfigError, ProductError
from pipeline.contract.received.process import answered

_LINES = "lines.txt"

_LONG = 90


def describe(path):
    """Lines: identity, tree with dimensions, units and ranges, provenance. Raises ProductError of a damaged file.

    The file is read in a process of its own: the checksum of one that came from elsewhere may be right, and HDF5 not
    survive what is before it.
    """
    if not Path(path).is_file():
        return list(_lines(path))       # says what is wrong with it
    try:
        return answered(f"{__name__}:leave", path, lambda folder: (folder / _LINES).read_text("utf-8").splitlines())
    except ConfigError as error:
        raise ProductError(error.where, error.expected, error.found, error.remedy) from None


def leave(path, folder):
    """In the child process: write the lines to ``folder``."""
    with store.damage_told(path):
        (Path(folder) / _LINES).write_text("\n".join(_lines(path)), "utf-8")


def _lines(path):
    for name, attributes, dataset in store.walk(path):
        if name == "/":
            yield f"{path}: {attributes['product']} version {attributes['version']}"
            yield f"content {attributes['content']}"
            yield ""
        elif name == "provenance":
            yield ""
            yield from _provenance(attributes)
        elif dataset is None:
            yield f"{_indent(name)}{_leaf(name)}/   {attributes.get('long_name', '')}"
        elif not store.is_placeholder(dataset):
            yield _line(name, attributes, dataset)


def _line(name, attributes, dataset):
    sizes = ", ".join(f"{d}: {n}" for d, n in zip(store.dimensions(dataset), dataset.shape, strict=True))
    unit = "" if attributes["units"] == "1" else f" {attributes['units']}"
    label = f"{_indent(name)}{_leaf(name)}" + (f" ({sizes})" if sizes else "")
    return f"{label:<56} {_range(dataset)}{unit}   {attributes['long_name']}"


def _range(dataset):
    if dataset.size == 0:
        return "empty"
    if dataset.dtype.kind == "O":
        flat = [str(v) for v in np.ravel(dataset.asstr()[()])]
        text = ", ".join(flat)
        return text if len(text) <= _LONG and "\n" not in text else f"{len(flat)} strings, {len(text)} characters"
    values = dataset[()]
    if values.dtype.kind == "c":
        return f"|.| {abs(values).min():.6g} .. {abs(values).max():.6g}"
    low, high = values.min(), values.max()
    return f"{low:.6g}" if low == high else f"{low:.6g} .. {high:.6g}"


def _provenance(attributes):
    yield "provenance"
    for key, value in attributes.items():
        if isinstance(value, str) and value[:1] in "{[":
            yield f"  {key}"
            document = json.loads(value)
            pairs = document.items() if isinstance(document, dict) else enumerate(document)
            yield from (f"    {k}: {_short(v)}" for k, v in pairs)
        else:
            yield f"  {key}: {value}"


def _short(value):
    text = json.dumps(value) if isinstance(value, (dict, list)) else str(value)
    return text if len(text) <= 2 * _LONG else f"{text[:2 * _LONG]} ..."


def _indent(name):
    return "  " * (name.count("/") - 1)


def _leaf(name):
    return name.rpartition("/")[2]

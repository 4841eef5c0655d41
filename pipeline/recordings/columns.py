"""Files of named columns: MATLAB and plain HDF5; text tables are written here, and read in ``tables``."""

import csv
import struct
from io import BytesIO
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.hdf5 import flaw, flaw_of, refuse_outside
from pipeline.recordings.tables.matrices import time_axes, vectors
from pipeline.recordings.tables.text import read_table
from pipeline.recordings.waveform import Waveform


def read_columns(path):
    """Name -> 1-D array of a file: MATLAB (.mat), HDF5 with vectors at its root (.h5, .hdf5), else a text table.

    Raises ConfigError for anything else.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind == ".mat":
        return read_matlab(path)
    if kind not in (".h5", ".hdf5"):
        return read_table(path)
    return vectors(_read_hdf5(path, "an HDF5 file"), path, base=0)


def read_matlab(path):
    """Name -> 1-D array of every numeric variable of a MATLAB file, version 4 to 7.3; vectors lose their second axis.

    Columns of a matrix are x(:,1), x(:,2), ..., its rows x(1,:), ... where these are longer; cells of a cell array
    x{1}, x{2}, ..., fields of a structure s.name, of an array of structures s(1).name.
    Raises ConfigError for a file that is not a MATLAB file, is truncated or holds no numbers.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ConfigError(path, "a readable MATLAB file", str(error)) from None
    if content.startswith(b"MATLAB 7.3 MAT-file"):
        found = _read_hdf5(path, "a MATLAB file of version 7.3")
        return vectors({name: np.transpose(value) for name, value in found.items()}, path)
    return vectors(_decoded(content, path), path)


def matlab_waveforms(path):
    """Name -> Waveform of what ``read_matlab`` reads, with the rate and begin that structures of Testlab state."""
    columns = read_matlab(path)
    axes = time_axes(columns)
    return {name: Waveform(values, "", *axes.get(name, (None, 0.0))) for name, values in columns.items()}


def _decoded(content, path):
    """Variables of a MATLAB file of version 4 to 7; a truncated or damaged file is refused."""
    from scipy.io import loadmat

    if 0 not in content[:4]:        # version 4 begins with a small number, later ones with text
        byte_order = {b"IM": "<", b"MI": ">"}.get(content[126:128])
        if not byte_order:
            raise ConfigError(path, "a MATLAB file", "another kind of file, or none")
        if not _whole(content, byte_order):
            raise ConfigError(path, "a whole MATLAB file", "one that is cut off", "copy it again")
    try:
        found = loadmat(BytesIO(content)).items()
        return {name: part for k, v in found if not k.startswith("__") for name, part in _leaves(k, v)}
    except Exception as error:  # loadmat passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged MATLAB file", str(error) or type(error).__name__) from None


def _leaves(name, value):
    """[(name, array)] of the parts of a variable as loadmat returns it: cells and structures are opened."""
    if hasattr(value, "classname") or (value.dtype.names and set(value.dtype.names) == {"s0", "s1", "s2", "arr"}):
        return [(name, np.empty(0, "U1"))]     # a timetable, a table or another object: loadmat cannot open it
    if value.dtype.names:
        count = value.size
        return [leaf for k, item in enumerate(value.ravel()) for field in value.dtype.names
                for leaf in _leaves(f"{name}{f'({k + 1})' if count > 1 else ''}.{field}", item[field])]
    if value.dtype == object:
        return [leaf for k, item in enumerate(value.ravel(order="F")) for leaf in _leaves(f"{name}{{{k + 1}}}", item)]
    return [(name, value)]


def _whole(content, byte_order):
    """True where the elements behind the head of 128 bytes end with the file (MathWorks, MAT-File Format, level 5)."""
    end = 128
    while end + 8 <= len(content):
        end += 8 + struct.unpack_from(f"{byte_order}I", content, end + 4)[0]
    return end == len(content)


def _read_hdf5(path, expected):
    import h5py

    try:
        with h5py.File(path, "r") as h5:
            refuse_outside(h5, path)
            return {name: value for key, node in h5.items() if key != "#refs#" for name, value in _nodes(key, node)}
    except OSError as error:
        raise ConfigError(path, expected, str(error)) from None


def _nodes(name, node):
    """[(name, array)] of a node: the structures and cells of MATLAB 7.3 are groups and references."""
    import h5py

    if isinstance(node, h5py.Group):
        for key in node:        # a group that only a reference leads to was not looked through
            _refuse(flaw(node, key), node)
        return [leaf for key, inner in node.items() for leaf in _nodes(f"{name}.{key}", inner)]
    _refuse(flaw_of(node), node)
    if node.attrs.get("MATLAB_class") == b"char" or "MATLAB_empty" in node.attrs:
        return []
    if h5py.check_ref_dtype(node.dtype):
        cells = enumerate(node[()].T.ravel(order="F"))
        return [leaf for k, cell in cells if cell for leaf in _nodes(f"{name}{{{k + 1}}}", node.file[cell])]
    return [(name, node[()])]


def _refuse(told, node):
    if told:
        raise ConfigError(f"{node.file.filename}: {node.name or 'a cell'}", "data of this file", told)


def write_table(path, channels):
    """Write {name: Channel} of one rate, length and begin as a text table with a column ``time`` in s; missing samples
    stay empty. Raises ConfigError for unlike ones."""
    rates = {(float(c.rate), float(c.begin), len(c.samples)) for c in channels.values()}
    if len(rates) != 1:
        raise ConfigError(path, "channels of one rate, begin and length", f"{len(rates)}", "choose some of them")
    (rate, begin, count), = rates
    table = np.column_stack([c.samples for c in channels.values()])
    gap = np.zeros(table.shape, bool)
    for k, one in enumerate(channels.values()):
        for first, last in one.missing:
            gap[first:last, k] = True
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *channels])
        writer.writerows([repr(begin + k / rate), *("" if lost else repr(float(value)) for value, lost in
                                                    zip(table[k], gap[k], strict=True))] for k in range(count))

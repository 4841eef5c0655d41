"""Files of named columns: MATLAB, plain HDF5 and text tables."""

import csv
import re
import struct
from io import BytesIO
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.hdf5 import flaw, flaw_of, refuse_outside

#: text in a table that stands for a missing sample
_NUMBER = re.compile(r"\s*[-+]?((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|inf|Inf|INF)\s*")
#: a unit in its own row; a number with a decimal comma; what ends the head of a LabVIEW measurement, and where it is
#: sought
_UNIT = re.compile(r"[\[(]([^\])]*)[\])]")
_COMMA = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*")
_LABVIEW, _HEAD = "***End_of_Header***", 100
MISSING = frozenset({"", "nan", "na", "n/a", "none", "null", "-"})


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
    return _vectors(_read_hdf5(path, "an HDF5 file"), path)


def read_matlab(path):
    """Name -> 1-D array of every numeric variable of a MATLAB file, version 4 to 7.3; vectors lose their second axis.

    Cells of a cell array are x{1}, x{2}, ..., fields of a structure s.name, of an array of structures s(1).name.
    Raises ConfigError for a file that is not a MATLAB file, is truncated or holds no numbers.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ConfigError(path, "a readable MATLAB file", str(error)) from None
    if content.startswith(b"MATLAB 7.3 MAT-file"):
        return _vectors(_read_hdf5(path, "a MATLAB file of version 7.3"), path)
    return _vectors(_decoded(content, path), path)


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


def _vectors(variables, path):
    """Those of the ``variables`` that are vectors of numbers."""
    numeric = {k: np.asarray(v) for k, v in variables.items() if np.asarray(v).dtype.kind in "fiub"}
    flat = {k: v for k, v in numeric.items() if v.ndim < 2 or (v.ndim == 2 and 1 in v.shape)}
    columns = {k: v.astype(float).ravel() for k, v in flat.items()}
    if not columns:
        raise ConfigError(path, "a vector of numbers", f"{', '.join(variables) or 'no variables'}")
    return columns


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
    if h5py.check_ref_dtype(node.dtype):
        cells = enumerate(node[()].T.ravel(order="F"))
        return [leaf for k, cell in cells if cell for leaf in _nodes(f"{name}{{{k + 1}}}", node.file[cell])]
    return [(name, node[()])]


def _refuse(told, node):
    if told:
        raise ConfigError(f"{node.file.filename}: {node.name or 'a cell'}", "data of this file", told)


def read_table(path, delimiter=None, skip=0):
    """Column name -> 1-D array of a text table, NaN where a sample is missing; see ``table``."""
    return table(path, delimiter, skip)[0]


def table(path, delimiter=None, skip=0):
    """({column: 1-D array, NaN where a sample is missing}, {column: unit of a row in brackets}) of a text table.

    ``delimiter`` None: the first of tab, semicolon and comma that the header contains, else white space; ``skip``:
    lines before the header, those of a LabVIEW measurement left out by themselves. Decimals may follow a comma where no
    comma separates columns; text is UTF-8, UTF-16 or Windows-1252. Raises ConfigError with the line of a value that is
    not a number.
    """
    path = Path(path)
    content = _text(path)
    lines = content.splitlines()
    skip = max([skip, *(k + 1 for k, line in enumerate(lines[:_HEAD]) if line.startswith(_LABVIEW))])
    lines = lines[skip:]
    if len(lines) > 2 and not content.endswith(("\n", "\r")) and _shorter(lines):
        raise ConfigError(f"{path}:{skip + len(lines)}", "a last number as long as those above it, or a line break"
                          " behind it", repr(lines[-1][-20:]), "the file is cut off: copy it again")
    if len(lines) < 2:
        raise ConfigError(path, "a header and at least one line of numbers", f"{len(lines)} lines")
    lines[0] = re.sub(r"^[#%]\s*", "", lines[0])
    mark = delimiter or next((d for d in "\t;," if d in lines[0]), ",")
    if delimiter is None and mark not in lines[0] and len(lines[0].split()) == len(lines[1].split()) > 1:
        mark, lines = " ", [" ".join(line.split()) for line in lines]
    try:
        head, *rows = csv.reader(lines, delimiter=mark)
    except (csv.Error, TypeError) as error:
        raise ConfigError(path, f"a text table whose columns {mark!r} separates", str(error)) from None
    names = [name.strip() for name in head]
    if len(set(names)) < len(names):
        raise ConfigError(f"{path}:{skip + 1}", "each column name once", ", ".join(names))
    units = [_UNIT.fullmatch(text.strip()) for text in rows[0]]
    first = 1 if units and all(units) else 0
    while first < len(rows) - 1 and not any(text.strip() for text in rows[first]):
        first += 1
    if not names or first >= len(rows):
        raise ConfigError(path, "a head and rows of numbers below it", "none")
    names = names[:-1] if names[-1] == "Comment" and len(rows[first]) == len(names) - 1 else names
    comma = mark != "," and any(_COMMA.fullmatch(text) for text in rows[first]) and "." not in "".join(rows[first])
    values = np.full((len(rows) - first, len(names)), np.nan)
    for number, row in enumerate(rows[first:]):
        line = skip + first + number + 2
        if len(row) != len(names):
            raise ConfigError(f"{path}:{line}", f"{len(names)} values", f"{len(row)}")
        values[number] = [_number(text.replace(",", ".") if comma else text, path, line) for text in row]
    return dict(zip(names, values.T, strict=True)), {
        name: unit[1] for name, unit in zip(names, units, strict=False) if first and unit}


def _text(path):
    """The text of a file: UTF-16 by its mark, UTF-8, else Windows-1252 where it holds no control characters."""
    try:
        content = path.read_bytes()
        if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return content.decode("utf-16")
        try:
            return content.decode("utf-8-sig")
        except UnicodeDecodeError:
            if re.search(rb"[\x00-\x08\x0e-\x1f]", content):
                raise
            return content.decode("cp1252")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(path, "a readable text table", str(error)) from None


def _shorter(lines):
    """Whether a file that ends within a line ends with a number of fewer digits in all, or fewer decimals, than all
    others of its column."""
    ends = [re.split(r"[\t;, ]+", line.strip())[-1].lstrip("+-") for line in lines[1:]]
    return any(size(ends[-1]) < min(map(size, ends[:-1])) for size in (len, lambda end: len(end.partition(".")[2])))


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


def _number(text, path, line):
    if text.strip().lower() in MISSING:
        return np.nan
    if not _NUMBER.fullmatch(text):
        raise ConfigError(f"{path}:{line}", "a number", repr(text))
    return float(text)

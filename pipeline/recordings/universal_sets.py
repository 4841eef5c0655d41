"""The data sets of a universal file, found by what their heads declare and checked against what is there.

A binary data set (58b) is counted: its closing mark may follow the data at once, as the definition has it, or on a line
of its own, and its bytes may look like a mark.
"""

import re
from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError

#: the line that begins a data set, and the one that ends it
_MARK = re.compile(rb"    -1[ \t]*(\r\n|\r|\n|\Z)")
_BREAK = re.compile(rb"\r\n|\r|\n")
_CLOSING = re.compile(rb"(\r\n|\r|\n)    -1[ \t]*(\r\n|\r|\n|\Z)")
#: bytes of a value of each data type of data set 58: real and complex, of single and double precision
_SIZE = {2: 4, 4: 8, 5: 8, 6: 16}
#: data types of double precision, by those of single precision
_DOUBLE = {2: 4, 5: 6}
#: decades by which the sizes of numbers scatter where bytes are none
_APART = 5.0
_REMEDY = "copy it again"
#: lines of a binary data set before its data
_HEADS = 12


@dataclass(frozen=True)
class UniversalSet:
    """One data set: its number as 58, and its bytes between the marks. ``doubtful``: the last byte of its data may as
    well be the line break before the mark, a byte of the data being lost. ``remark``: what its head has wrong;
    ``type``: the data type that it should say, 0 where it says it."""

    kind: int
    body: bytes
    doubtful: bool = False
    remark: str = ""
    type: int = 0

    @property
    def file(self):
        """A universal file of this data set alone, marks on lines of their own."""
        heads, data = _split(self.body) if self.binary else (self.body, b"")
        if self.type:
            lines = heads.splitlines(keepends=True)
            heads = b"".join([*lines[:7], b"%10d" % self.type, lines[7][10:], *lines[8:]])
        return b"    -1\n" + _utf8(heads) + data + b"\n    -1\n"

    @property
    def binary(self):
        """Whether its data are bytes."""
        return self.body[6:7] in (b"b", b"B")


def _split(body):
    """(head lines, data) of a binary data set."""
    position = 0
    for _ in range(_HEADS):
        position = _BREAK.search(body, position).end()
    return body[:position], body[position:]


def _utf8(text):
    """Bytes of text that may be that of Windows, in UTF-8; columns stay where they are."""
    try:
        text.decode()
    except UnicodeDecodeError:
        return text.decode("cp1252", "replace").encode()
    return text


def universal_sets(content, path):
    """[UniversalSet] of the ``content`` of a universal file, in their order.

    Raises ConfigError, with ``path``, for content that is none, a data set that does not end, and a binary one that
    holds other than the bytes and points that it declares.
    """
    found, position = [], 0
    while (position := _next(content, position)) < len(content):
        where = f"{path}: data set {len(found) + 1}"
        mark = _MARK.match(content, position)
        if not mark:
            raise ConfigError(path if not found else where, "a universal file" if not found else "a data set, begun by"
                              " a line '    -1'", f"{content[position:position + 20]!r}",
                              *([] if not found else ["a data set before it has lost or gained bytes; " + _REMEDY]))
        head = content[mark.end():mark.end() + 80]
        if not head[:6].strip().isdigit():
            raise ConfigError(where, "the number of its kind, such as 58", f"{head[:6]!r}")
        end, position, *wrong = (_counted if head[6:7] in (b"b", b"B") else _marked)(content, mark.end(), where)
        body = content[mark.end():end]
        found.append(UniversalSet(int(head[:6]), body, head[6:7] in (b"b", b"B") and body.endswith(b"\n")
                                  and content[end:end + 6] == b"    -1", *wrong))
    if not found:
        raise ConfigError(path, "a universal file", "an empty one")
    return found


def _next(content, position):
    """Where the next line begins that is not empty."""
    while position < len(content):
        line = _BREAK.search(content, position)
        end = line.start() if line else len(content)
        if content[position:end].strip():
            break
        position = line.end() if line else len(content)
    return position


def _marked(content, begin, where):
    """(end, begin of the next) of a data set of text: at the first line that is a mark."""
    mark = _CLOSING.search(content, begin)
    if not mark:
        raise ConfigError(where, "a whole universal file", "one whose last data set does not end", _REMEDY)
    return mark.start(), mark.end()


def _counted(content, begin, where):
    """(end, begin of the next, and what the head has wrong, if anything) of a binary data set, by the points that its
    head declares: a number of bytes that disagrees with them is wrong where the closing mark stands behind those of the
    points, and so is a single precision where it stands behind those of a double one."""
    line = _BREAK.search(content, begin)
    fields = content[begin + 7:line.start() if line else begin].split()
    if len(fields) < 4 or not all(field.isdigit() for field in fields[:4]):
        raise ConfigError(where, "byte order, number format, lines and bytes of a binary data set",
                          f"{content[begin:begin + 43]!r}")
    position, heads = line.end(), []
    for _ in range(int(fields[2])):
        line = _BREAK.search(content, position)
        if not line:
            raise ConfigError(where, f"{int(fields[2])} lines before its data", f"{len(heads)}", _REMEDY)
        heads.append(content[position:line.start()])
        position = line.end()
    stated, (kind, declared) = int(fields[3]), _points(heads, where)
    for size in dict.fromkeys([*[stated] * (stated in declared), *declared]):
        mark = size and _mark_at(content, position + size)
        if mark:
            told = f"its head says {stated} bytes of data, its points are {size}: these are read"
            return position + size, mark.end(), told * (size != stated)
    for size in (2 * size for size in declared if kind in _DOUBLE):
        mark = _mark_at(content, position + size)
        if mark and _wild(content[position:position + size], fields[0]):
            return position + size, mark.end(), ("its head says single precision, its points are of double precision:"
                                                 " read as such"), _DOUBLE[kind]
    if stated not in declared:
        raise ConfigError(where, f"{declared[0]} bytes, those of the points that it declares", f"{stated}",
                          "the head of the data set is damaged: " + _REMEDY)
    end = position + stated
    if end > len(content):
        raise ConfigError(where, f"{stated} bytes of data", f"{len(content) - position}", _REMEDY)
    raise ConfigError(where, f"its end behind {stated} bytes of data", f"{content[end:end + 12]!r}",
                      "bytes were lost or added: " + _REMEDY)


def _wild(data, order):
    """Whether bytes are numbers of no common size in single precision, but of one in double precision."""
    sizes = [np.abs(np.frombuffer(data, f"{'<' if order == b'1' else '>'}f{width}")) for width in (4, 8)]
    single, double = (float(np.log10(some).std()) if np.isfinite(some).all() and some.size else np.inf
                      for some in (size[size != 0] for size in sizes))
    return single > _APART > double


def _mark_at(content, end):
    """The closing mark behind data that end at ``end``, at once or on a line of its own; None of none."""
    line = _BREAK.match(content, end)
    return _MARK.match(content, line.end() if line else end)


def _points(heads, where):
    """(data type, bytes that the points may take) of a binary data set 58, by its head lines: an uneven abscissa is of
    single precision by the definition, and of that of the ordinate as some programs write it."""
    fields = heads[6].split() if len(heads) > 6 else []
    try:
        kind, count, even = int(fields[0]), int(fields[1]), int(fields[2])
        size = _SIZE[kind]
    except (ValueError, IndexError, KeyError):
        raise ConfigError(where, "data type, points and spacing on the seventh line",
                          f"{heads[6][:40]!r}" if len(heads) > 6 else "none") from None
    return kind, [count * size] if even else [count * (size + 4), count * (size + 8)]

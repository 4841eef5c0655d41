"""Large arrays in files: mapped into memory, and gone through in blocks that are let go again.

A mapped array is a plain read-only array of numpy. What was touched of it counts as memory of the process until it is
let go, as ``blocks`` and ``Slices`` do: a record of any length then takes the memory of one block.
"""

import math
import mmap
import os
import tempfile
from contextlib import suppress
from functools import cache

import numpy as np

from pipeline.contract.errors import ProductError

#: arrays of so many bytes and more stay in files
LARGE = 1 << 20
#: bytes of a block
_BLOCK = 1 << 23


class FileMap(mmap.mmap):
    """A whole file, mapped to be read; ``path``: None where its name is gone; ``changed``: time of its last change."""

    path = changed = None


def opened(path, lasting=True):
    """The FileMap of the file at ``path``; not ``lasting``: the file is about to lose its name."""
    with open(path, "rb") as stream:
        return _of_stream(stream, path if lasting else None)


@cache
def _lift_limit():
    """A map holds its file open: let this process open as many files as it may."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


def _of_stream(stream, path):
    _lift_limit()
    file = FileMap(stream.fileno(), 0, access=mmap.ACCESS_READ)
    file.path, file.changed = path and str(path), os.fstat(stream.fileno()).st_mtime_ns
    return file


def mapped(file, dtype, shape, offset=0):
    """The array of this ``shape`` that begins ``offset`` bytes into a FileMap."""
    return np.frombuffer(file, dtype, math.prod(shape), offset).reshape(shape)


def map_of(array):
    """The FileMap that an array is a part of, or None."""
    while isinstance(array, np.ndarray):
        array = array.base
    source = array.obj if isinstance(array, memoryview) else None
    return source if isinstance(source, FileMap) else None


def blocks(array, size=None):
    """Consecutive parts of an array along its first axis, of ``size`` bytes; of one that is mapped none stays."""
    file, size = map_of(array), size or _BLOCK
    if array.ndim == 0 or (file is None and array.nbytes <= size):
        yield array
        return
    step = max(1, size * len(array) // max(array.nbytes, 1))
    for first in range(0, len(array), step):
        yield array[first:first + step]
        if file is not None:
            file.madvise(mmap.MADV_DONTNEED)


class Slices:
    """An array (sample,) of which slices are taken: of one that is mapped they are copies, and nothing of it stays."""

    def __init__(self, array):
        self._array, self._file = array, map_of(array)

    def __len__(self):
        return len(self._array)

    def __getitem__(self, part):
        if self._file is None:
            return self._array[part]
        values = np.array(self._array[part])
        self._file.madvise(mmap.MADV_DONTNEED)
        return values


class Growing:
    """An array (sample,) that grows by blocks, in memory while it is small, then in a file.

    ``folder``: where the file keeps its name; none = one without a name in the folder of temporary files (TMPDIR).
    """

    def __init__(self, dtype, folder=None):
        self.dtype, self._folder, self._parts, self._bytes = np.dtype(dtype), folder, [], 0
        self._stream = self._path = None

    def append(self, values):
        """Append ``values`` (n,)."""
        part = np.array(values, self.dtype)
        self._bytes += part.nbytes
        self._parts.append(part)
        if self._bytes >= LARGE:
            self._flush()

    def _flush(self):
        try:
            if self._stream is None:
                self._open()
            for part in self._parts:
                self._stream.write(part)
            self._stream.flush()
        except OSError as error:
            raise ProductError(self._folder or tempfile.gettempdir(), "room for the samples of a record", str(error),
                               "set TMPDIR to a folder with more") from error
        self._parts = []

    def _open(self):
        _lift_limit()
        if self._folder is None:
            self._stream = tempfile.TemporaryFile(prefix="brakechain-")   # noqa: SIM115
        else:
            number, self._path = tempfile.mkstemp(dir=self._folder)
            self._stream = os.fdopen(number, "w+b")

    def array(self):
        """The whole array, read-only."""
        if self._stream is None:
            whole = np.concatenate([np.empty(0, self.dtype), *self._parts])
            whole.setflags(write=False)
            return whole
        self._flush()
        with self._stream as stream:
            return mapped(_of_stream(stream, self._path), self.dtype, (self._bytes // self.dtype.itemsize,))


class Sent:
    """What goes to another process of this machine for an array in a file that has a name: where it is."""

    def __init__(self, array, file):
        begin = np.frombuffer(file, np.uint8, 1).ctypes.data
        self._where = file.path, file.changed, array.dtype, array.shape, array.ctypes.data - begin

    def __reduce__(self):
        return _found, self._where


def sent(value):
    """``value`` of a field of a product, or a Sent for it."""
    file = map_of(value)
    named = file is not None and file.path is not None and os.path.exists(file.path)
    return Sent(value, file) if named else value


def _found(path, changed, dtype, shape, offset):
    file = opened(path)
    if file.changed != changed:
        raise ProductError(path, "the file as it was opened", "one written since", "run again")
    return mapped(file, dtype, shape, offset)

"""Large arrays of tasks, lent to processes of this machine: written once to memory that all map, not sent to each.

What a process gets is its own: it may write to it, which copies the pages it writes to. The memory has no name in any
folder, so that nothing is left behind whoever is killed. Where there is no such memory (``memfd_create`` of Linux)
arrays are sent.
"""

import io
import mmap
import os
import pickle
import threading
from dataclasses import dataclass

import numpy as np

from pipeline.contract.mapped import LARGE


@dataclass(frozen=True)
class Packed:
    """A value as bytes, and the arrays (by their identity) that it borrows."""

    content: bytes
    borrowed: tuple


class Lender:
    """Arrays of values that were packed, each lent until all values that borrow it were taken back."""

    def __init__(self):
        self._lent, self._lock = {}, threading.Lock()       # identity -> [array, descriptor, values that borrow it]

    def packed(self, value: object) -> Packed:
        """A value Packed; ``pickle.loads`` of its content is the same, in any process while it is not taken back."""
        stream, borrowed = io.BytesIO(), []
        pickler = _Pickler(stream, lambda array: self._place(array, borrowed))
        try:
            pickler.dump(value)
        except BaseException:
            self.take_back(Packed(b"", tuple(borrowed)))
            raise
        return Packed(stream.getvalue(), tuple(borrowed))

    def take_back(self, packed: Packed):
        """The value is needed no more: arrays that no other one borrows are let go."""
        with self._lock:
            for identity in packed.borrowed:
                entry = self._lent[identity]
                entry[2] -= 1
                if not entry[2]:
                    os.close(entry[1])
                    del self._lent[identity]

    def _place(self, array, borrowed):
        """Path of the memory that holds an ``array``, which one more value borrows."""
        with self._lock:
            entry = self._lent.setdefault(id(array), [array, None, 0])
            if entry[1] is None:
                entry[1] = _written(array)
            if id(array) not in borrowed:
                entry[2] += 1
                borrowed.append(id(array))
            return f"/proc/{os.getpid()}/fd/{entry[1]}"


class _Pickler(pickle.Pickler):
    def __init__(self, stream, place):
        super().__init__(stream, protocol=5)
        self._place = place

    def reducer_override(self, value):
        if type(value) is not np.ndarray or not _lendable(value):
            return NotImplemented
        order = "C" if value.flags.c_contiguous else "F"
        return _borrowed, (self._place(value), value.dtype, value.shape, order)


def _lendable(array):
    whole = array.flags.c_contiguous or array.flags.f_contiguous
    return hasattr(os, "memfd_create") and array.nbytes >= LARGE and whole and not array.dtype.hasobject


def _written(array):
    """Descriptor of memory that holds the numbers of an ``array`` in the order in which they lie."""
    descriptor = os.memfd_create("array")
    try:
        os.ftruncate(descriptor, array.nbytes)
        with mmap.mmap(descriptor, array.nbytes) as memory:
            there = np.frombuffer(memory, array.dtype)
            there[:] = array.ravel(order="K")
            del there
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor


def _borrowed(path, dtype, shape, order):
    with open(path, "rb") as memory:
        return np.frombuffer(mmap.mmap(memory.fileno(), 0, access=mmap.ACCESS_COPY), dtype).reshape(shape, order=order)

"""The checksum behind a product: BLAKE2b of all bytes before it, checked before HDF5 opens the file.

An HDF5 file may be followed by other bytes, which its readers leave alone. Whoever edits the file with another program
loses them or leaves them wrong.
"""

import hashlib
import os

from pipeline.contract.received.files import open_regular

_MARK = b"\nbrakechain blake2b\n"
_SIZE = 32
_BEHIND = len(_MARK) + _SIZE
_BLOCK = 1 << 20
MISSING = "no checksum at its end: cut off, edited by another program or of an earlier version"
WRONG = "its bytes are not those that were written"


def digest_of(content):
    """BLAKE2b of bytes, in hexadecimal."""
    return hashlib.blake2b(content, digest_size=_SIZE).hexdigest()


def seal(path):
    """Write the checksum of a file behind it."""
    with open(path, "r+b") as stream:
        digest = _digest(stream, os.fstat(stream.fileno()).st_size)
        stream.seek(0, os.SEEK_END)
        stream.write(_MARK + digest.digest())


def digest_of_file(path):
    """BLAKE2b of a regular file, in hexadecimal; OSError for anything else."""
    with open_regular(path, links=False) as stream:
        return _digest(stream, os.fstat(stream.fileno()).st_size).hexdigest()


def flaw(path):
    """Why the product at ``path`` is not as it was written, in words; '' where it is. OSError for an unreadable one."""
    with open_regular(path, links=False) as stream:
        size = os.fstat(stream.fileno()).st_size - _BEHIND
        if size < 0:
            return MISSING
        stream.seek(size)
        mark, stated = stream.read(len(_MARK)), stream.read(_SIZE)
        if mark != _MARK:
            return MISSING
        return "" if _digest(stream, size).digest() == stated else WRONG


def _digest(stream, size):
    """Hash of the first ``size`` bytes."""
    digest, left = hashlib.blake2b(digest_size=_SIZE), size
    stream.seek(0)
    while left and (block := stream.read(min(_BLOCK, left))):
        digest.update(block)
        left -= len(block)
    return digest

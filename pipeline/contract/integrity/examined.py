"""Products that came from elsewhere: a process of its own opens them first, since HDF5 may not survive what is in them.

A checksum tells damage, but whoever edits a product can write a matching one. A product is known if this process wrote
it or the list of its folder (``seen``) holds its present state, which names a time of change that no archive restores.
Any other is read whole by a process with limits of time and memory, once, before this one opens it.
"""

import json
import os
from pathlib import Path
from tempfile import TemporaryDirectory

from pipeline.contract.integrity import seen
from pipeline.contract.received import process

_FLAWS = "flaws.jsonl"
#: (path, size, times) of each product that this process wrote or had examined -> its flaw in words, '' for none
_known = {}


def trust(path):
    """Count the product at ``path`` as known: this process, or a reader of its own, wrote it."""
    _known[_key(path)] = ""


def flaw(path):
    """What a process of its own did not survive or stumbled over in the product at ``path``; '' for nothing."""
    examine([path])
    return _known.get(_key(path), "")


def examine(paths):
    """Have those products examined that are not known, by one process while it survives; the number of them.

    Their checksums are right: others need no process to be refused.
    """
    waiting = [] if process.is_reader() else [path for path in paths if _is_new(path)]
    count = len(waiting)
    while waiting:
        flaws = _flaws(waiting)
        for path, told in zip(waiting, flaws, strict=False):
            _known[_key(path)] = told
        waiting = waiting[len(flaws):]
    return count


def _key(path):
    return (os.path.abspath(path), *seen.state(path))


def _is_new(path):
    return _key(path) not in _known and not seen.is_listed(path)


def _flaws(paths):
    """Flaws of the first of ``paths``, up to the one that its process did not survive, or of all."""
    limits = process.Limits.of(sum(os.stat(path).st_size for path in paths))
    with TemporaryDirectory(prefix="brakechain-") as folder:
        code = process.started(f"{__name__}:leave", paths[0], folder, limits,
                               {"paths": [os.path.abspath(path) for path in paths]})
        left = Path(folder) / _FLAWS
        flaws = [json.loads(line) for line in left.read_text().splitlines()] if left.exists() else []
        if len(flaws) < len(paths):
            late = process.too_late(code, limits)
            flaws.append(f"HDF5 is not done with it within {late}" if late else
                         f"HDF5 does not survive it: {process.reason(code, folder)}")
    return flaws


def leave(_, folder, paths):
    """In the child process: read each product whole, and write its flaw to ``folder``."""
    from pipeline.contract.received.hdf5 import read_whole

    with (Path(folder) / _FLAWS).open("w") as stream:
        for path in paths:
            stream.write(json.dumps(_flaw(read_whole, path)) + "\n")
            stream.flush()


def _flaw(read_whole, path):
    try:
        read_whole(path)
    except Exception as error:      # whatever HDF5 makes of a file with a right checksum
        return f"{type(error).__name__}: {error}"[:300]
    return ""

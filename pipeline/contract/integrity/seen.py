"""Files that were found as they were written, each with its size and times: only what changed since is hashed again.

The list lies in the run folder. Every change of a file gives it a new time of change, which no program sets back; a
copied folder is hashed once. ``brakechain verify`` hashes everything, whatever the list says.
"""

import json
import os
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from pipeline.contract.integrity import checksum
from pipeline.contract.received import files

LIST = ".checked.json"
_MOST = 10_000_000


def state(path):
    """[size, time of the last change of its content, of the file] of what is at ``path``; links are not followed."""
    status = os.lstat(path)
    return [status.st_size, status.st_mtime_ns, status.st_ctime_ns]


def flaw(path):
    """Why the product at ``path`` is not as it was written, '' where it is; hashed only if it changed since."""
    try:
        now = state(path)
        return "" if _listed(path) == now else _flaw(str(path), tuple(now))
    except OSError as error:
        return error.strerror or str(error)


def is_listed(path):
    """Whether the product at ``path`` was found to be right in its present state."""
    return _listed(path) == state(path)


def differs(path, digest):
    """Whether the companion at ``path`` is other than its ``digest``; hashed only if it changed since."""
    try:
        now = state(path)
        return _listed(path, digest) != now and _digest(str(path), tuple(now)) != digest
    except OSError:
        return True


@lru_cache(4096)
def _flaw(path, _):
    return checksum.flaw(path)


@lru_cache(4096)
def _digest(path, _):
    return checksum.digest_of_file(path)


def _listed(path, digest=""):
    """State in which the file at ``path`` was found to be right, and to have this ``digest`` if any; or None."""
    entry = _list(str(Path(path).parent)).get(Path(path).name)
    return entry[:3] if isinstance(entry, list) and entry[3:] == [digest] else None


def _list(folder):
    path = os.path.join(folder, LIST)
    try:
        return _read(path, tuple(state(path)))
    except OSError:
        return {}


@lru_cache(64)
def _read(path, _):
    with suppress(OSError, ValueError, RecursionError):
        entries = json.loads(files.read_regular(path, _MOST, links=False))
        return entries if isinstance(entries, dict) else {}
    return {}


def note(folder, found):
    """List ``found`` {name of a file: digest, '' of a product} as right in their present state; others leave the list.

    A folder that cannot be written keeps its list: files are then hashed again.
    """
    folder = Path(folder)
    with suppress(OSError):
        entries = {name: [*state(folder / name), digest] for name, digest in found.items()}
        if entries != _list(str(folder)):
            partial = folder / f"{LIST}.partial"
            files.write_new(partial, json.dumps(entries).encode())
            os.replace(partial, folder / LIST)

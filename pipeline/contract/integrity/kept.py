"""Results of finished tasks of a stage, kept beside its product until this is written: a run that is killed goes on.

A stage is a pure function, so that the n-th task of its m-th fan-out is the same task in every run of one fingerprint;
its result is kept under these numbers. A file is believed if its code proves that this user wrote it, for this
fingerprint: others are computed again, not loaded.
"""

import hashlib
import hmac
import json
import os
import pickle
import secrets
import shutil
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

from pipeline.contract.received import files
from pipeline.environment import user_folder

#: seconds of a task below which, and bytes of a result above which, it is not kept
_SHORTEST, _LARGEST = 0.2, 1 << 26
_CODE = hashlib.sha256().digest_size


class Kept:
    """Results kept in a ``folder`` for what ``fingerprint`` (bytes) says; those kept for another are not believed."""

    def __init__(self, folder, fingerprint, home=None):
        """``home``: folder of the user's key; None = that of the user. What cannot be kept is computed again."""
        self._folder, self._calls = Path(folder), 0
        if self._folder.is_symlink():
            self.forget()
        self._secret = hashlib.sha256(_key(Path(home or user_folder())) + fingerprint).digest()

    @classmethod
    def of(cls, folder, *depends):
        """Kept of what ``depends`` on these, as JSON writes them."""
        return cls(folder, json.dumps(depends, sort_keys=True).encode())

    def completed(self, fan_out, function, items):
        """``[function(item) for item in items]``, of which ``fan_out(function, items)`` computes what is not kept."""
        self._calls += 1
        paths = [self._folder / f"{self._calls}-{number}" for number in range(len(items))]
        found = {number: result for number, path in enumerate(paths) for result in _loaded(path, self._secret)}
        missing = [number for number in range(len(items)) if number not in found]
        tasks = [(items[number], os.fspath(paths[number])) for number in missing]
        found |= dict(zip(missing, fan_out(partial(_keep, function, self._secret), tasks), strict=True))
        return [found[number] for number in range(len(items))]

    def forget(self):
        """Remove all that is kept."""
        with suppress(OSError):
            self._folder.unlink() if self._folder.is_symlink() else shutil.rmtree(self._folder)


def _keep(function, secret, task):
    """The result of a task, which is kept; as it is loaded again: arrays with gaps are gapless."""
    (item, path), begin, parts = task, time.perf_counter(), []
    result = function(item)
    lasted = time.perf_counter() - begin
    head = pickle.dumps(result, protocol=5, buffer_callback=parts.append)      # without a copy of large arrays
    if lasted >= _SHORTEST and sum(part.raw().nbytes for part in parts) <= _LARGEST:
        with suppress(OSError):
            _write(Path(path), pickle.dumps(result, protocol=5), secret)
    return pickle.loads(head, buffers=parts)


def _write(path, content, secret):
    half = path.with_name(f".{path.name}.partial")
    path.parent.mkdir(exist_ok=True)
    files.write_new(half, _code(secret, path, content) + content)
    os.replace(half, path)


def _loaded(path, secret):
    """[the result kept at ``path``], or []."""
    try:
        content = files.read_regular(path, 2 * _LARGEST, links=False)
    except OSError:
        return []
    if not hmac.compare_digest(content[:_CODE], _code(secret, path, content[_CODE:])):
        return []
    return [pickle.loads(content[_CODE:])]


def _code(secret, path, content):
    return hmac.digest(secret, path.name.encode() + b"\0" + content, "sha256")


def _key(home):
    """Secret bytes of the user, made at first use; of this run alone where they cannot be kept."""
    path = home / "key_of_kept_results"
    with suppress(OSError):
        home.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):
            handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
            with os.fdopen(handle, "wb") as stream:
                stream.write(secrets.token_bytes(_CODE))
        key = files.read_regular(path, 2 * _CODE, links=False)
        if len(key) == _CODE:
            return key
    return secrets.token_bytes(_CODE)

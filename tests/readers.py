"""Readers of files in this process, for tests whose subject is not the process that a reader has for users."""

import json
import warnings
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

from pipeline.contract.received import process


@contextmanager
def in_this_process():
    """Readers that have a process of their own are called in this one."""
    with mock.patch.object(process, "started", _read_here):
        yield


def _read_here(reader, path, folder, limits, given):
    """``process.started`` without the start of a process, with its limits left out."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")     # as a user sees them: tests make errors of them
        process.leave(reader, str(Path(path).absolute()), str(folder), limits.memory, json.loads(json.dumps(given)))
    return 0

"""Names and paths of a received folder: checked here alone, and resolved inside the folder."""

import os
import re
from pathlib import Path

from pipeline.contract.errors import ConfigError

#: name of a case, run, channel or variant: a group of an HDF5 file and a part of a path
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,199}")
EXPECTED = "letters, digits and _ . -"


def is_name(name):
    """Whether ``name`` is one: it is a single part of a path, and leads nowhere else."""
    return isinstance(name, str) and bool(_NAME.fullmatch(name))


def checked(name, where):
    """``name``, or ConfigError at ``where``."""
    if not is_name(name):
        raise ConfigError(where, f"a name of {EXPECTED}", repr(name)[:100], "rename it")
    return name


def checked_all(mapping, where):
    """``mapping``, a dict whose keys are names; ConfigError at ``where`` for anything else."""
    if not isinstance(mapping, dict):
        raise ConfigError(where, "a mapping of names", repr(mapping)[:100])
    for name in mapping:
        checked(name, where)
    return mapping


def within(folder, name):
    """The path ``name`` of ``folder``; ConfigError where it, or a link on its way, leads out of the folder."""
    path = Path(folder) / name
    root, target = os.path.realpath(folder), os.path.realpath(path)
    if target != root and not target.startswith(root.rstrip(os.sep) + os.sep):
        raise ConfigError(path, f"a path inside {folder}", "one that leads out of it", "remove it")
    return path

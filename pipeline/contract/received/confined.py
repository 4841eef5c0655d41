"""A process that may name the files of one folder alone, as the solver of a foreign case."""

import os
from pathlib import Path

#: variable of the environment that names the folder
VARIABLE = "BRAKECHAIN_ONLY"
#: files of this project are its code
_OWN = Path(__file__).resolve().parents[2]


def allowed(path):
    """Whether this process may read the file at ``path`` for its case."""
    only = os.environ.get(VARIABLE)
    if not only:
        return True
    file = Path(os.path.realpath(path))
    return Path(os.path.realpath(only)) in file.parents or _OWN in file.parents


def confined():
    """Whether this process is confined to a folder."""
    return bool(os.environ.get(VARIABLE))

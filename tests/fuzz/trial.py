"""What one input of the fuzzer is, what a reader makes of it, and how that is judged."""

import contextlib
import os
import time
import traceback
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from unittest import mock

import numpy as np

from pipeline.contract.errors import LONGEST, BrakechainError
from pipeline.contract.received import process
from tests import readers

#: read: as it should be; told: otherwise, and a remark says what was assumed or left out; refused: one sentence;
#: contained: one sentence about what the process of a reader stumbled over or did not survive. Failures: internal
#: error; wrong numbers, or damage not noticed; rejected, although right; no answer in time; death of the process
GOOD, BAD = ("read", "told", "refused", "contained"), ("internal", "wrong", "rejected", "hang", "crash")


class Told(str):
    """What is otherwise than it truly is, and told: the answer of a check that is no failure."""


@dataclass(frozen=True)
class Trial:
    """One input: ``content`` of a file called ``name``, ``given`` to its reader.

    ``how``: what was changed; ``check(value)``: '' where what was read is right, else what is wrong, Told where a
    remark says so; ``must``: whether it must be read, must be refused, or may be either.
    """

    name: str
    content: bytes
    how: str = "damaged"
    given: dict = field(default_factory=dict)
    check: Callable = None
    must: str = "either"

    @property
    def known(self):
        """Whether it has a known answer."""
        return self.check is not None or self.must != "either"


@dataclass(frozen=True)
class Target:
    """``read(path, **given)`` is what the program does with a file; ``damage(rng)`` and ``known`` (each of rng) make
    Trials. ``apart``: the file is read in a process of its own, whose death is one sentence."""

    name: str
    read: Callable
    damage: Callable
    known: tuple = ()
    apart: bool = False
    share: float = 0.3

    def trial(self, seed, number):
        """The Trial of this ``number``: the same for ever, as long as corpus and mutations are."""
        rng = np.random.default_rng((zlib.crc32(self.name.encode()), seed, number))
        if self.known and rng.random() < self.share:
            return self.known[int(rng.integers(len(self.known)))](rng)
        return self.damage(rng)


@dataclass(frozen=True)
class Outcome:
    """What became of a Trial: one of GOOD or BAD, what was changed, what was said, seconds, and whether its answer is
    known."""

    kind: str
    how: str = ""
    said: str = ""
    seconds: float = 0.0
    known: bool = False


def outcome(target, trial, folder):
    """Outcome of reading the ``trial`` in this process; its file is written to ``folder``."""
    path, begin = Path(folder) / trial.name, time.perf_counter()
    path.write_bytes(trial.content)
    try:
        value = target.read(path, **trial.given)
        said = "read, although damaged" if trial.must == "refuse" else trial.check(value) if trial.check else ""
        kind = "told" if isinstance(said, Told) else "wrong" if said else "read"
    except BrakechainError as error:
        kind, said = _judged(error, trial)
    except (Exception, SystemExit) as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        kind, said = "internal", f"{type(error).__name__}: {error} [{Path(place.filename).name}:{place.lineno}]"
    finally:
        path.unlink(missing_ok=True)
    return Outcome(kind, trial.how, said[:400], time.perf_counter() - begin, trial.known)


def _judged(error, trial):
    text = str(error)
    if len(text) > LONGEST or not all(c.isprintable() or c in "\n\t" for c in text):
        return "internal", f"a message of {len(text)} characters: {text!r}"
    if trial.must == "read":
        return "rejected", text
    stumbled = error.expected == "an undamaged file" or "stops its reader" in text
    return ("contained" if stumbled else "refused"), text


@contextlib.contextmanager
def in_this_process():
    """Readers that have a process of their own are called in this one, and products are opened here at once."""
    with readers.in_this_process(), mock.patch.dict(os.environ, {process._READER: "1"}):
        yield


def difference(value, expected, tolerance=1e-9, path=""):
    """'' where plain values, mappings, lists and arrays are equal to a ``tolerance``; else where they differ."""
    if isinstance(expected, dict):
        if not isinstance(value, dict) or set(value) != set(expected):
            return f"{path}: {sorted(value) if isinstance(value, dict) else value!r} for {sorted(expected)}"
        pairs = ((value[key], expected[key], f"{path}.{key}") for key in expected)
    elif isinstance(expected, list | tuple) and not all(isinstance(v, int | float | complex) for v in expected):
        if len(value) != len(expected):
            return f"{path}: {len(value)} for {len(expected)} values"
        pairs = ((a, b, f"{path}.{k}") for k, (a, b) in enumerate(zip(value, expected, strict=True)))
    else:
        return _unlike(value, expected, tolerance, path)
    return next((text for pair in pairs if (text := difference(*pair[:2], tolerance, pair[2]))), "")


def _unlike(value, expected, tolerance, path):
    wanted = np.asarray(expected)
    if wanted.dtype.kind not in "iufcb":
        return "" if str(value) == str(expected) else f"{path}: {str(value)[:60]!r} for {str(expected)[:60]!r}"
    found = np.asarray(value)
    if found.shape != wanted.shape:
        return f"{path}: shape {found.shape} for {wanted.shape}"
    size = np.nanmax(np.abs(wanted), initial=0.0) if wanted.size and not np.isnan(wanted).all() else 0.0
    if np.allclose(found, wanted, rtol=tolerance, atol=tolerance * size, equal_nan=True):
        return ""
    first = np.flatnonzero(~np.isclose(found, wanted, rtol=tolerance, atol=tolerance * size, equal_nan=True).ravel())[0]
    return f"{path}: {found.ravel()[first]!r} for {wanted.ravel()[first]!r} at {first}"

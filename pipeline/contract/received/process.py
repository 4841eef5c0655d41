"""Readers in a process of their own: what a damaged file does to a library ends there.

A file that came from elsewhere may crash the library that reads it, keep it busy for ever or ask for all memory. The
child has limits of time and memory, and leaves its answer in a folder that the parent reads.
"""

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

from pipeline.contract.errors import BrakechainError, ConfigError, ProductError
from pipeline.environment import of_children

#: seconds of processor that a reader has: so many, and one for so many bytes
_SECONDS, _BYTES_A_SECOND = 15, 5_000_000
#: bytes of memory that it has: so many, and so many for each of the file
_MEMORY, _MEMORY_A_BYTE = 3_000_000_000, 24
#: seconds of the clock that it has on a machine that does other work too: so many for files of so many bytes, and one
#: for so many bytes more
_CLOCK, _SMALL, _BYTES_A_SECOND_OF_CLOCK = 60, 1_000_000, 500_000
#: variable of the environment of such a process
_READER = "BRAKECHAIN_READER"
_ERROR, _SAID = "error.json", "said.txt"
#: signal that ends a process whose time of the processor is over (SIGXCPU)
_OUT_OF_TIME = 24


def answered(reader, path, collect, **given):
    """``collect(folder)`` of what the function ``reader``, "module:function", has left of the file at ``path``.

    It is called with the path, the folder and ``given``. Raises ConfigError as it does, and for a file that it does
    not survive or is not done with in time.
    """
    path = Path(path)
    if not path.is_file():
        raise ConfigError(path, "a regular file", "none" if not path.exists() else "another kind of file")
    limits = Limits.of(path.stat().st_size)
    with TemporaryDirectory(prefix="brakechain-") as folder:
        code = started(reader, path, folder, limits, given)
        return collected(code, path, Path(folder), limits, collect)


@dataclass(frozen=True)
class Limits:
    """Seconds of processor and of the clock, and bytes of memory, that a reader has."""

    processor: int
    clock: float
    memory: int

    @classmethod
    def of(cls, size):
        """Those of files of ``size`` bytes."""
        return cls(_SECONDS + size // _BYTES_A_SECOND, _CLOCK + max(size - _SMALL, 0) / _BYTES_A_SECOND_OF_CLOCK,
                   _MEMORY + _MEMORY_A_BYTE * size)


def started(reader, path, folder, limits, given):
    """Exit code of a process that calls the ``reader`` with the path, the folder and ``given``; None where its time of
    the clock was over."""
    arguments = [reader, str(Path(path).absolute()), str(folder), str(limits.processor), str(limits.memory)]
    with (Path(folder) / _SAID).open("wb") as said:
        try:
            child = subprocess.run([sys.executable, "-P", "-m", __name__, *arguments], input=json.dumps(given).encode(),
                                   stdout=subprocess.DEVNULL, stderr=said, env=of_children() | {_READER: "1"},
                                   timeout=limits.clock)
        except subprocess.TimeoutExpired:
            return None
    return child.returncode


def is_reader():
    """Whether this process is one of a reader."""
    return os.environ.get(_READER) == "1"


def collected(code, path, folder, limits, collect):
    """The answer of a child that ended with ``code``; ConfigError where it left none, or an error."""
    told = folder / _ERROR
    if told.exists():
        raise ConfigError(*json.loads(told.read_text()))
    late = too_late(code, limits)
    if late:
        raise ConfigError(path, f"a file that is read within {late}", "a reader that is not done",
                          "the file is damaged, or too large: copy it again, or cut it")
    if code:
        raise ConfigError(path, "an undamaged file", f"one that stops its reader ({reason(code, folder)})",
                          "copy it again")
    try:
        return collect(folder)
    except (OSError, ProductError, ValueError) as error:
        raise ConfigError(path, "an undamaged file", f"one whose reader leaves nothing ({error})"[:300]) from None


def too_late(code, limits):
    """The time within which a reader that ended with ``code`` should have been done, in words; '' for other ends."""
    if code is None:
        return f"{limits.clock:.0f} s of the clock"
    return f"{limits.processor} s" if -code == _OUT_OF_TIME else ""


def reason(code, folder):
    """The last line that a reader said that ended with ``code``, or this code."""
    with (Path(folder) / _SAID).open("rb") as said:
        said.seek(max((Path(folder) / _SAID).stat().st_size - 2000, 0))
        lines = said.read().decode(errors="replace").strip().splitlines()
    return (lines or [f"exit code {code}"])[-1][:200]


def leave(reader, path, folder, memory, given):
    """In the child: call the ``reader``, which leaves its answer, or leave the error in ``folder``."""
    module, _, function = reader.partition(":")
    try:
        getattr(import_module(module), function)(path, folder, **given)
    except BrakechainError as error:
        _tell(folder, str(error.where), error.expected, error.found, error.remedy)
    except MemoryError:
        _tell(folder, path, f"a file that is read within {memory / 1e9:.3g} GB", "one that needs more",
              "the file is damaged, or too large: copy it again, or cut it")
    except Exception as error:  # whatever a reader stumbles over is the file's doing
        _tell(folder, path, "an undamaged file", f"{type(error).__name__}: {error}"[:300], "copy it again")


def _tell(folder, *parts):
    (Path(folder) / _ERROR).write_text(json.dumps(parts))


def _limit(seconds, memory):
    """Limit this process, where the system can."""
    try:
        import resource
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    for kind in (resource.RLIMIT_AS, resource.RLIMIT_FSIZE):
        hard = resource.getrlimit(kind)[1]
        resource.setrlimit(kind, (memory if hard == resource.RLIM_INFINITY else min(memory, hard), hard))


def main(reader, path, folder, seconds, memory):
    """Child process."""
    _limit(int(seconds), int(memory))
    leave(reader, path, folder, int(memory), json.load(sys.stdin))


if __name__ == "__main__":
    main(*sys.argv[1:])

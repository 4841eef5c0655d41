"""Readers in a process of their own: what a damaged file does to a library ends there.

A file that came from elsewhere may crash the library that reads it, keep it busy for ever or ask for all memory. The
child has limits of time and memory, and leaves its answer in a folder that the parent reads.
"""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

from pipeline.contract.errors import BrakechainError, ConfigError, ProductError
from pipeline.environment import of_children

#: seconds of processor that a reader has: so many, and one for so many bytes
_SECONDS, _BYTES_A_SECOND = 15, 5_000_000
#: bytes of memory that it has: so many, and so many for each of the file
_MEMORY, _MEMORY_A_BYTE = 3_000_000_000, 24
#: wall clock over time of the processor before a reader is stopped that waits, on a machine that does other work too
_PATIENCE = 10
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
    size = path.stat().st_size
    seconds = _SECONDS + size // _BYTES_A_SECOND
    with TemporaryDirectory(prefix="brakechain-") as folder:
        arguments = [reader, str(path.absolute()), folder, str(seconds), str(_MEMORY + _MEMORY_A_BYTE * size)]
        try:
            with (Path(folder) / _SAID).open("wb") as said:
                child = subprocess.run([sys.executable, "-P", "-m", __name__, *arguments],
                                       input=json.dumps(given).encode(), stdout=subprocess.DEVNULL, stderr=said,
                                       env=of_children(), timeout=_PATIENCE * seconds)
        except subprocess.TimeoutExpired:
            raise ConfigError(path, f"a file that is read within {seconds} s", "a reader that is not done",
                              "the file is damaged, or too large: copy it again, or cut it") from None
        return collected(child.returncode, path, Path(folder), seconds, collect)


def collected(code, path, folder, seconds, collect):
    """The answer of a child that ended with ``code``; ConfigError where it left none, or an error."""
    told = folder / _ERROR
    if told.exists():
        raise ConfigError(*json.loads(told.read_text()))
    if -code == _OUT_OF_TIME:
        raise ConfigError(path, f"a file that is read within {seconds} s", "a reader that is not done",
                          "the file is damaged: copy it again")
    if code:
        with (folder / _SAID).open("rb") as said:
            said.seek(max((folder / _SAID).stat().st_size - 2000, 0))
            lines = said.read().decode(errors="replace").strip().splitlines()
        reason = (lines or [f"exit code {code}"])[-1][:200]
        raise ConfigError(path, "an undamaged file", f"one that stops its reader ({reason})", "copy it again")
    try:
        return collect(folder)
    except (OSError, ProductError, ValueError) as error:
        raise ConfigError(path, "an undamaged file", f"one whose reader leaves nothing ({error})"[:300]) from None


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

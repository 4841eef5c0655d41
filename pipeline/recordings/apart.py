"""Readers in a process of their own: what a damaged file does to a library ends there.

A file that came from elsewhere may crash the library that reads it, keep it busy for ever or ask for all memory. The
child has limits of time and memory, and answers with arrays, or with a product, in a folder that the parent reads.
"""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from pipeline.contract import store
from pipeline.contract.errors import BrakechainError, ConfigError, ProductError
from pipeline.contract.mapped import blocks, map_of, mapped, opened
from pipeline.environment import of_children
from pipeline.products import Recording, Run
from pipeline.recordings.audio import read_audio
from pipeline.recordings.columns import read_matlab
from pipeline.recordings.mdf import read_mdf
from pipeline.recordings.neutral import read_neutral
from pipeline.recordings.tdms import read_tdms
from pipeline.recordings.uff import read_uff
from pipeline.recordings.waveform import Waveform

#: seconds of processor that a reader has: so many, and one for so many bytes
_SECONDS, _BYTES_A_SECOND = 15, 5_000_000
#: bytes of memory that it has: so many, and so many for each of the file
_MEMORY, _MEMORY_A_BYTE = 3_000_000_000, 24
#: wall clock over time of the processor before a reader is stopped that waits, on a machine that does other work too
_PATIENCE = 10
_ERROR, _COLUMNS, _RUNS, _SAID = "error.json", "columns.json", "runs.h5", "said.txt"


def waveforms(kind, path):
    """{name: Waveform} of the file at ``path`` of this ``kind``: matlab, audio, tdms or mdf.

    Raises ConfigError as its reader does, and for a file that its reader does not survive or is not done with in time.
    """
    return _child(kind, path, {}, _columns_of)


def runs(kind, path, **given):
    """{name: Run} of the file at ``path``: kind ``hdf5``, or ``uff`` (one run, ``file``); ``given`` goes to its reader.

    Errors as of ``waveforms``.
    """
    return _child(kind, path, given, lambda folder: store.read(Recording, folder / _RUNS).runs)


def answered(reader, path, collect, **given):
    """``collect(folder)`` of what the function ``reader``, "module:function", has left of the file at ``path``.

    It is called with the path, the folder and ``given``. Errors as of ``waveforms``.
    """
    return _child(reader, path, given, collect)


def _child(kind, path, given, collect):
    """``collect(folder)`` of what the reader has left in its folder."""
    path = Path(path)
    if not path.is_file():
        raise ConfigError(path, "a regular file", "none" if not path.exists() else "another kind of file")
    size = path.stat().st_size
    seconds = _SECONDS + size // _BYTES_A_SECOND
    variables = of_children()
    with TemporaryDirectory(prefix="brakechain-") as folder:
        arguments = [kind, str(path.absolute()), folder, str(seconds), str(_MEMORY + _MEMORY_A_BYTE * size)]
        try:
            with (Path(folder) / _SAID).open("wb") as said:
                child = subprocess.run([sys.executable, "-P", "-m", "pipeline.recordings.apart", *arguments],
                                       input=json.dumps(given).encode(), stdout=subprocess.DEVNULL, stderr=said,
                                       env=variables, timeout=_PATIENCE * seconds)
        except subprocess.TimeoutExpired:
            raise ConfigError(path, f"a file that is read within {seconds} s", "a reader that is not done",
                              "the file is damaged, or too large: copy it again, or cut it") from None
        return _answer(child, path, Path(folder), seconds, collect)


def _answer(child, path, folder, seconds, collect):
    told = folder / _ERROR
    if told.exists():
        raise ConfigError(*json.loads(told.read_text()))
    if child.returncode < 0 and -child.returncode == _OUT_OF_TIME:
        raise ConfigError(path, f"a file that is read within {seconds} s", "a reader that is not done",
                          "the file is damaged: copy it again")
    if child.returncode:
        with (folder / _SAID).open("rb") as said:
            said.seek(max((folder / _SAID).stat().st_size - 2000, 0))
            lines = said.read().decode(errors="replace").strip().splitlines()
        reason = (lines or [f"exit code {child.returncode}"])[-1][:200]
        raise ConfigError(path, "an undamaged file", f"one that stops its reader ({reason})", "copy it again")
    try:
        return collect(folder)
    except (OSError, ProductError, ValueError) as error:
        raise ConfigError(path, "an undamaged file", f"one whose reader leaves nothing ({error})"[:300]) from None


#: signal that ends a process whose time of the processor is over (SIGXCPU)
_OUT_OF_TIME = 24


def _columns_of(folder):
    """Waveforms whose values are maps of files that are gone from the folder, but last as long as these."""
    return {name: Waveform(_left(folder / Path(file).name, np.dtype(dtype), count), *rest)
            for name, file, dtype, count, *rest in json.loads((folder / _COLUMNS).read_text())}


def _left(file, dtype, count):
    if file.stat().st_size != count * dtype.itemsize:
        raise ValueError(f"{file.stat().st_size} bytes of {count * dtype.itemsize}")
    return mapped(opened(file, lasting=False), dtype, (count,)) if count else np.empty(0, dtype)


def _leave_columns(found, folder):
    """Values that lie in a file of the folder already stay there; others are written."""
    table = []
    for k, (name, waveform) in enumerate(found.items()):
        values, file = np.asarray(waveform.values), map_of(waveform.values)
        path = folder / f"{k}.bin" if file is None else Path(file.path)
        if file is None:
            with path.open("wb") as stream:
                for block in blocks(values):
                    stream.write(np.ascontiguousarray(block))
        table.append((name, path.name, values.dtype.str, len(values), waveform.unit,
                      None if waveform.rate is None else float(waveform.rate), float(waveform.begin)))
    (folder / _COLUMNS).write_text(json.dumps(table))


def _leave_runs(found, folder):
    store.write(Recording(source=[], runs=found), folder / _RUNS, {})


def _matlab(path, _):
    return {name: Waveform(values) for name, values in read_matlab(path).items()}


def _universal(path, _, units=None):
    channels, frf, modes = read_uff(path, units)
    return {"file": Run(description="", repeat_of="", channels=channels, frf=frf, modes=modes)}


#: kind of file -> (reader of a path and the folder for what is long, what leaves its answer)
_READERS = {"matlab": (_matlab, _leave_columns), "audio": (read_audio, _leave_columns),
            "tdms": (read_tdms, _leave_columns), "mdf": (read_mdf, _leave_columns),
            "hdf5": (lambda path, _: read_neutral(path), _leave_runs), "uff": (_universal, _leave_runs)}


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


def main(kind, path, folder, seconds, memory):
    """Child process: read, and leave the answer or the error in ``folder``."""
    _limit(int(seconds), int(memory))
    try:
        if kind in _READERS:
            reader, leave = _READERS[kind]
            leave(reader(path, folder, **json.load(sys.stdin)), Path(folder))
        else:
            module, _, function = kind.partition(":")
            getattr(import_module(module), function)(path, folder, **json.load(sys.stdin))
    except BrakechainError as error:
        _tell(folder, str(error.where), error.expected, error.found, error.remedy)
    except MemoryError:
        _tell(folder, path, f"a file that is read within {int(memory) / 1e9:.3g} GB", "one that needs more",
              "the file is damaged, or too large: copy it again, or cut it")
    except Exception as error:  # whatever a reader stumbles over is the file's doing
        _tell(folder, path, "an undamaged file", f"{type(error).__name__}: {error}"[:300], "copy it again")


def _tell(folder, *parts):
    (Path(folder) / _ERROR).write_text(json.dumps(parts))


if __name__ == "__main__":
    main(*sys.argv[1:])

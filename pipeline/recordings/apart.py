"""Readers of recordings in a process of their own, which answers with arrays, or with a product."""

import json
from functools import partial
from pathlib import Path

import numpy as np

from pipeline.contract import store
from pipeline.contract.integrity import examined
from pipeline.contract.mapped import blocks, map_of, mapped, opened
from pipeline.contract.received.process import answered
from pipeline.products import Recording, Run
from pipeline.recordings.audio import read_audio
from pipeline.recordings.columns import matlab_waveforms, read_columns
from pipeline.recordings.mdf import read_mdf
from pipeline.recordings.neutral import read_neutral
from pipeline.recordings.tdms import read_tdms
from pipeline.recordings.uff import read_uff
from pipeline.recordings.waveform import Waveform

_ARRAYS = ("values", "times")
_COLUMNS, _RUNS, _REMARKS, _LEAVE = "columns.json", "runs.h5", "remarks.json", "pipeline.recordings.apart:leave"


def waveforms(kind, path, **given):
    """{name: Waveform} of the file at ``path`` of this ``kind``: matlab, columns, audio, tdms or mdf; ``given`` goes to
    its reader.

    Raises ConfigError as its reader does, and for a file that its reader does not survive or is not done with in time.
    """
    return answered(_LEAVE, path, _columns_of, kind=kind, **given)


def runs(kind, path, tell=None, **given):
    """{name: Run} of the file at ``path``: kind ``hdf5``, or ``uff`` (one run, ``file``); ``given`` goes to its reader.

    ``tell`` is called with what was left out or guessed. Errors as of ``waveforms``.
    """
    return answered(_LEAVE, path, partial(_runs_of, tell=tell), kind=kind, **given)


def leave(path, folder, kind, **given):
    """In the child process: read the file and leave its content in ``folder``."""
    reader, left = _READERS[kind]
    left(reader(path, folder, **given), Path(folder))


def _runs_of(folder, tell):
    remarks = folder / _REMARKS
    for remark in json.loads(remarks.read_text()) if tell and remarks.exists() else ():
        tell(remark)
    examined.trust(folder / _RUNS)
    return store.read(Recording, folder / _RUNS).runs


def _columns_of(folder):
    """Waveforms whose values are maps of files that are gone from the folder, but last as long as these."""
    return {name: Waveform(**{key: _left(folder, *value) if key in _ARRAYS else value for key, value in told.items()})
            for name, told in json.loads((folder / _COLUMNS).read_text())}


def _left(folder, name, dtype, count):
    file, dtype = folder / Path(name).name, np.dtype(dtype)
    if file.stat().st_size != count * dtype.itemsize:
        raise ValueError(f"{file.stat().st_size} bytes of {count * dtype.itemsize}")
    return mapped(opened(file, lasting=False), dtype, (count,)) if count else np.empty(0, dtype)


def _leave_columns(found, folder):
    table = []
    for k, (name, waveform) in enumerate(found.items()):
        told = {"unit": waveform.unit, "rate": None if waveform.rate is None else float(waveform.rate),
                "begin": float(waveform.begin), "stamp": waveform.stamp, "remark": waveform.remark}
        told |= {key: _leave_array(getattr(waveform, key), folder / f"{k}.{key}") for key in _ARRAYS
                 if getattr(waveform, key) is not None}
        table.append((name, told))
    (folder / _COLUMNS).write_text(json.dumps(table))


def _leave_array(array, path):
    """(name of the file, dtype, length) of an array; one that lies in a file of the folder already stays there."""
    values, file = np.asarray(array), map_of(array)
    named = file is not None and file.path is not None
    path = Path(file.path) if named else path
    if not named:
        with path.open("wb") as stream:
            for block in blocks(values):
                stream.write(np.ascontiguousarray(block))
    return path.name, values.dtype.str, len(values)


def _leave_runs(found, folder):
    store.write(Recording(source=[], runs=found), folder / _RUNS, {})


def _vectors(read):
    return lambda path, _: {name: Waveform(values) for name, values in read(path).items()}


def _universal(path, folder, **given):
    channels, frf, modes = _told(read_uff, path, folder, **given)
    return {"file": Run(description="", repeat_of="", channels=channels, frf=frf, modes=modes)}


def _told(read, path, folder, **given):
    """What a reader returns; what it tells is left in ``folder``."""
    remarks = []
    found = read(path, **given, tell=remarks.append)
    (Path(folder) / _REMARKS).write_text(json.dumps(remarks))
    return found


#: kind of file -> (reader of a path and the folder for what is long, what leaves its answer)
_READERS = {"matlab": (lambda path, _: matlab_waveforms(path), _leave_columns),
            "columns": (_vectors(read_columns), _leave_columns),
            "audio": (read_audio, _leave_columns), "tdms": (read_tdms, _leave_columns),
            "mdf": (read_mdf, _leave_columns), "hdf5": (partial(_told, read_neutral), _leave_runs),
            "uff": (_universal, _leave_runs)}

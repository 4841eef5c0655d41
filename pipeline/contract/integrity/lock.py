"""One run at a time in a run folder."""

import fcntl
import os
from contextlib import contextmanager, suppress

from pipeline.contract.errors import ProductError
from pipeline.contract.received import files


def closed(folder, why):
    """The ProductError of a run folder that cannot be written."""
    return ProductError(folder, "a run folder that can be written", why,
                        "choose another with --run, or correct its permissions")


@contextmanager
def locked(folder):
    """Lock the run folder for this process; the lock is released however the process ends."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = files.open_lock(folder / ".lock")
    except OSError as error:
        raise closed(folder, f".lock: {error.strerror}" if folder.is_dir() else error.strerror) from None
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.pread(handle, 32, 0).decode(errors="replace") or "unknown"
            raise ProductError(folder, "a free run folder", f"another run on it (process {holder})",
                               "wait for it, or choose another folder with --run") from None
        os.ftruncate(handle, 0)
        os.pwrite(handle, str(os.getpid()).encode(), 0)
        _sweep(folder)
        yield
    finally:
        os.close(handle)


def _sweep(folder):
    """Remove files that a killed run left half-written."""
    for half in folder.glob(".*.partial"):
        with suppress(OSError):
            half.unlink()

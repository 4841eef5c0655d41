"""One case in a process of its own, which sees the two files of the case and nothing else of the trial.

The process starts in a fresh folder of no telling name with copies of nominal.yaml and recordings.h5, under an
environment that holds only what Python needs: no key, no path of the set, another home. This hides the truth from the
method under trial; it is no sandbox against a method that searches the disk.
"""

import contextlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from pipeline.blind_trial.protocol.case_set import FILES
from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.received import confined, files
from pipeline.environment import CACHE, ONE_THREAD, SAFE, use_compiled_cache

#: what runs a diagnosis; baselines have a door of their own
DIAGNOSIS = ("pipeline", "run", "nominal.yaml", "--run", "products", "--until", "diagnosis", "--workers", "1")
#: how a process ends that somebody else ended
_ENDED = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
_LONGEST = 500
#: bytes of address space that a process may take, where the system keeps to it: what asks for more is refused
MEMORY = 8 << 30
_ROOT = Path(__file__).parents[3]


def command(method):
    """The command of a method, 'diagnosis' or the name of a baseline, which ends with this process."""
    return (sys.executable, "-m", "pipeline.contract.following", str(os.getpid()),
            *(DIAGNOSIS if method == "diagnosis" else ("pipeline.blind_trial.baselines", method)))


def environment(home, work=None):
    """All variables of the process: compiled code is shared, everything else lies in ``home``, its case in ``work``.

    What the case names has to be in ``work``: a case that came from elsewhere reads its own two files alone.
    """
    use_compiled_cache()
    kept = {name: os.environ[name] for name in ("PATH", "LANG", CACHE) if name in os.environ}
    only = {confined.VARIABLE: str(work)} if work else {}
    return {**kept, **ONE_THREAD, **SAFE, **only, "HOME": str(home), "TMPDIR": str(home),
            "PYTHONPATH": str(_ROOT), "PYTHONDONTWRITEBYTECODE": "1"}


def answered(case, method, limit):
    """Answer of a method on the case in a folder: diagnosis.json, or a refusal with its reason; with its CPU seconds.

    ``limit``: seconds after which the process is ended. Raises BrakechainError where something from outside ended it.
    """
    here = Path(tempfile.mkdtemp(prefix="case-"))
    before = _cpu_seconds()
    try:
        work, home = here / "work", here / "home"
        work.mkdir()
        home.mkdir()
        for name in FILES:
            _copy(case / name, work / name)
        refusal = _run(command(method), work, environment(home, work), limit)
        answer = _read(work / "products" / "diagnosis.json") if refusal is None else refusal
    finally:
        shutil.rmtree(here, ignore_errors=True)
    return {**answer, "cpu_seconds": round(_cpu_seconds() - before, 3)}


def _copy(source, target):
    """Copy a regular file; of a link, which may lead to any file, nothing is read."""
    try:
        with files.open_regular(source, links=False) as stream, target.open("wb") as copy:
            shutil.copyfileobj(stream, copy)
    except OSError as error:
        raise ConfigError(source, "a regular file of the case", error.strerror or str(error)) from None


def refused(reason):
    """The answer of a case that is not answered."""
    return {"verdict": "refused", "effects": [], "reasons": [reason]}


def _run(arguments, folder, variables, limit):
    """None where the process ends well, else the refusal."""
    with subprocess.Popen(arguments, cwd=folder, env=variables, start_new_session=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        _bound(process)
        try:
            _, stderr = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            return {**refused(f"no answer within {limit:g} s"), "limit": limit}
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
    if -process.returncode in _ENDED:
        raise BrakechainError("a solver process", "to run until its end", f"signal {-process.returncode}",
                              "run the same command to go on")
    lines = [line for line in stderr.splitlines() if line.strip()] or ["it said nothing"]
    return refused(lines[-1][:_LONGEST]) if process.returncode else None


def _bound(process):
    """Hold a process to MEMORY, where the system can: one that grows without end would take others with it."""
    if hasattr(resource, "prlimit"):
        with contextlib.suppress(ProcessLookupError):
            resource.prlimit(process.pid, resource.RLIMIT_AS, (MEMORY, MEMORY))


def _read(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        return refused(f"no readable answer: {type(error).__name__}")


def _cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

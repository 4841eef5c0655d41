"""Inputs tried in a child of this process: what it does not survive, or does not end, is known by number."""

import faulthandler
import json
import os
import select
import signal
import tempfile
import time
import warnings
from dataclasses import asdict

from tests.fuzz.trial import Outcome, in_this_process, outcome

#: seconds of the wall clock after which an input counts as hanging; bytes of memory of the child
PATIENCE, _MEMORY = 60.0, 8_000_000_000
#: the same of a file whose reader has a process with limits, which then shows whether they hold
_SOON = 15.0


def tried(target, seed, numbers, until=float("inf"), patience=PATIENCE):
    """Yield (number, Outcome) of the inputs ``numbers`` (a list or range) of a target, until this time of
    time.monotonic()."""
    while numbers and time.monotonic() < until:
        done = 0
        for number, result in _batch(target, seed, numbers, until, _SOON if target.apart else patience):
            done += 1
            if result.kind in ("hang", "crash") and target.apart:
                result = _alone(target, seed, number, result)
            yield number, result
        if not done:
            return
        numbers = numbers[done:]


def _batch(target, seed, numbers, until, patience):
    """(number, Outcome) as the child tells them; the last one may be a hang or a crash, which ended the child."""
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        os.close(reader)
        _serve(target, seed, numbers, until, writer)
    os.close(writer)
    try:
        with os.fdopen(reader, "rb", buffering=0) as stream:
            yield from _told(stream, numbers, patience, child)
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def _told(stream, numbers, patience, child):
    rest, waiting = b"", iter(numbers)
    number, begin = next(waiting), time.monotonic()
    while True:
        if not select.select([stream], [], [], max(patience - (time.monotonic() - begin), 0))[0]:
            yield number, Outcome("hang", said=f"no answer in {patience:g} s", seconds=patience)
            return
        part = stream.read(1 << 16)
        *lines, rest = (rest + part).split(b"\n")
        for line in lines:
            answer = json.loads(line)
            if answer is None:
                return
            yield number, Outcome(**answer)
            number, begin = next(waiting, None), time.monotonic()
        if not part:
            if number is not None:
                yield number, Outcome("crash", said="its process ended")
            return


def _serve(target, seed, numbers, until, writer):
    """The child: an answer a line, then null; never returns."""
    try:
        import resource

        faulthandler.disable()
        warnings.simplefilter("ignore")  # as a user sees them: tests make errors of them

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        with tempfile.TemporaryDirectory(dir=tempfile.gettempdir()) as folder, in_this_process():
            tempfile.tempdir = folder
            for number in numbers:
                if time.monotonic() > until:
                    break
                result = _made(target, seed, number, folder)
                os.write(writer, json.dumps(asdict(result)).encode() + b"\n")
        os.write(writer, b"null\n")
    finally:
        os._exit(0)


def _made(target, seed, number, folder):
    """Outcome of one input; that the fuzzer itself fails is no fault of a reader, and is told as what it is."""
    try:
        trial = target.trial(seed, number)
    except Exception as error:
        return Outcome("internal", "the fuzzer itself", f"{type(error).__name__}: {error}"[:400])
    return outcome(target, trial, folder)


def _alone(target, seed, number, before):
    """The Outcome by the public entry, whose reader has its own process: one sentence, or a failure indeed."""
    with tempfile.TemporaryDirectory() as folder:
        result = outcome(target, target.trial(seed, number), folder)
    if result.kind in ("refused", "contained"):
        return Outcome("contained", result.how, f"{before.said}; {result.said}"[:400], result.seconds)
    return result

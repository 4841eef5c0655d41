"""kill -9 at any moment, then run again: it finishes with the content of an undisturbed run."""

import os
import random
import signal
import subprocess
import sys
import time

import pytest

from stages import CHAINS
from tests.chain.conftest import QUICK, contents
from tests.commands import ROOT, brakechain

#: a run that dies in the middle of writing one product
DIE_IN_MID_WRITE = """
import os, sys
from pipeline.__main__ import main
from pipeline.contract import store
whole, victim = store.publish, sys.argv[1]
def dying(partial, path):
    if path.name == victim:
        size = partial.stat().st_size
        os.truncate(partial, size // 2)
        os.kill(os.getpid(), 9)
    whole(partial, path)
store.publish = dying
sys.argv = ["brakechain", *sys.argv[2:]]
main()
"""

#: a run that dies some seconds after its first stage has begun to compute
DIE_WHILE_COMPUTING = """
import os, sys, threading
from pipeline.__main__ import main
from pipeline.contract.stage import Stage
whole, seconds = Stage.__call__, float(sys.argv[1])
def dying(*given, **named):
    timer = threading.Timer(seconds, os.kill, (os.getpid(), 9))
    timer.daemon = True
    timer.start()
    return whole(*given, **named)
Stage.__call__ = dying
sys.argv = ["brakechain", *sys.argv[2:]]
main()
"""


def killed_after(seconds, folder, case=QUICK):
    command = [sys.executable, "-m", "pipeline", "run", str(case), "--run", str(folder), "--workers", "2"]
    run = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    run.send_signal(signal.SIGKILL)
    return run.wait()


def killed_while_computing(seconds, folder, case, *settings):
    return _dead(DIE_WHILE_COMPUTING, seconds, folder, case, *settings)


def killed_while_writing(product, folder, case=QUICK, *settings):
    return _dead(DIE_IN_MID_WRITE, f"{product}.h5", folder, case, *settings)


def _dead(script, when, folder, case, *settings):
    command = [sys.executable, "-c", script, str(when), "run", str(case), "--run", str(folder), *settings]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, timeout=900,
                          env={**os.environ, "PYTHONPATH": str(ROOT)})
    return done.returncode


@pytest.mark.parametrize("product", [pytest.param("surface", marks=pytest.mark.slow), "squeal"])
def test_death_in_mid_write(copy, finished, product):
    (copy / f"{product}.h5").unlink()
    assert killed_while_writing(product, copy) == -signal.SIGKILL
    assert not (copy / f"{product}.h5").exists() and (copy / f".{product}.h5.partial").exists()
    brakechain("run", QUICK, "--run", copy)
    assert contents(copy) == contents(finished) and not list(copy.glob(".*.partial"))


@pytest.mark.slow
def test_death_in_mid_write_of_every_stage(tmp_path, finished):
    for product in CHAINS["disc_brake"]:
        assert killed_while_writing(product, tmp_path / "run") == -signal.SIGKILL
    brakechain("run", QUICK, "--run", tmp_path / "run")
    assert contents(tmp_path / "run") == contents(finished)


@pytest.mark.slow
def test_death_at_ten_random_moments(tmp_path, finished):
    moments = random.Random(20211)
    for _ in range(10):
        killed_after(moments.uniform(0.5, 15.0), tmp_path / "run")
    brakechain("run", QUICK, "--run", tmp_path / "run")
    assert contents(tmp_path / "run") == contents(finished)

"""The finest mesh of the paper's whole plates: 6.25 um, 2.02 us, within a minute and a gigabyte."""

import subprocess
import sys
import time

import pytest

RUN = """
import resource
from pipeline.physics.rupture_history import run
from tests.physics.small_ruptures import interface, plates
lower, upper = plates(6.25e-6, length=20e-3, height=5e-3)
run(lower, upper, interface(lower, upper)[0], 2.02e-6)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
def test_the_finest_mesh_fits_into_a_minute_and_a_gigabyte():
    begin = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 1_000_000, "kilobytes"
    assert time.perf_counter() - begin < 60.0

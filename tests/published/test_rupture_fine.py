"""The finest mesh of the paper's whole plates: 6.25 um, 2.02 us, within a minute of one core and a gigabyte."""

import subprocess
import sys

import pytest

RUN = """
import resource
from pipeline.physics.rupture.history import run
from tests.physics.small_ruptures import interface, plates
lower, upper = plates(6.25e-6, length=20e-3, height=5e-3)
run(lower, upper, interface(lower, upper)[0], 2.02e-6)
used = resource.getrusage(resource.RUSAGE_SELF)
print(used.ru_maxrss, used.ru_utime + used.ru_stime)
"""


@pytest.mark.slow
def test_the_finest_mesh_fits_into_a_minute_and_a_gigabyte():
    done = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=True)
    kilobytes, seconds = map(float, done.stdout.split())
    assert kilobytes < 1e6 and seconds < 60.0

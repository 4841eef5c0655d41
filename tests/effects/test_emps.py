"""A real carriage drive: what Coulomb friction explains of its force, by inverse dynamics."""

import os
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.signal import decimate

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Bench, Run
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor
from tests.physics.lumps import lumps

RATE, TRIM, DECIMATION = 1000.0, 100, 10


def recorded(name):
    """(force N, position m) of one record, 1 kHz."""
    found = loadmat(Path(os.environ["BRAKECHAIN_DATA"]) / "recordings" / "emps" / f"{name}.mat")
    return float(found["gtau"].item()) * np.ravel(found["vir"]), np.ravel(found["qm"])


def residual(record, mass, damping, friction):
    force, place = record
    bench = Bench(lumps([mass], [[1.0]], [0.0], [damping]), Hard(), constant(0.0), 1 / RATE,
                  (Sensor("q", DISPLACEMENT, "sensor_0"),))
    bench = named("coulomb").on(bench, "joint_0", {"force": friction})
    run = Run("record", (len(force) - 1) / RATE, RATE, {"input_0": force})
    return equation_residual(bench, run, {"q": place}, corner=100.0, decimation=DECIMATION, trim=TRIM)[0]


def fitted(record, with_friction, mass=95.0):
    """(mass, damping, offset[, Coulomb force]) by least squares: the residual is linear in them."""
    base = residual(record, mass, 0.0, 0.0)
    columns = [residual(record, mass + 1, 0.0, 0.0) - base, residual(record, mass, 1.0, 0.0) - base, np.ones_like(base)]
    if with_friction:
        columns.append(residual(record, mass, 0.0, 1.0) - base)
    return np.array([mass, 0, 0, 0][:len(columns)]) + np.linalg.lstsq(np.column_stack(columns), -base)[0]


@pytest.mark.measured
@pytest.mark.published
def test_coulomb_friction_explains_the_force_of_the_held_out_record():
    """20.4 N and a held-out force error of .17 without, at most .065 with it (Janot, Gautier & Brunot 2019 data)."""
    training, held_out = recorded("DATA_EMPS"), recorded("DATA_EMPS_PULSES")
    measured = decimate(held_out[0][TRIM:-TRIM], DECIMATION, zero_phase=True)
    error = {}
    for with_friction in (False, True):
        mass, damping, offset, *friction = fitted(training, with_friction)
        left = residual(held_out, mass, damping, *(friction or [0.0])) + offset
        error[with_friction] = np.linalg.norm(left) / np.linalg.norm(measured)
    assert friction[0] == pytest.approx(20.4, abs=0.3)
    assert error[False] == pytest.approx(0.170, abs=0.005) and error[True] < 0.065

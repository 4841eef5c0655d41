"""Samples that show what nobody states: before a record, while a hammer is in contact, behind jumps."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.runs import Recorded
from pipeline.diagnosis.signals.unseen import without_course, without_jumps, without_past
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.response import Bench, Run
from pipeline.physics.virtual_rig.sensor import ACCELERATION, VELOCITY, Sensor
from tests.physics.lumps import lumps

RATE, SAMPLES = 100.0, 60
#: forgets within 0.02 s + 7 / (2 pi 25 Hz) = 0.0646 s
SLOW = Sensor("a", ACCELERATION, "sensor_0", corner=25.0, delay=0.02)
PLAIN = Sensor("b", ACCELERATION, "sensor_0")
MOVING = Sensor("v", VELOCITY, "sensor_0", corner=25.0)
BENCH = Bench(lumps([1.0], [[1.0]], [100.0], [1.0]), Hard(), constant(0.0), 1e-3, (SLOW, PLAIN, MOVING))


def recorded(force=0.0, held=()):
    run = Run("r", (SAMPLES - 1) / RATE, RATE, {"input_0": force}, held=held)
    shape = 3, SAMPLES
    return Recorded(run, ("a", "b", "v"), ("m/s^2", "m/s^2", "m/s"), np.ones(shape), np.ones(shape, bool), "")


def left_out(record):
    """[(first, last) sample that does not count of each channel, or ()]."""
    return [tuple(np.flatnonzero(~valid)[[0, -1]]) if not valid.all() else () for valid in record.valid]


def test_filters_and_delays_carry_over_what_was_before_a_record():
    assert left_out(without_past(BENCH, recorded())) == [(0, 6), (), (0, 4)]


def test_accelerations_and_velocities_do_not_count_while_a_hammer_is_in_contact():
    assert left_out(without_course(BENCH, recorded(), 0.095, 0.05)) == [(10, 20), (10, 14), (10, 18)]


def test_accelerometers_do_not_count_behind_a_jump_unless_jumps_are_many():
    force = np.where(np.arange(SAMPLES) < 30, 1.0, -1.0)
    assert left_out(without_jumps(BENCH, recorded(force, ("input_0",)))) == [(30, 36), (), ()]
    same = recorded(force)
    assert without_jumps(BENCH, same) is same
    many = recorded(np.arange(SAMPLES) % 2.0, ("input_0",))
    assert without_jumps(BENCH, many) is many


@pytest.mark.parametrize("without", [without_past, without_jumps, lambda b, r: without_course(b, r, 0.1, 0.05)])
def test_what_is_missing_stays_missing(without):
    record = recorded(np.where(np.arange(SAMPLES) < 30, 1.0, -1.0), ("input_0",))
    record = replace(record, valid=np.zeros_like(record.valid))
    assert not without(BENCH, record).valid.any()

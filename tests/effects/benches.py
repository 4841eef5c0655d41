"""Small benches on which every effect can be seen."""

from dataclasses import replace

import numpy as np
from scipy.linalg import expm

from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Start, Table
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import (
    ACCELERATION,
    DISPLACEMENT,
    FRICTION_FORCE,
    NORMAL_FORCE,
    VELOCITY,
    Sensor,
)
from tests.physics.lumps import lumps

RATE = 2000.0


def sprung(law=None, mass=1.0, stiffness=400.0, damping=0.4, step=1e-4):
    """One mass on one joint, pushed by input_0, seen by ``x``, ``v``, ``a``."""
    channels = tuple(Sensor(name, measurand, "sensor_0") for name, measurand in
                     (("x", DISPLACEMENT), ("v", VELOCITY), ("a", ACCELERATION)))
    return Bench(lumps([mass], [[1.0]], [stiffness], [damping]), law or Hard(), constant(0.0), step, channels)


def let_go(place, speed=0.0, duration=0.5):
    """A run of ``sprung`` from a place (m) and a speed (m/s)."""
    return Run("let go", duration, RATE, start=Start(np.array([place]), np.array([speed])))


def rubbing(law=None, friction=None, speed=2.0, step=1e-4):
    """A mass that slides on two contacts, a tilting block: x along, y away, a little rotation; pressed by input_1."""
    rows = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    model = lumps([1.0, 1.0, 0.5], rows, [4e3, 500.0, 300.0], [6.0, 5.0, 4.0], [[0.1, 1, 0.3], [0.1, 1, -0.3]],
                  [[1, 0, 0.1], [1, 0, 0.1]], speed)
    contacts = replace(model.contacts, position=np.array([[0.1, 0, 0], [0, 0.1, 0]]), area=np.full(2, 1e-3),
                       lateral=np.array([[0, 0, 0.2], [0, 0, 0.2]]))
    channels = (Sensor("x", DISPLACEMENT, "sensor_0"), Sensor("y", DISPLACEMENT, "sensor_1"),
                Sensor("turn", DISPLACEMENT, "sensor_2"), Sensor("n", NORMAL_FORCE, "contact"),
                Sensor("t", FRICTION_FORCE, "contact"))
    return Bench(replace(model, contacts=contacts), law or Penalty(2e4), friction or constant(0.3), step, channels,
                 {"left": (0,), "right": (1,)}, settled=True, doublets={"tilt": (1, 2)})


def tabled():
    """The contact law of ``rubbing`` as a table."""
    return Table(np.array([0.0, 1e-2]), np.array([0.0, 2e4 * 1e-2 / 1e-3]))


def pressed(duration=0.3):
    """A run of ``rubbing``: pressed by 40 N, shaken along and across, the drive slowing down and turning round."""
    run = Run("pressed", duration, RATE, conditions={"input_1": -40.0, "humidity": 0.8})
    swing = np.sin(60 * run.time)
    return replace(run, inputs={"input_0": 6 * swing, "input_1": -40 + 8 * np.sin(35 * run.time)},
                   drive=2.0 - 2.5 * run.time / duration)


def slider(law=None, friction=None, speed=2.0, area=1e-3, step=1e-4):
    """A mass of 1 kg on a joint of 400 N/m along a belt, on which input_1 presses it; steady from the begin."""
    model = lumps([1.0, 1.0], [[1.0, 0.0]], [400.0], [2.0], [[0.0, 1.0]], [[1.0, 0.0]], speed)
    model = replace(model, contacts=replace(model.contacts, area=np.array([area])))
    channels = (Sensor("x", DISPLACEMENT, "sensor_0"), Sensor("y", DISPLACEMENT, "sensor_1"),
                Sensor("n", NORMAL_FORCE, "contact"), Sensor("t", FRICTION_FORCE, "contact"))
    return Bench(model, law or Penalty(2e4), friction or constant(0.3), step, channels, settled=True)


def anchored(friction, mass=1e9):
    """A ``slider`` so heavy along the belt that it stays where it is, on a stiffer, damped contact; 2 m/s."""
    bench = slider(Penalty(1e6), friction)
    matrix, damping = np.diag([mass, 1.0]), np.diag([0.0, 600.0])
    channels = (bench.channels[0], *bench.channels[2:])
    return replace(bench, model=replace(bench.model, mass=matrix, damping=damping), channels=channels)


def round_disc(doublets=None):
    """Two modes of 20 rad/s, ``x`` and ``y``, of a disc without damping."""
    channels = (Sensor("x", DISPLACEMENT, "sensor_0"), Sensor("y", DISPLACEMENT, "sensor_1"))
    model = lumps([1.0, 1.0], np.eye(2), [400.0, 400.0])
    return Bench(model, Hard(), constant(0.0), 1e-4, channels,
                 doublets={"disc": (0, 1)} if doublets is None else doublets)


def struck(speed=0.0, duration=3.0):
    """A run of ``round_disc`` from a blow along its first mode, at a speed of the drive (rad/s)."""
    return Run("struck", duration, RATE, drive=speed, start=Start(np.zeros(2), np.array([0.1, 0.0])))


def swung(bench, angular, duration=8.0):
    """(run, late, x) of ``sprung`` under cos(``angular`` t) N; ``late`` is where the start has rung down."""
    run = Run("swung", duration, RATE)
    run = replace(run, inputs={"input_0": np.cos(angular * run.time)})
    return run, run.time > duration - 1, respond(bench, run)["x"]


def at_angles(model, *angles, area=None):
    """The model with its contacts on a circle of 0.1 m, of one ``area`` (m^2) where it is given."""
    position = 0.1 * np.array([[np.cos(a), np.sin(a), 0.0] for a in angles])
    area = model.contacts.area if area is None else np.full(len(angles), area)
    return replace(model, contacts=replace(model.contacts, position=position, area=area))


def evolved(matrix, start, run):
    """(states, samples) of x' = ``matrix`` x from ``start`` over a run."""
    states, one = [np.array(start, float)], expm(np.array(matrix) / run.sample_rate)
    for _ in run.time[1:]:
        states.append(one @ states[-1])
    return np.array(states).T


def steady(load=40.0, duration=0.1, speed=None):
    """A run of ``slider`` under one load (N) at one speed (rad/s)."""
    return Run("steady", duration, RATE, {"input_1": -load}, drive=speed)


def period(values):
    """Mean time in s between falls through zero, of samples at RATE."""
    falls = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    return np.diff(falls + values[falls] / (values[falls] - values[falls + 1])).mean() / RATE

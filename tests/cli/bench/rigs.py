"""Small records of rigs, as files that a user may have."""

import numpy as np


def driven(folder, name="shaft.csv", sign=1, seed=0, friction=0.0, samples=3000, rate=250.0):
    """A CSV of a shaft of 0.1 kg m^2 with 0.3 N m s/rad and dry ``friction`` N m under a wandering torque."""
    rng, time = np.random.default_rng(seed), np.arange(samples) / rate
    angle = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in zip(
        (0.5, 0.2, 0.1), rng.uniform(0.3, 2.0, 3), rng.uniform(0, 6, 3), strict=True))
    speed = np.gradient(angle, 1 / rate)
    torque = 0.1 * np.gradient(speed, 1 / rate) + 0.3 * speed + friction * np.tanh(speed / 1e-3)
    torque = sign * torque + 2e-3 * rng.standard_normal(samples)
    angle = angle + 1e-5 * rng.standard_normal(samples)
    file = folder / name
    np.savetxt(file, np.column_stack((time, angle, torque)), delimiter=",", header="time,angle,torque", comments="",
               fmt="%.9g")
    return file


def decays(folder):
    """A CSV of three free decays of 3 Hz, one behind the other."""
    rate, time = 200.0, np.arange(800) / 200.0
    rows = [size * np.exp(-0.4 * time) * np.cos(2 * np.pi * 3 * time) for size in (1.0, 2.0, 3.0)]
    motion = np.concatenate(rows) + 1e-3 * np.random.default_rng(3).standard_normal(2400)
    file = folder / "decays.csv"
    np.savetxt(file, np.column_stack((np.arange(2400) / rate, motion)), delimiter=",", header="t,x [mm]", comments="",
               fmt="%.9g")
    return file


def drop(folder, name, seed=0):
    """A CSV of the 54 heights that a video saw of a ball that falls from 47 m."""
    time = np.arange(54) / 15.0
    height = 47.0 - 4.905 * time**2 * (1 - 0.05 * time) + 0.02 * np.random.default_rng(seed).standard_normal(54)
    file = folder / name
    np.savetxt(file, np.column_stack((time, height)), delimiter=",", header="Time (s),Height (m)", comments="",
               fmt="%.9g")
    return file

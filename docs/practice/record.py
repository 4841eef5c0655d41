"""A practice rig: writes recordings of a carriage with an arm that hide one effect. Read this file last.

    python docs/practice/record.py docs/practice/rig.h5 --hidden 1          (1, 2 or 3; 0 hides nothing)

It has its own equations, integrator (adaptive Runge-Kutta 8) and noise: nothing of the diagnosis is imported.
"""

import argparse

import h5py
import numpy as np
from scipy.integrate import solve_ivp

RATE, DURATION, NOISE = 200.0, 4.0, 1e-4
CARRIAGE, ARM = 5.3, 0.94                       # kg; the case says 5 and 1
GUIDE, JOINT = (5200.0, 11.0), (2350.0, 1.6)    # N/m, N s/m; the case says 5000, 10 and 2500, 1.5


def hidden_forces(which, carriage, speed, bend):
    """Forces (on the guide, on the joint) in N that are missing in the case."""
    guide = 2.0 * np.tanh(speed / 1e-3) if which == 1 else 0.0
    joint = 4e6 * bend**3 if which == 2 else 0.0
    return guide + (40.0 * speed * abs(speed) if which == 3 else 0.0), joint


def force(time, level, sweep):
    """A sine sweep in N, from the first to the second frequency of ``sweep`` in Hz."""
    start, end = sweep
    return level * np.sin(2 * np.pi * (start + 0.5 * (end - start) * time / DURATION) * time)


def record(which, level, sweep, random):
    """Samples of force (N), carriage (m) and arm (m) of one run."""
    def rates(time, state):
        x, y, vx, vy = state
        guide, joint = hidden_forces(which, x, vx, y - x)
        guide += GUIDE[0] * x + GUIDE[1] * vx
        joint += JOINT[0] * (y - x) + JOINT[1] * (vy - vx)
        return [vx, vy, (force(time, level, sweep) - guide + joint) / CARRIAGE, -joint / ARM]

    time = np.arange(int(RATE * DURATION) + 1) / RATE
    motion = solve_ivp(rates, (0, time[-1]), np.zeros(4), "DOP853", time, rtol=1e-9, atol=1e-12, max_step=2e-3)
    noise = NOISE * random.standard_normal((2, len(time)))
    return force(time, level, sweep), motion.y[0] + noise[0], motion.y[1] + noise[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--hidden", type=int, default=1, choices=range(4))
    arguments = parser.parse_args()
    random = np.random.default_rng(arguments.hidden)
    with h5py.File(arguments.file, "w") as h5:
        for name, level, sweep in (("soft", 6.0, (1, 12)), ("middle", 12.0, (12, 1)), ("loud", 24.0, (1, 12)),
                                   ("check", 18.0, (2, 9))):
            run = h5.create_group(f"runs/{name}")
            run.attrs["description"] = f"sweep {sweep[0]} to {sweep[1]} Hz, {level:g} N"
            for channel, values, unit, quantity, role in zip(
                    ("force", "carriage", "arm"), record(arguments.hidden, level, sweep, random), ("N", "m", "m"),
                    ("force", "displacement", "displacement"), ("excitation", "response", "response"), strict=True):
                data = run.create_dataset(f"channels/{channel}", data=values)
                data.attrs.update(units=unit, quantity=quantity, sample_rate=RATE, role=role)


if __name__ == "__main__":
    main()

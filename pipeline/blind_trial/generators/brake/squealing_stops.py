"""Stops of the practice brake that squeal: from quiet sliding through the growth of a mode to its limit cycle.

The brake is that of ``brake_parts`` on inclined abutments (``squealing_brake``), so that friction makes it flutter. A
lining lifts off where it would have to pull, and its friction turns with the slip v,

    N = max(p_0 (a / a_0)^(1 + e) + d a', 0),    T = b(t) mu N (N / p_0)^f (1 + r exp(-|v| / v_s)) tanh(v / v_t),

b from 0 to 1 while the linings wipe the disc clean. Every stop has its own friction and pressure, a little off; rough
faces shake the pads. Steps are exponential ones of second order (S. M. Cox, P. C. Matthews, J. Comput. Phys. 176 (2002)
430) about the brake with closed contacts and no friction, all stops of a brake at once.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm
from scipy.signal import butter, sosfilt

from pipeline.blind_trial.generators.brake import brake
from pipeline.blind_trial.generators.brake.brake_parts import PADS
from pipeline.contract.errors import ConfigError

#: (force N of the piston, speed rad/s) of the operating points, and stops at each
POINTS = ((700.0, 1.0), (1500.0, 1.0), (3000.0, 1.0), (1500.0, 2.0), (1500.0, 4.0), (3000.0, 2.0))
STOPS = 3
#: what a stop records beside the channels of taps: quantity, unit, noise
FURTHER = {"caliper": ("acceleration", "m/s^2", 0.01), "pressure": ("pressure", "Pa", 500.0),
           "torque": ("torque", "N m", 0.05)}
#: area of the piston in m^2
PISTON = 2.5e-3
#: s of a record, and from when to when friction builds up; steps a sample
DURATION, _WIPED, _FINE = 0.4, (0.06, 0.085), 8
#: slip over which friction turns, m/s; relative deviations of friction and pressure from stop to stop; N of rough faces
_TURNS, _FRICTION, _PRESSURE, _ROUGH = 0.012, 0.01, 0.005, 0.02
#: physics that only the linear model of taps has
_NOT_HERE = ("shim_damping", "contact_memory")
#: corner in Hz, error of gains that a calibration leaves, bits of a converter over the range of its channel
_CORNER, _GAIN, _BITS = 10e3, 0.002, 24


@dataclass(frozen=True)
class _Points:
    """Columns (s,) of the stops: force N, speed rad/s, friction over the brake's."""

    load: np.ndarray
    speed: np.ndarray
    friction: np.ndarray


def name(load, speed):
    """Name of an operating point."""
    return f"stop_{load:g}N_{speed:g}"


def record(whole, seed, points=POINTS):
    """{run: dict} of STOPS stops at every operating point, as ``case_files.leave`` takes it."""
    random = np.random.default_rng([seed, 4])
    count = STOPS * len(points)
    columns = _Points(np.repeat([load for load, _ in points], STOPS) * (1 + _PRESSURE * random.standard_normal(count)),
                      np.repeat([speed for _, speed in points], STOPS).astype(float),
                      1 + _FRICTION * random.standard_normal(count))
    motion, torque = simulated(whole, columns, random)
    gain = 1 + _GAIN * random.standard_normal(motion.shape[0])
    runs = {}
    for k in range(count):
        load, speed = points[k // STOPS]
        first, again = f"{name(load, speed)}_1", k % STOPS + 1
        runs[f"{name(load, speed)}_{again}"] = {
            "description": "stop that squeals", "repeat_of": first if again > 1 else "",
            "conditions": {"press": (load, "N"), "speed": (speed, "rad/s")},
            "channels": _recorded(gain[:, None] * motion[:, k], torque[k], columns.load[k], random)}
    return runs


def growing(whole, load, speed):
    """Root in rad/s of the mode that grows fastest at a force N and a speed rad/s; of a brake in quiet, that decays
    slowest."""
    roots = np.linalg.eigvals(brake.small_motion(whole, brake.Run("", load, speed, 0.0)))
    roots = roots[roots.imag > 0]
    return complex(roots[np.argmax(roots.real)])


def simulated(whole, columns, random, duration=DURATION):
    """(velocities (7, s, n) m/s of the sensors and the caliper, torque (s, n) N m) of stops, _FINE steps a sample."""
    forces, step = _Forces(whole, columns), 1 / (brake.RATE * _FINE)
    size, count = len(whole.mass), round(duration * brake.RATE * _FINE)
    propagate, first, second = _exponentials(forces, step)
    state = np.zeros((2 * size, len(columns.load)))
    state[:size] = forces.quiet()
    rows = np.vstack((whole.sensors, np.eye(size)[whole.disc + 6]))
    motion, torque = np.zeros((len(rows), len(columns.load), count)), np.zeros((len(columns.load), count))
    shaken = forces.shaken(random, count)
    for k in range(count):
        force, torque[:, k] = forces.at(state, k * step)
        force = force + shaken(k)
        middle = propagate @ state + first @ force
        motion[:, :, k] = rows @ state[size:]
        state = middle + second @ (forces.at(middle, (k + 1) * step)[0] + shaken(k) - force)
    return motion, torque


class _Forces:
    """Forces (n, s) of the linings beyond those of closed contacts without friction, for all stops at once."""

    def __init__(self, whole, columns):
        hidden = whole.hidden
        if there := [name for name in _NOT_HERE if name in hidden]:
            raise ConfigError("squealing stops", f"no {' or '.join(_NOT_HERE)}", there[0], "tap this brake instead")
        self.whole, self.columns = whole, columns
        self.share = whole.share[:, None]
        self.exponent = hidden.get("contact_stiffness_law", {}).get("exponent", 0.0)
        self.loss = self.share * hidden.get("contact_damping", {}).get("damping", 0.0)
        self.slope = self.share * whole.values["contact"]
        self.reach = (1 + self.exponent) * brake.REFERENCE / whole.values["contact"]
        falling = hidden.get("falling_friction", {"rise": 0.0, "decay_speed": 1.0})
        self.rise, self.decay = falling["rise"], falling["decay_speed"]
        self.power = hidden.get("pressure_dependent_friction", {}).get("exponent", 0.0)
        self.cubic = hidden.get("cubic_stiffness")
        self.stiffness = whole.stiffness + (whole.normal.T * self.slope[:, 0]) @ whole.normal
        self.damping = whole.damping + (whole.normal.T * self.loss[:, 0]) @ whole.normal

    def at(self, state, time):
        """(forces (n, s), torque (s,)) in a state (2 n, s)."""
        whole, size = self.whole, len(self.whole.mass)
        displacement, velocity = state[:size], state[size:]
        approach, closing = -whole.normal @ displacement, -whole.normal @ velocity
        near = np.maximum(approach, 0.0)
        if self.exponent:
            press = brake.REFERENCE * self.share * (near / self.reach) ** (1 + self.exponent)
        else:
            press = self.slope * near
        press = np.maximum(press + self.loss * closing * (approach > 0), 0.0)
        slip = self.columns.speed * whole.radius[:, None] - whole.tangent @ velocity
        drawn = self._friction(press, slip, time)
        force = whole.normal.T @ (press - self.slope * approach - self.loss * closing) + whole.tangent.T @ drawn
        force = force + np.outer(whole.press, self.columns.load)
        if self.cubic:
            at = whole.disc + 3 * self.cubic["pad"]
            force[at] -= self.cubic["coefficient"] * displacement[at] ** 3
        return force, whole.radius @ drawn

    def _friction(self, press, slip, time):
        """Forces (c, s) along sliding."""
        built_up = np.clip((time - _WIPED[0]) / (_WIPED[1] - _WIPED[0]), 0.0, 1.0)
        size = built_up**3 * (10 - 15 * built_up + 6 * built_up**2) * self.whole.values["friction"]
        drawn = size * self.columns.friction * press * np.tanh(slip / _TURNS)
        if self.rise:
            drawn = drawn * (1 + self.rise * np.exp(-abs(slip) / self.decay))
        if self.power:
            drawn = drawn * (np.maximum(press, 1e-9) / (brake.REFERENCE * self.share)) ** self.power
        return drawn

    def quiet(self):
        """Displacements (n, s) of the brake that is pressed without friction, by Newton's method."""
        place = np.linalg.solve(self.stiffness, np.outer(self.whole.press, self.columns.load))
        for _ in range(50):
            force, _ = self.at(np.vstack((place, 0 * place)), 0.0)
            step = np.linalg.solve(self.stiffness, force) - place
            place = place + 0.5 * step if self.exponent else place + step
            if abs(step).max() < 1e-13:
                break
        return place

    def shaken(self, random, count):
        """Function of the step: forces (n, s) that rough faces exert on the pads, new at every step."""
        rows = np.zeros((len(self.whole.mass), 2 * len(PADS)))
        for k in range(len(PADS)):
            rows[[self.whole.disc + 3 * k, self.whole.disc + 3 * k + 1], [2 * k, 2 * k + 1]] = 1.0
        drawn = _ROUGH * random.standard_normal((count, rows.shape[1], len(self.columns.load))).astype(np.float32)
        return lambda k: rows @ drawn[k]


def _exponentials(forces, step):
    """(state to state, force to state, growth of force to state) over a step of the brake without the forces."""
    size = len(forces.stiffness)
    matrix = np.zeros((4 * size, 4 * size))
    matrix[:size, size:2 * size] = np.eye(size)
    inverse = np.linalg.inv(forces.whole.mass)
    matrix[size:2 * size, :2 * size] = -inverse @ np.hstack((forces.stiffness, forces.damping))
    matrix[size:2 * size, 2 * size:3 * size] = inverse
    matrix[2 * size:3 * size, 3 * size:] = np.eye(size) / step
    whole = expm(matrix * step)[:2 * size]
    return whole[:, :2 * size], whole[:, 2 * size:3 * size], whole[:, 3 * size:]


def _recorded(motion, torque, load, random):
    """{channel: (samples, unit, quantity, rate, role)} of one stop of velocities (7, n), torque (n,) at fine steps."""
    guard = butter(4, _CORNER, fs=brake.RATE * _FINE, output="sos")
    channels = {}
    sources = [*zip(brake.CHANNELS.items(), motion[:6], strict=True), (("caliper", "acceleration"), motion[6])]
    for (channel, quantity), values in sources:
        if quantity == "acceleration":
            values = np.gradient(values, 1 / (brake.RATE * _FINE))
        unit, noise = {"velocity": ("m/s", 5e-7), "acceleration": ("m/s^2", 0.01)}[quantity]
        channels[channel] = _channel(sosfilt(guard, values), unit, quantity, noise, random)
    for channel, values in (("pressure", np.full(len(torque), load / PISTON)), ("torque", torque)):
        quantity, unit, noise = FURTHER[channel]
        channels[channel] = _channel(sosfilt(guard, values), unit, quantity, noise, random)
    return channels


def _channel(values, unit, quantity, noise, random):
    values = values[::_FINE] + noise * random.standard_normal(len(values[::_FINE]))
    step = 2.5 * abs(values).max() / 2**_BITS
    return (step * np.round(values / step)).astype(np.float32), unit, quantity, brake.RATE, "response"

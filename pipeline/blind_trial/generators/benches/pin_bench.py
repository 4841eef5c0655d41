"""A practice bench: a tilted pin on a turning disc, with values that nobody knows and physics that nobody was told of.

The pin is a Hermite beam of 30 elements in its own modes, the disc doublets cos/sin n theta, the carriage of the pin a
mass on an arm. With tip coordinates t (along sliding) and n (opening), a = -(n + runout) the approach,

    m_k q_k'' + 2 z_k m_k w_k q_k' + m_k w_k^2 q_k = n_k N + t_k T + f_k,   N = max(k a + d a', 0),   T = mu N sgn(v),

v = V - t' the slip, its sign smoothed by tanh. Integrated by Runge-Kutta's classical rule, 384 steps a millisecond;
the recorder filters (Butterworth, order 4), adds noise, delays, clips nothing and rounds to 16 bits.
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.linalg import eigh
from scipy.signal import butter, sosfilt

from pipeline.contract.errors import ConvergenceError

#: what can be hidden, with the sizes it is given: low and high of a draw
HIDDEN = {
    "falling_friction": {"rise": (0.03, 0.1), "decay_speed": (0.05, 0.12)},
    "contact_memory": {"length": (1.5e-6, 6e-6)},
    "contact_stiffness_law": {"exponent": (0.25, 0.6)},
    "doublet_split": {"share": (0.006, 0.02), "angle": (0.3, 1.2)},
    "moving_base": {"compliance": (1e-7, 3e-7), "frequency": (400.0, 1200.0)},
    "runout": {"amplitude": (2e-6, 8e-6), "phase": (-3.0, 3.0)},
    "joint_damping": {"damping": (40.0, 150.0)},
    "contact_damping": {"damping": (10.0, 40.0)},
    "pressure_dependent_friction": {"exponent": (-0.4, -0.15)},
}
#: decoys: what a sensor, not physics, does
DECOYS = {"sensor_gain": {"error": (0.2, 0.5)}, "sensor_delay": {"delay": (50e-6, 150e-6)}}
#: relative standard deviation of each kind of value about the nominal one
SPREAD = {"frequency": 0.02, "mass": 0.1, "damping": 0.3, "stiffness": 0.2, "friction": 0.15}
STEP, RATE = 1 / 384e3, 25.6e3
#: seconds that are recorded after a tap: at rest, in sliding
DURATIONS = (0.35, 0.25)
_DISC = {"rocking": 600.0, "two": 1020.0, "three": 2247.0, "four": 3890.0, "five": 5900.0, "six": 8200.0}
_PIN = ("first", "second", "third", "fourth")
_DISC_LOSS, _PIN_LOSS = 0.0015, 0.004
_THICKNESS, RADIUS, _OUTER, _DENSITY, _YOUNG = 0.025, 0.159, 0.179, 2700.0, 70e9
_SIDE, _LENGTH, _TILT, _OFFSET, _HEIGHT = 0.01, 0.1515, np.radians(4.0), -0.0045, 0.05
_LASER_ANGLE, _HIT_ANGLE = np.radians(160.0), np.radians(40.0)
_CARRIAGE, _ARM, _ARM_DAMPING = 0.1, 2e6, 20.0
_CONTACT, _SHEAR, _FRICTION = 3e6, 2.4e6, 0.3
_REFERENCE_LOAD, _SMOOTH = 15.0, 6e-3
_NOISE = {"laser_disc": 5e-7, "laser_pin": 5e-7, "accelerometer": 0.01, "load_cell": 0.02}
_LOADS, _SPEEDS = (8.0, 15.0, 28.0), (0.25, 0.5, 1.0)
#: iterations for the contact force of steady sliding
_STEADY = 400


@dataclass(frozen=True)
class Bench:
    """Modal coordinates (n,): ``mass`` kg, ``squared`` rad^2/s^2, ``damping`` N s/m, rows of the tip and sensors.

    ``coupling`` (n, n) N/m beside the diagonal; ``hidden`` {effect: values}; ``sensors`` (3, n): disc, pin, pin.
    """

    mass: np.ndarray
    squared: np.ndarray
    damping: np.ndarray
    coupling: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    press: np.ndarray
    sensors: np.ndarray
    hit: np.ndarray
    contact: float
    shear: float
    friction: float
    arm: np.ndarray
    hidden: dict = field(default_factory=dict)


def make(seed, hidden=(), decoys=()):
    """(Bench, truth) of a draw: every value off, with effects ``hidden`` and sensors that are wrong (``decoys``)."""
    random = np.random.default_rng(seed)
    values = {name: {key: float(random.uniform(*ends)) for key, ends in {**HIDDEN, **DECOYS}[name].items()}
              for name in (*hidden, *decoys)}
    if "doublet_split" in values:
        values["doublet_split"]["order"] = int(random.choice((2, 3)))
    if set(decoys):
        values[decoys[0]]["channel"] = str(random.choice(("laser_pin", "accelerometer")))
    factors = {}

    def off(name, kind):
        factors[name] = float(np.exp(SPREAD[kind] * random.standard_normal()))
        return factors[name]

    bench = _bodies(off)
    bench = replace(bench, contact=_CONTACT * off("contact.stiffness", "stiffness"),
                    shear=_SHEAR * off("contact.tangential_stiffness", "stiffness"),
                    friction=_FRICTION * off("friction", "friction"), hidden=values)
    return with_structure(bench, values), {"factors": factors, "hidden": values}


class _Coordinate(NamedTuple):
    """One modal coordinate: see Bench; ``loss`` is its damping ratio, ``seen`` by the sensors, ``struck`` by a tap."""

    mass: float
    frequency: float
    loss: float
    normal: float
    tangent: float
    seen: tuple = (0.0, 0.0, 0.0)
    struck: tuple = (0.0, 0.0)
    press: float = 0.0
    arm: float = 0.0


def _bodies(off):
    """The Bench of disc, pin and carriage, every value times its ``off(name, kind)``."""
    columns = {key: np.array(column, float) for key, column in zip(
        _Coordinate._fields, zip(*_disc(off), *_pin(off), _carriage(off), strict=True), strict=True)}
    mass, rate = columns["mass"], 2 * np.pi * columns["frequency"]
    return Bench(mass, rate**2, 2 * columns["loss"] * mass * rate, np.zeros((len(mass),) * 2), columns["normal"],
                 columns["tangent"], columns["press"], columns["seen"].T, columns["struck"].T, _CONTACT, _SHEAR,
                 _FRICTION, columns["arm"])


def _disc(off):
    """Doublets with w = (r / radius of the contact)^n cos n theta, sin n theta on a plate; faces turn with slopes."""
    for n, (name, frequency) in enumerate(_DISC.items(), 1):
        mass = _DENSITY * _THICKNESS * np.pi * _OUTER**2 * (_OUTER / RADIUS) ** (2 * n) / (2 * n + 2)
        mode = (mass * off(f"{name}.mass", "mass"), frequency * off(f"{name}.frequency", "frequency"),
               _DISC_LOSS * off(f"{name}.damping", "damping"))
        for wave, normal, tangent in ((np.cos, -1.0, 0.0), (np.sin, 0.0, n * _THICKNESS / (2 * RADIUS))):
            yield _Coordinate(*mode, normal, tangent, (wave(n * _LASER_ANGLE), 0, 0), (0, wave(n * _HIT_ANGLE)))


def _pin(off):
    """Modes of the tilted beam, which touches with its edge."""
    for name, mass, frequency, slope, seen in zip(_PIN, *beam_modes(), strict=True):
        yield _Coordinate(mass * off(f"{name}.mass", "mass"), frequency * off(f"{name}.frequency", "frequency"),
                          _PIN_LOSS * off(f"{name}.damping", "damping"), np.sin(_TILT) + _OFFSET * slope,
                          np.cos(_TILT), (0, seen, seen), (seen, 0))


def _carriage(off):
    """The mass on the arm."""
    stiffness = _ARM * off("arm.stiffness", "stiffness")
    rate = np.sqrt(stiffness / _CARRIAGE)
    return _Coordinate(_CARRIAGE, rate / (2 * np.pi), _ARM_DAMPING / (2 * _CARRIAGE * rate), 1.0, 0.0, press=-1.0,
                       arm=stiffness)


def beam_modes(length=_LENGTH, count=4, elements=30):
    """(mass, frequency, slope, seen) of the modes of a clamped beam, 1 at its tip: kg, Hz, 1/m, 1 at the sensor."""
    area, inertia, size = _SIDE**2, _SIDE**4 / 12, length / elements
    k = _YOUNG * inertia / size**3 * np.array([[12, 6 * size, -12, 6 * size],
                                               [6 * size, 4 * size**2, -6 * size, 2 * size**2],
                                               [-12, -6 * size, 12, -6 * size],
                                               [6 * size, 2 * size**2, -6 * size, 4 * size**2]])
    m = _DENSITY * area * size / 420 * np.array([[156, 22 * size, 54, -13 * size],
                                                 [22 * size, 4 * size**2, 13 * size, -3 * size**2],
                                                 [54, 13 * size, 156, -22 * size],
                                                 [-13 * size, -3 * size**2, -22 * size, 4 * size**2]])
    stiffness, mass = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for e in range(elements):
        block = slice(2 * e, 2 * e + 4)
        stiffness[block, block] += k
        mass[block, block] += m
    squared, shape = eigh(stiffness[2:, 2:], mass[2:, 2:], subset_by_index=(0, count - 1))
    shape = shape / shape[-2]
    position = size * np.arange(1, elements + 1)
    seen = [np.interp(length - _HEIGHT, position, column) for column in shape[::2].T]
    modal = np.einsum("ik,ij,jk->k", shape, mass[2:, 2:], shape)
    return modal, np.sqrt(squared) / (2 * np.pi), shape[-1], np.array(seen)


def with_structure(bench, hidden):
    """Split doublets, a base that moves and a damper at the arm, where they are hidden."""
    if split := hidden.get("doublet_split"):
        first = 2 * (split["order"] - 1)
        size = 2 * split["share"] * bench.mass[first] * bench.squared[first]
        a, b = size / 2 * np.cos(2 * split["angle"]), size / 2 * np.sin(2 * split["angle"])
        coupling = bench.coupling.copy()
        coupling[first:first + 2, first:first + 2] += [[a, b], [b, -a]]
        bench = replace(bench, coupling=coupling)
    if joint := hidden.get("joint_damping"):
        damping = bench.damping.copy()
        damping[-1] += joint["damping"]
        bench = replace(bench, damping=damping)
    if base := hidden.get("moving_base"):
        bench = _with_base(bench, 1 / base["compliance"], base["frequency"])
    return bench


def _with_base(bench, stiffness, frequency):
    """A mass on a spring behind the arm, as one more coordinate."""
    arm, loss = bench.arm[-1], bench.damping[-1]
    mass = stiffness / (2 * np.pi * frequency) ** 2
    grown = {name: np.append(getattr(bench, name), 0.0) for name in ("normal", "tangent", "press")}
    coupling = np.pad(bench.coupling, (0, 1))
    coupling[-1, -2] = coupling[-2, -1] = -arm
    return replace(bench, **grown, mass=np.append(bench.mass, mass), coupling=coupling,
                   squared=np.append(bench.squared, (stiffness + arm) / mass), damping=np.append(bench.damping, loss),
                   sensors=np.pad(bench.sensors, ((0, 0), (0, 1))), hit=np.pad(bench.hit, ((0, 0), (0, 1))),
                   arm=np.append(bench.arm, -arm))


def record(bench, seed, taps=(1e-4, 1e-5)):
    """{run: dict} of a whole campaign, each as ``recordings.neutral.write_neutral`` takes it.

    ``taps`` N s: size of a blow at rest and in sliding.

    Taps on the lifted pin and disc, at rest under three loads, and in sliding under three loads and speeds, each
    twice; and one turn by hand under the load cell. Raises ConvergenceError where no steady sliding is found.
    """
    random, runs = np.random.default_rng(seed + 1), {}
    plan = [("lifted", 0.0, 0.0)] + [(f"rest_{load:g}N", load, 0.0) for load in _LOADS]
    plan += [(f"sliding_{load:g}N_{speed:g}", load, speed)
             for load, speed in [*((load, _SPEEDS[1]) for load in _LOADS), *((_LOADS[1], s) for s in _SPEEDS[::2])]]
    for name, load, speed in plan:
        for again in (1, 2):
            blow = taps[speed > 0] * random.uniform(0.5, 1.5, 2) * (0.1, 10)
            samples = _recorded(bench, _motion(bench, load, speed, blow, DURATIONS[speed > 0]), random)
            runs[f"{name}_{again}"] = {
                "description": "tap on pin and disc", "repeat_of": f"{name}_1" if again == 2 else "",
                "conditions": {"press": (load, "N"), "speed": (speed, "rad/s")}, "channels": samples}
    for load in _LOADS[1:]:
        runs[f"turned_{load:g}N"] = _turned(bench, load, random)
    return runs


def _motion(bench, load, speed, blow, duration):
    """(velocity (3, steps), force (steps,)) after a tap ``blow`` (2,) N s on pin and disc, from steady sliding."""
    hidden = {name: hidden_values(bench, name) for name in HIDDEN}
    runout = hidden["runout"]
    start = _steady(bench, load, speed, hidden, runout["amplitude"] * np.cos(runout["phase"]))
    held = bench.friction * max(-bench.contact * (bench.normal @ start), 0.0)        # of a linear contact
    law = (bench.contact, bench.shear, bench.friction, speed * RADIUS, load,
           hidden["contact_stiffness_law"]["exponent"], hidden["contact_damping"]["damping"],
           *hidden["falling_friction"].values(), hidden["contact_memory"]["length"],
           hidden["pressure_dependent_friction"]["exponent"], *hidden["runout"].values(), speed)
    bodies = (bench.mass, bench.mass * bench.squared, bench.damping, bench.normal, bench.tangent, bench.press)
    return _march(np.concatenate((start, blow @ bench.hit / bench.mass, [held])), bodies, _pairs(bench),
                  tuple(map(float, law)), bench.sensors, bench.arm, round(duration / STEP), STEP)


def _pairs(bench):
    """(p, 4) i, j, stiffness and damping beside the diagonal; the arm's damper acts between carriage and base."""
    damping = np.zeros_like(bench.coupling)
    if bench.arm[-1] < 0:
        damping[-1, -2] = damping[-2, -1] = -bench.damping[-1]
    i, j = np.nonzero((bench.coupling != 0) | (damping != 0))
    return np.column_stack((i, j, bench.coupling[i, j], damping[i, j])).astype(float)


def hidden_values(bench, name):
    """Values of a hidden effect, all 0 where it is not there (decay speed: 1)."""
    none = {key: 1.0 if key == "decay_speed" else 0.0 for key in HIDDEN[name]}
    return bench.hidden.get(name, none)


def _steady(bench, load, speed, hidden, gap=0.0):
    """Coordinates (n,) of steady sliding, by fixed-point iteration of the contact force on the stiffness with it.

    A contact that would have to pull is open. Raises ConvergenceError.
    """
    stiffness = np.diag(bench.mass * bench.squared) + bench.coupling
    if load == 0:
        return np.zeros(len(bench.mass))
    force, displacement = load, None
    for _ in range(_STEADY):
        friction = 0.0 if speed == 0 else _mu(bench.friction, force, speed * RADIUS, hidden)
        drive = bench.normal + friction * bench.tangent
        approach = _approach(bench.contact, force, hidden["contact_stiffness_law"]["exponent"])
        secant = force / approach                           # N = secant a about the present guess
        displacement = np.linalg.solve(stiffness + secant * np.outer(drive, bench.normal), bench.press * load
                                - secant * gap * drive)
        new = max(-secant * (bench.normal @ displacement + gap), 1e-9)
        if abs(new - force) < 1e-12 * load:
            return displacement if new > 1e-9 else np.linalg.solve(stiffness, bench.press * load)
        force = 0.5 * (force + new)
    raise ConvergenceError("practice bench", f"steady sliding within {_STEADY} iterations",
                           f"a contact force of {force:.6g} N that still changes", "draw another seed")


def _approach(stiffness, force, exponent):
    """a of N = k a_r / (1 + e) (a / a_r)^(1 + e), whose slope is k at the reference load."""
    reference = (1 + exponent) * _REFERENCE_LOAD / stiffness
    return reference * (force / _REFERENCE_LOAD) ** (1 / (1 + exponent))


def _mu(friction, force, slip, hidden):
    falling = hidden["falling_friction"]
    return friction * (1 + falling["rise"] * np.exp(-slip / falling["decay_speed"])) * (
        force / _REFERENCE_LOAD) ** hidden["pressure_dependent_friction"]["exponent"]


@njit(cache=True)
def _contact(q, v, held, normal, tangent, law, rest, time):
    """(N, T, rate of the remembered friction force) at coordinates ``q`` and rates ``v``."""
    (contact, shear, friction, drive, load, exponent, loss, rise, decay, length, by_pressure, amplitude, phase,
     speed) = law
    opening, opening_rate, along, along_rate = 0.0, 0.0, 0.0, 0.0
    for i in range(q.size):
        opening += normal[i] * q[i]
        opening_rate += normal[i] * v[i]
        along += tangent[i] * q[i]
        along_rate += tangent[i] * v[i]
    approach = -opening - amplitude * np.cos(speed * time - phase)
    if load == 0 or approach <= 0:
        return 0.0, 0.0, 0.0
    reference = (1 + exponent) * _REFERENCE_LOAD / contact
    force = _REFERENCE_LOAD * (approach / reference) ** (1 + exponent) if exponent else contact * approach
    force = max(force - loss * opening_rate, 0.0)
    if drive == 0:
        return force, -shear * (along - rest), 0.0
    slip = drive - along_rate
    mu = friction * (1 + rise * np.exp(-abs(slip) / decay))
    if by_pressure != 0 and force > 0:
        mu *= (force / _REFERENCE_LOAD) ** by_pressure
    drawn = mu * force * np.tanh(slip / _SMOOTH)
    if length == 0:
        return force, drawn, 0.0
    return force, held, abs(slip) / length * (drawn - held)


@njit(cache=True)
def _rate(state, bodies, pairs, law, rest, time, out):
    """Rates of ``state`` (q, q', remembered friction) into ``out``; ``pairs`` (i, j, stiffness, damping) couple."""
    mass, spring, loss, normal, tangent, press = bodies
    size = mass.size
    q, v = state[:size], state[size:2 * size]
    force, drawn, out[2 * size] = _contact(q, v, state[2 * size], normal, tangent, law, rest, time)
    for i in range(size):
        out[i] = v[i]
        out[size + i] = press[i] * law[4] + normal[i] * force + tangent[i] * drawn - spring[i] * q[i] - loss[i] * v[i]
    for row in pairs:
        i, j = int(row[0]), int(row[1])
        out[size + i] -= row[2] * q[j] + row[3] * v[j]
    for i in range(size):
        out[size + i] /= mass[i]


@njit(cache=True)
def _march(state, bodies, pairs, law, sensors, arm, steps, step):
    """(velocity (3, steps), force of the arm (steps,)) by Runge-Kutta's classical rule."""
    size = arm.size
    rest = np.sum(bodies[4] * state[:size])
    k1, k2, k3, k4 = np.zeros((4, state.size))
    velocity, force = np.zeros((sensors.shape[0], steps)), np.zeros(steps)
    for k in range(steps):
        for i in range(size):
            force[k] += arm[i] * state[i]
            for s in range(sensors.shape[0]):
                velocity[s, k] += sensors[s, i] * state[size + i]
        _rate(state, bodies, pairs, law, rest, k * step, k1)
        _rate(state + 0.5 * step * k1, bodies, pairs, law, rest, (k + 0.5) * step, k2)
        _rate(state + 0.5 * step * k2, bodies, pairs, law, rest, (k + 0.5) * step, k3)
        _rate(state + step * k3, bodies, pairs, law, rest, (k + 1) * step, k4)
        for i in range(state.size):
            state[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i])
    return velocity, force


def _recorded(bench, motion, random):
    """{channel: (samples, unit, quantity, rate)} of two lasers, an accelerometer and a load cell."""
    velocity, force = motion
    keep = round(1 / (RATE * STEP))
    shown = {"laser_disc": (velocity[0], "m/s", "velocity"), "laser_pin": (velocity[1], "m/s", "velocity"),
             "accelerometer": (np.gradient(velocity[2], STEP), "m/s^2", "acceleration")}
    guard = butter(4, 10e3, fs=1 / STEP, output="sos")
    channels = {}
    for name, (values, unit, quantity) in shown.items():
        delay = bench.hidden.get("sensor_delay", {})
        if delay.get("channel") == name:
            time = STEP * np.arange(len(values))
            values = np.interp(time - delay["delay"], time, values, left=0.0)
        gain = bench.hidden.get("sensor_gain", {})
        values = values * (1 + gain["error"] if gain.get("channel") == name else 1.0)
        channels[name] = (_digitised(sosfilt(guard, values)[::keep], _NOISE[name], random), unit, quantity, RATE)
    slow = butter(2, 200.0, fs=1 / STEP, output="sos")
    cell = force[0] + sosfilt(slow, force - force[0])
    channels["load_cell"] = (_digitised(cell[::keep], _NOISE["load_cell"], random), "N", "force", RATE)
    return channels


def _turned(bench, load, random, speed=0.25, rate=20.0):
    """One turn by hand without squeal: the load cell in equilibrium at every angle."""
    hidden = {name: hidden_values(bench, name) for name in HIDDEN}
    time = np.arange(round(2 * np.pi / speed * rate)) / rate
    wave = hidden["runout"]["amplitude"] * np.cos(speed * time - hidden["runout"]["phase"])
    force = np.array([bench.arm @ _steady(bench, load, speed, hidden, gap) for gap in wave])
    return {"description": "one turn by hand", "repeat_of": "",
            "conditions": {"press": (load, "N"), "speed": (speed, "rad/s")},
            "channels": {"load_cell": (_digitised(force, _NOISE["load_cell"], random), "N", "force", rate)}}


def _digitised(values, noise, random):
    """Values with white noise, rounded to 16 bits over a range a quarter larger than theirs."""
    noisy = values + noise * random.standard_normal(len(values))
    unit = 2.5 * np.abs(noisy).max() / 2**16
    return unit * np.round(noisy / unit)

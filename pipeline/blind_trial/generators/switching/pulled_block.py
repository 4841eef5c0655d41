"""A block on a track, pulled by a machine through its own stiffness: velocity steps and holds, friction that sticks.

    m x'' + k (x - u) + c (x' - u') + T = 0,    u' the speeds of the machine,    |T| <= mu N f while it rests

f = 1 for Coulomb friction, which the workshop knows; what is hidden changes f.
"""

from bisect import bisect_right
from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.blind_trial.generators.switching.event_motion import HELD, STOPS, Law, Mechanism, moved
from pipeline.blind_trial.generators.switching.instruments import PARTS, filtered, gaps, noise, written
from pipeline.blind_trial.generators.switching.joint_laws import reversal
from pipeline.blind_trial.generators.switching.recalibration import GAIN_SPREAD, SPREAD
from pipeline.blind_trial.generators.switching.rig import OFF
from pipeline.contract.errors import ConfigError

#: factors on the speed of the machine in the runs, the last of which is held out; samples of a run and of a period
LEVELS, _SAMPLES, _A_PERIOD = (0.5, 1.0, 2.0, 1.4), (500, 800), (15.0, 40.0)
#: ranges of mass kg, frequency Hz of the machine's spring, damping ratio, speed m/s, friction, relative effect sizes
_MASS, _FREQUENCY, _DAMPING, _SPEED = (0.5, 5.0), (8.0, 40.0), (0.03, 0.12), (1e-3, 2e-2)
_FRICTION, _SIZE = (0.2, 0.6), (0.02, 0.15)
#: friction over the force of the spring at the typical speed and frequency
_LOAD = (3.0, 10.0)
#: what must be left of hidden friction, standard deviations of the noise, and the step of its slopes
LEAST, _STEP = 12.0, 1e-3
NAMES = ("mass", "stiffness", "damping", "friction")


@dataclass(frozen=True)
class Block:
    """``mass`` kg on a spring ``stiffness`` N/m with ``damping`` N s/m; ``friction`` coefficient, ``load`` N."""

    mass: float
    stiffness: float
    damping: float
    friction: float
    load: float

    @property
    def frequency(self):
        return float(np.sqrt(self.stiffness / self.mass)) / (2 * np.pi)


@dataclass(frozen=True)
class Course:
    """The machine has ``speed`` m/s from each instant ``at`` s on, and rests before."""

    at: tuple
    speed: tuple

    def velocity(self, time):
        return np.concatenate(([0.0], self.speed))[np.searchsorted(self.at, time, side="right")]

    def displacement(self, time):
        since = np.maximum(np.asarray(time, float)[..., None] - np.array(self.at), 0.0)
        return since @ np.diff(self.speed, prepend=0.0)


def friction_law(block, form, speed, size):
    """Law of the friction of a Block; ``speed`` m/s of the machine, typical. HELD sticks."""
    grip = block.friction * block.load
    length = 0.2 * speed / block.frequency
    factor = {"": lambda e, v, z: 1.0,
              "falling_friction": lambda e, v, z: 1 + size * np.exp(-abs(v) / speed),
              "viscous": lambda e, v, z: 1 + size * abs(v) / speed,
              "contact_ageing": lambda e, v, z: 1 + size * np.log1p(max(z[0], 0.0) * speed / length),
              "velocity_strengthening": lambda e, v, z: max(1 + size * np.log((abs(v) + 1e-3 * speed) / speed), 0.1),
              "rippled_track": lambda e, v, z: 1 + size * np.sin(2 * np.pi * e / (3 * length))}[form]
    ages = form == "contact_ageing"
    return Law(np.ones(1), lambda t, e, v, z, mode: mode * grip * factor(e, v, z), int(ages),
               (lambda t, e, v, z, mode: 1 - abs(v) * z / length) if ages else None, length / speed, STOPS,
               lambda mode: (reversal(mode),) if mode != HELD else (),
               lambda t, e, z: (-grip * factor(e, 0.0, z), grip * factor(e, 0.0, z)))


#: form of friction -> whether a catalogue holds it
FORMS = {"falling_friction": True, "viscous": True, "contact_ageing": True, "velocity_strengthening": True,
         "rippled_track": False}


def pulled(block, course, law, fine):
    """(Motion, force of the spring (n,) N as it draws) of a Block at the even instants ``fine``, from rest."""
    at, speeds = (0.0, *course.at), (0.0, *course.speed)
    way = course.displacement(at)

    def push(time):
        k = bisect_right(course.at, time)
        led = way[k] + speeds[k] * (time - at[k])
        return np.array([block.stiffness * led + block.damping * speeds[k]])

    speed = max(map(abs, course.speed))
    rig = Mechanism(np.array([[block.mass]]), np.array([[block.damping]]), np.array([[block.stiffness]]), (law,),
                    speed / (2 * np.pi * block.frequency), speed)
    motion = moved(rig, push, fine, breaks=course.at, accelerated=False)
    force = block.stiffness * (motion.displacement[0] - course.displacement(fine)) + block.damping * (
        motion.velocity[0] - course.velocity(fine))
    return motion, force


@dataclass(frozen=True)
class PulledCase:
    """As ``switching_case.Case``: ``truth`` and ``belief`` are Blocks, ``courses`` one a run; two channels."""

    seed: int
    kind: str
    form: str
    size: float
    left: float
    level: float
    colour: float
    gap: str
    truth: Block
    belief: Block
    courses: tuple
    rate: float
    tau: float
    shown: tuple
    noise: np.ndarray
    change: float


def made(seed, kind, form="", level=0.01):
    """The PulledCase of a seed. ConfigError where what is hidden cannot be seen, ConvergenceError."""
    random = np.random.default_rng([seed, 23])
    block, speed = _drawn(random)
    rate = float(f"{random.uniform(*_A_PERIOD) * block.frequency:.4g}")
    count, tau = int(random.integers(*_SAMPLES)), random.uniform(0.2, 0.5) / rate
    gains = 1 + 0.7 * GAIN_SPREAD * np.clip(random.standard_normal(2), -2, 2)
    courses = tuple(_course(random, factor * speed, count, rate) for factor in LEVELS)
    size = float(np.exp(random.uniform(*np.log(_SIZE)))) if form else 0.0

    def seen(block, form="", runs=courses, gains=gains):
        return [_seen(block, course, friction_law(block, form, speed, size), count, rate, tau, gains)
                for course in runs]

    base, left = seen(block), 0.0
    shown = seen(block, form) if form else base
    spread = level * np.sqrt(np.mean([s**2 for s in shown], axis=(0, 2)))
    if form:
        left = _left(block, gains, lambda b, g: seen(b, "", courses[:-1], g), shown[:-1], spread)
    if form and left < LEAST:
        raise ConfigError(f"trial: {form}", f"at least {LEAST:g} standard deviations left", f"{left:.3g}",
                          "draw another seed")
    off = {n: getattr(block, n) * float(np.exp(random.choice((-1, 1)) * random.uniform(*np.log1p(OFF)))) for n in NAMES}
    colour, gap = float(random.choice((0.0, 0.0, 0.3))), str(random.choice(("", "", "bursts")))
    rows = tuple(np.array([written(row + std * noise(random, count, colour), unit, gaps(random, count, gap))
                           for row, std, unit in zip(run, spread, (1.0, 1e-3), strict=True)]) for run in shown)
    change = float(np.sqrt(np.mean(np.subtract(shown, base) ** 2, axis=(0, 2))
                           / np.mean(np.square(base), axis=(0, 2))).max())
    return PulledCase(seed, kind, form, size, left, level, colour, gap, block, replace(block, **off), courses, rate,
                      tau, rows, spread, change)


def _drawn(random):
    """(Block, speed of the machine in m/s)."""
    mass, frequency, speed, friction, load = (float(np.exp(random.uniform(*np.log(r)))) for r in (
        _MASS, _FREQUENCY, _SPEED, _FRICTION, _LOAD))
    stiffness = mass * (2 * np.pi * frequency) ** 2
    damping = 2 * random.uniform(*_DAMPING) * np.sqrt(stiffness * mass)
    force = load * stiffness * speed / (2 * np.pi * frequency)
    return Block(mass, stiffness, damping, friction, force / friction), speed


def _course(random, speed, count, rate):
    """Slides at four to six speeds, of which one is a hold; changes lie at samples."""
    parts = int(random.integers(4, 7))
    at = np.sort(random.choice(np.arange(count // 10, count), parts - 1, replace=False))
    speeds = speed * np.exp(random.uniform(np.log(0.3), np.log(2.0), parts))
    speeds[random.integers(1, parts - 1)] = 0.0
    return Course(tuple(np.concatenate(([count // 20], at)) / rate), tuple(map(float, speeds)))


def _seen(block, course, law, count, rate, tau, gains):
    """(2, n): force of the spring in N, velocity of the block in m/s, as sensors show them."""
    fine = np.arange(PARTS * (count - 1) + 1) / (rate * PARTS)
    motion, force = pulled(block, course, law, fine)
    return np.array([gain * filtered(row, fine[1], tau)[::PARTS]
                     for gain, row in zip(gains, (force, motion.velocity[0]), strict=True)])


def _left(block, gains, model, seen, noise):
    """Standard deviations that other values of the block and gains leave of what is ``seen``, after three steps."""
    def residual(u):
        values = {n: getattr(block, n) * np.exp(SPREAD * off) for n, off in zip(NAMES, u, strict=False)}
        shown = model(replace(block, **values), gains * (1 + GAIN_SPREAD * u[len(NAMES):]))
        return np.concatenate((*(((s - y) / noise[:, None]).ravel() for s, y in zip(seen, shown, strict=True)), u))

    fit = scipy.optimize.least_squares(residual, np.zeros(len(NAMES) + 2), max_nfev=3, diff_step=_STEP)
    return float(np.sqrt(2 * fit.cost))

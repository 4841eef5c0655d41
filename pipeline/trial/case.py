"""A case of a trial: a rig with hidden physics or none, recorded in runs, and what a workshop believes of it."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.trial import excitation, rig, sensors
from pipeline.trial.hidden import HIDDEN, Spot
from pipeline.trial.motion import PARTS, World, moved

#: sampling, sensors, and the size of the shaker: root mean squares of its force in the runs, N; the last is held out
RATE, SAMPLES, CORNER, DELAY = 100.0, 500, 40.0, 2.5e-3
LEVELS, BAND = (2.0, 1.0, 4.0, 3.0), (0.8, 5.0)
#: error of gains that a calibration leaves, and the change of motion that hidden physics makes, both relative
GAIN_ERROR, CHANGE = 0.005, (0.25, 0.45)
#: trials of a size, and how near its change must come, in the logarithm
_TRIALS, _NEAR = 16, 0.3
#: stated values that count as exact where the law would else be a wrong value of them
_EXACT = {"damping": "damping_{}", "stiffness": "stiffness_{}", "mass": "mass_{}"}


@dataclass(frozen=True)
class Case:
    """``hidden`` and ``place`` ('' where nothing is); ``runs`` [(force (n,), shown (sensor, n))], ``noise`` (sensor,)
    of each sensor in m, ``colour`` of the noise; ``truth`` and ``belief`` are Rigs, ``exact`` names of known values;
    ``change``: of what the sensors show in the first run, relative.
    """

    seed: int
    hidden: str
    place: str
    level: float
    truth: object
    belief: object
    exact: tuple
    runs: tuple
    noise: np.ndarray
    colour: float
    change: float


def made(seed, hidden="", place=0, level=0.01, masses=2, colour=0.0, change=None):
    """The Case of a seed: ``hidden`` physics (a name of HIDDEN, '' for none) at the place of this index.

    ``level`` of noise relative to the motion of each sensor; ``change`` that is wanted, drawn from CHANGE where it is
    None. Raises ConfigError, ConvergenceError.
    """
    random = np.random.default_rng(seed)
    truth = rig.drawn(random, masses)
    forces = [level_n * excitation.force(str(random.choice(excitation.KINDS)), random, SAMPLES, 1 / RATE, BAND)
              for level_n in LEVELS]
    gains = 1 + GAIN_ERROR * random.standard_normal(masses)
    shape, drawn = tuple(random.uniform(size=3)), float(random.uniform(*CHANGE))
    bare = [moved(World(truth), f, 1 / RATE, CORNER) for f in forces]
    reached, name, exact = 0.0, "", ()
    shown = _seen(bare, gains, {})
    if hidden:
        spot, name = _spot(truth, HIDDEN[hidden], place, bare, forces, shape)
        wanted = drawn if change is None else change
        reached, shown = _sized(HIDDEN[hidden], spot, forces, bare, gains, wanted)
        told = HIDDEN[hidden].exact
        exact = (_EXACT[told].format(spot.index),) if told else ()
    noise = level * np.sqrt(np.mean([s**2 for s in shown], axis=(0, 2)))
    runs = tuple((f, _recorded(random, s, noise, colour)) for f, s in zip(forces, shown, strict=True))
    return Case(seed, hidden, name, level, truth, rig.believed(random, truth, exact), exact, runs, noise, colour,
                reached)


def places(piece, masses):
    """[(index, name)] of the places of a Hidden on a rig of so many masses."""
    links = masses + (masses > 2)
    walls = ["link_0", f"link_{links - 1}"][:1 + (masses > 2)]
    names = {"link": [f"link_{k}" for k in range(links)], "wall link": walls,
             "mass": [f"mass_{k}" for k in range(masses)], "shaker": ["shaker"],
             "channel": [f"x_{k}" for k in range(masses)]}[piece.place]
    return [(int(name.partition("_")[2] or 0), name) for name in names]


def _spot(truth, piece, place, bare, forces, shape):
    index, name = places(piece, len(truth.mass))[place % len(places(piece, len(truth.mass)))]
    row = truth.rows[index] if "link" in piece.place else np.eye(len(truth.mass))[index]
    way = np.array([row @ x for x in bare])
    length = float(np.sqrt(np.mean(way**2)))
    speed = float(np.sqrt(np.mean(np.gradient(way, 1 / (RATE * PARTS), axis=1) ** 2)))
    force = float(np.sqrt(np.mean(np.square(forces)))) if piece.place == "shaker" else truth.links[
        min(index, len(truth.links) - 1)].stiffness * length
    return Spot(truth, index, length, speed, force, SAMPLES / RATE, shape), name


def _seen(motion, gains, chains):
    """[(sensor, n)] of [(sensor, instant)]: every sensor by its chain, or one with its delay and gain alone."""
    time, fine = np.arange(SAMPLES) / RATE, np.arange(PARTS * (SAMPLES - 1) + 1) / (RATE * PARTS)
    found = []
    for one in motion:
        rows = []
        for k, gain in enumerate(gains):
            own = chains.get(k, sensors.Chain())
            chain = sensors.Chain(DELAY + own.delay, gain * own.gain, own.offset, own.drift, own.limit)
            rows.append(chain.shown(time, fine, one[k]))
        found.append(np.array(rows))
    return found


def _sized(piece, spot, forces, bare, gains, wanted):
    """(change, [(sensor, n)]) of hidden physics of the size that changes what sensors show in one run by ``wanted``.

    The change is taken as a power of the size, between the nearest sizes on both sides once they are known.
    """
    reference = _seen(bare[:1], gains, {})
    size, low, high = 0.1, 1e-5, 30.0
    for _ in range(_TRIALS):
        try:
            change = _change(_with(piece, spot, size, forces[:1], bare[:1], gains), reference)
        except ConvergenceError:
            change = np.inf
        if abs(np.log(max(change, 1e-12) / wanted)) < _NEAR:
            return change, _with(piece, spot, size, forces, bare, gains)
        low, high = (size, high) if change < wanted else (low, size)
        guess = size * np.clip(wanted / max(change, 1e-12), 0.1, 5.0)
        size = float(guess if low < guess < high else np.sqrt(low * high))
    raise ConfigError(f"trial: {piece.name}", f"a size that changes the motion by {wanted:.0%}",
                      f"{change:.1%} at last", "draw another seed")


def _with(piece, spot, size, forces, bare, gains):
    built = piece.build(spot, size)
    if isinstance(built, World):
        return _seen([moved(built, f, 1 / RATE, CORNER) for f in forces], gains, {})
    return _seen(bare, gains, {spot.index: built})


def _change(shown, reference):
    """Root mean square change relative to the reference, of the sensor that changes most."""
    left = np.mean([(a - b) ** 2 for a, b in zip(shown, reference, strict=True)], axis=(0, 2))
    return float(np.sqrt((left / np.mean([b**2 for b in reference], axis=(0, 2))).max()))


def _recorded(random, shown, noise, colour):
    noisy = shown + noise[:, None] * np.array([sensors.noise(random, SAMPLES, colour) for _ in shown])
    return np.array([sensors.converted(row, 1.2 * abs(row).max()) for row in noisy])

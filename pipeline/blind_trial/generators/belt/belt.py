"""A rig whose first mass rubs on a belt: pushed by a shaker, dragged by dry friction under several loads.

Every run has its load, its humidity and its belt, which starts from rest: to and fro, or up to a steady speed with a
swing on it. The workshop knows Coulomb friction; what a trial hides sits in the contact or in the rig.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.belt.hidden_friction import FRICTION, Contact, Drag, Rubbed, plain
from pipeline.blind_trial.generators.spring_mass import rig, rig_case, sensors
from pipeline.blind_trial.generators.spring_mass.detectability import explained, nudged
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Planted, Recorder, built, change_of, sized
from pipeline.blind_trial.generators.spring_mass.motion import PARTS, Law, World, moved
from pipeline.blind_trial.generators.spring_mass.placement import BELOW, noise_of, places
from pipeline.blind_trial.generators.spring_mass.rig_case import (
    CORNER,
    FAR,
    GAIN_ERROR,
    RATE,
    SAMPLES,
    SPREAD,
    recorder_of,
)
from pipeline.contract.errors import ConfigError

#: loads N of the runs, the last held out, and the typical one; root mean squares of the shaker, N
LOADS, LOAD, LEVELS = (4.0, 8.0, 12.0, 6.0), 8.0, (2.5, 2.0, 4.0, 3.0)
HUMIDITIES, FRICTIONS = (0.3, 0.7, 0.45, 0.6), (0.15, 0.4)
#: physics of the rig itself that may be hidden beside the contact
IN_RIG = ("cubic_stiffness", "quadratic_damping", "attached_mass", "backlash")
#: relative step of differences: friction turns round at instants of its own, which the integration finds to 1e-6
_STEP = 1e-3


@dataclass(frozen=True)
class Belt:
    """A rig on a belt: ``truth`` Rig, ``friction``, and for each run its force (n,) N, belt (n,) m/s and Rubbed."""

    truth: object
    friction: float
    recorder: Recorder
    belts: tuple

    def rubbed(self, run):
        """Coefficient, load and humidity of the run of this number."""
        return Rubbed(self.friction, LOADS[run], HUMIDITIES[run])


@dataclass(frozen=True)
class Case:
    """As ``case.Case``; ``runs`` [(force, belt, shown)], ``believed`` the coefficient that the workshop takes."""

    seed: int
    kind: str
    planted: tuple
    left: tuple
    level: float
    belt: Belt
    belief: object
    believed: float
    exact: tuple
    far: str
    runs: tuple
    noise: np.ndarray
    change: float


def made(seed, hidden=(), level=0.01, masses=1, change=0.1, kind=""):
    """The Case of a seed with physics of FRICTION and IN_RIG ``hidden``, each of a size that changes motion by
    ``change``; ``kind`` as ``case.made``. Raises ConfigError, ConvergenceError."""
    random = np.random.default_rng(seed)
    values = _drawn(random, masses)
    bare = _seen(values)
    trained = range(len(LOADS) - 1)
    known = explained(lambda changed: _seen(changed, runs=trained), _nudged(values), SPREAD, GAIN_ERROR, _STEP)
    noise = noise_of(bare, level)
    planted = tuple(_planted(random, values, bare, name, known, noise, change, kind == "below") for name in hidden)
    seen = _seen(values, planted) if planted else bare
    others = (tuple(p for p in planted if p is not piece) for piece in planted)
    left = tuple(known.left(np.array(seen)[trained] - _seen(values, rest, trained), noise) for rest in others)
    exact = tuple(f"mass_{p.spot.index}" for p in planted if p.piece.exact == "mass")
    belief, believed, far = _believed(random, values, exact, kind)
    runs = tuple((f, w, _recorded(random, s, noise)) for f, w, s in zip(values.recorder.runs, values.belts, seen,
                                                                       strict=True))
    return Case(seed, kind or kind_of(hidden), planted, left, level, values, belief, believed, exact, far, runs, noise,
                change_of(seen, bare))


def kind_of(hidden):
    """Class of a case that hides these."""
    return rig_case.kind_of(hidden, {**HIDDEN, **FRICTION})


def _drawn(random, masses):
    truth = rig.drawn(random, masses)
    recorder = recorder_of(random, masses, LEVELS)
    alone = np.concatenate([np.gradient(x[0], 1 / (RATE * PARTS)) for x in recorder.motion(World(truth))])
    speed = float(np.sqrt(np.mean(alone**2)))
    belts = tuple(speed * _way(random, k % 2) for k in range(len(LEVELS)))
    return Belt(truth, float(random.uniform(*FRICTIONS)), recorder, belts)


def _way(random, steady):
    """Belt speed (n,) of size about 1, from rest."""
    time, size, rate = np.arange(SAMPLES) / RATE, random.uniform(0.6, 1.5), random.uniform(0.3, 0.8)
    swing = np.sin(2 * np.pi * rate * time)
    return size * ((1 - np.exp(-time / 0.2)) * (1 + 0.6 * swing) if steady else swing)


def _seen(belt, planted=(), runs=None):
    """[(sensor, n)] of the chosen runs with all that is ``planted``."""
    drag, around = plain(_contact(belt)), []
    for piece in planted:
        if piece.piece.name in FRICTION:
            drag = piece.piece.build(piece.spot, piece.size)
        else:
            around.append(piece)
    world, _ = built(belt.truth, around)
    masses = len(world.rig.mass)
    motions = [moved(replace(world, laws=(*world.laws, dragging(drag, belt.rubbed(k), belt.belts[k], masses)
                                        )), belt.recorder.runs[k], 1 / RATE, CORNER)
             for k in (range(len(LOADS)) if runs is None else runs)]
    return belt.recorder.seen(motions)


def dragging(drag: Drag, run, belt, masses):
    """Law of the first of so many masses on a ``belt`` (n,) m/s, in a Rubbed ``run``."""
    instants = np.arange(len(belt)) / RATE

    def slip(t, v):
        return np.interp(t, instants, belt) - v

    def rates(t, e, v, z):
        s = slip(t, v)
        return drag.rates(run, s, drag.force(run, s, e, z), z)

    return Law(np.eye(masses)[0], lambda t, e, v, z: -drag.force(run, slip(t, v), e, z), drag.states,
               rates if drag.states else None)


def _contact(belt, shape=(0.5, 0.5, 0.5)):
    """Contact of typical sizes; the motion is that of a mass which the belt carries along."""
    speed = float(np.sqrt(np.mean(np.square(belt.belts))))
    length = LOAD * belt.friction / belt.truth.links[0].stiffness
    return Contact(speed, length, LOAD, SAMPLES / RATE, shape)


def _planted(random, belt, bare, name, known, noise, wanted, below):
    """Planted of a piece, sized by its change of what the training runs show, or by what values leave of it."""
    shape, trained = tuple(random.uniform(size=3)), range(len(LOADS) - 1)
    if name in FRICTION:
        start = Planted(FRICTION[name], "contact", _contact(belt, shape))
    elif name in IN_RIG:
        piece = HIDDEN[name]
        there = places(piece, len(belt.truth.mass))
        index, location = there[int(random.integers(len(there)))]
        start = Planted(piece, location, _spot(belt, bare, piece, index, shape))
    else:
        raise ConfigError(f"trial: {name}", f"one of {', '.join((*FRICTION, *IN_RIG))}")

    def change(hidden):
        return change_of(_seen(belt, (hidden,), trained), bare[:len(trained)])

    def left(hidden):
        return known.left(np.array(_seen(belt, (hidden,), trained)) - np.array(bare[:len(trained)]), noise)

    return sized(start, left, start.spot.between(2, *BELOW)) if below else sized(start, change, wanted)


def _spot(belt, bare, piece, index, shape):
    row = belt.truth.rows[index] if piece.place == "link" else np.eye(len(belt.truth.mass))[index]
    way = np.array([row @ x for x in bare])
    length, speed = (float(np.sqrt(np.mean(w**2))) for w in (way, np.gradient(way, 1 / RATE, axis=1)))
    return Spot(belt.truth, index, length, speed, belt.truth.links[index].stiffness * length, SAMPLES / RATE, shape)


def _nudged(belt):
    """The belt, then belts with one value after the other larger, its coefficient last."""
    for changed in nudged(belt.truth, _STEP):
        yield replace(belt, truth=changed)
    yield replace(belt, friction=belt.friction * (1 + _STEP))


def _believed(random, belt, exact, kind):
    """(Rig, coefficient, name of the value that is far off) of the workshop."""
    belief = rig.believed(random, belt.truth, exact)
    off = belt.friction * np.exp(random.choice((-1, 1)) * random.uniform(*np.log1p(rig.OFF)))
    if kind != "wrong_value":
        return belief, off, ""
    if random.uniform() < 0.5:
        return belief, belt.friction * np.exp(random.choice((-1, 1)) * random.uniform(*np.log(FAR))), "friction"
    belief, far = rig.far_off(random, belt.truth, belief, FAR)
    return belief, off, far


def _recorded(random, seen, noise):
    noisy = seen + noise[:, None] * random.standard_normal(seen.shape)
    return np.array([sensors.converted(row, 1.2 * abs(row).max()) for row in noisy])

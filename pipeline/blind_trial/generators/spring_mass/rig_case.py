"""A case of a trial: a rig with hidden physics or none, recorded in runs, and what a workshop believes of it."""

from dataclasses import dataclass

import numpy as np

from pipeline.blind_trial.generators.spring_mass import excitation, rig, sensors
from pipeline.blind_trial.generators.spring_mass.detectability import Values, of_rig
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Recorder, change_of, shown
from pipeline.blind_trial.generators.spring_mass.linear_motion import coarse
from pipeline.blind_trial.generators.spring_mass.motion import World
from pipeline.blind_trial.generators.spring_mass.placement import Hiding, difference, noise_of, placed
from pipeline.contract.errors import ConfigError

#: sampling, sensors, and the size of the shaker: root mean squares of its force in the runs, N; the last is held out
RATE, SAMPLES, CORNER, DELAY = 100.0, 500, 40.0, 2.5e-3
LEVELS, BAND = (2.0, 1.0, 4.0, 3.0), (0.8, 5.0)
#: spread of the logarithm of values that a workshop states: they are off by 10 to 30 %
SPREAD = 0.25
#: error of gains that a calibration leaves, and the change of motion that hidden physics makes, both relative
GAIN_ERROR, CHANGE = 0.005, (0.25, 0.45)
#: what is left of the error of a step that is too long, in standard deviations of the noise, at least
STEP_SHOWS = 8.0
#: how far off one value of a case with a wrong one is, as a factor either way
FAR = (1.4, 1.7)
#: longest step that is stated of the model, and one that is too long, in samples; then the rate is low as well, Hz
STEP, LONG_STEP, LOW_RATE = 0.25, 1.0, 50.0
#: classes of a case that are more than what it hides
KINDS = ("below", "wrong_value", "solver")
#: stated values that count as exact where the law would else be a wrong value of them
_EXACT = {"damping": "damping_{}", "stiffness": "stiffness_{}", "mass": "mass_{}"}


@dataclass(frozen=True)
class Case:
    """``kind``: its class; ``planted``: hidden physics (Planted, ...), ``left``: standard deviations of the noise that
    other values leave of the change by each, or by a step that is too long.

    ``runs`` [(force (n,), shown (sensor, n))] at ``rate`` Hz, ``noise`` (sensor,) of each sensor in m, ``colour`` of
    the noise; ``truth`` and ``belief`` are Rigs, ``exact`` names of known values, ``far`` that of the wrong one;
    ``change``: of what the sensors show in the first run, relative; ``reach``: largest peak of a sensor over that
    without hidden physics; ``hiding``: how it was hidden.
    """

    seed: int
    kind: str
    planted: tuple
    left: tuple
    level: float
    truth: object
    belief: object
    exact: tuple
    far: str
    runs: tuple
    rate: float
    noise: np.ndarray
    colour: float
    change: float
    reach: float
    hiding: Hiding

    @property
    def step(self):
        """Longest step of the workshop's model, s."""
        return (LONG_STEP if self.kind == "solver" else STEP) / self.rate


def made(seed, hidden="", place=0, level=0.01, masses=2, colour=0.0, change=None, kind=""):
    """The Case of a seed: ``hidden`` physics (names of HIDDEN, '' or () for none) at places of these indices.

    ``level`` of noise relative to the motion of each sensor; ``change`` that each piece alone makes, drawn from CHANGE
    where it is None; ``kind``: one of KINDS, '' for what is hidden. Raises ConfigError, ConvergenceError.
    """
    names, indices = ((hidden,) if hidden else (), (place,)) if isinstance(hidden, str) else (hidden, place)
    random = np.random.default_rng(seed)
    truth, rate = rig.drawn(random, masses), LOW_RATE if kind == "solver" else RATE
    recorder = recorder_of(random, masses, rate=rate)
    draws = [(tuple(random.uniform(size=3)), float(random.uniform(*CHANGE))) for _ in names or (None,)]
    bare = recorder.motion(World(truth))
    exact = _exact(names, indices, masses)
    if not exact and kind != "wrong_value":
        exact = known(seed, truth)
    values = Values(truth, SPREAD, GAIN_ERROR, exact)
    hiding = Hiding(recorder, values, bare, of_rig(recorder, values, len(recorder.runs) - 1), level, colour)
    planted = tuple(hiding.planted(name, at, shape, change or drawn, kind == "below")
                    for name, at, (shape, drawn) in zip(names, indices, draws, strict=False))
    seen = shown(recorder, truth, planted, bare)
    noise = noise_of(seen, level)
    left = tuple(hiding.left(piece, planted, seen, noise) for piece in planted)
    if kind == "solver":
        left = (_of_solver(hiding, seen, noise),)
    belief = rig.believed(random, truth, exact)
    far = ""
    if kind == "wrong_value":
        belief, far = rig.far_off(random, truth, belief, FAR)
    runs = tuple((f, _recorded(random, s, noise, colour)) for f, s in zip(recorder.runs, seen, strict=True))
    return Case(seed, kind or kind_of(names), planted, left, level, truth, belief, exact, far, runs, rate, noise,
                colour, change_of(seen[:1], recorder.seen(bare[:1])), _reach(seen, recorder.seen(bare)), hiding)


def _reach(seen, without):
    """Largest peak of a sensor in all runs over that in those ``without`` hidden physics."""
    far, near = (np.max(np.abs(motion), axis=(0, 2)) for motion in (seen, without))
    return float((far / near).max())


def _exact(names, indices, masses):
    """Names of values that are stated exactly, as what is hidden would else be a wrong value of them."""
    pieces = [(HIDDEN[name], index) for name, index in zip(names, indices, strict=False)]
    return tuple(_EXACT[piece.exact].format(_number(piece, placed(piece, at, masses)[0], masses))
                 for piece, at in pieces if piece.exact)


def _number(piece, index, masses):
    """Number of the value that is exact for a piece at the place of this ``index``: of a spring to the wall at the last
    of three or more masses that of the link to the far wall, which comes after those of all masses."""
    far = piece.place == "mass" and piece.exact == "stiffness" and masses > 2 and index == masses - 1
    return masses if far else index


def known(seed, truth):
    """Name of a value that the workshop happens to know exactly, in one case of three: such values betray nothing."""
    random = np.random.default_rng([seed, 9])
    if random.uniform() > 1 / 3:
        return ()
    return (str(random.choice(rig.value_names(truth))),)


def recorder_of(random, masses, levels=LEVELS, rate=RATE):
    """Recorder of runs under forces of these root mean squares in N, its sensors with gains that are a little off."""
    forces = tuple(level * excitation.force(str(random.choice(excitation.KINDS)), random, SAMPLES, 1 / rate, BAND)
                   for level in levels)
    return Recorder(forces, rate, 1 + GAIN_ERROR * random.standard_normal(masses), DELAY, CORNER)


def kind_of(names, pieces=HIDDEN):
    """Class of a case that hides these of the ``pieces`` {name: Hidden}."""
    if len(names) != 1:
        return "pair" if names else "control"
    piece = pieces[names[0]]
    return ("sensor" if piece.place == "channel" else "effect") if piece.known else "foreign"


def _of_solver(hiding, seen, noise):
    """What values leave of the error of a step of one sample; ConfigError where that is too little to be seen."""
    recorder = hiding.recorder
    samples = recorder.seen([coarse(hiding.truth, f, 1 / recorder.rate, CORNER) for f in recorder.runs])
    left = hiding.explained.left(difference(samples, seen)[:-1], noise, hiding.colour)
    if left < STEP_SHOWS:
        raise ConfigError("trial: solver", f"an error of {STEP_SHOWS:g} standard deviations", f"{left:.2g}",
                          "draw another seed")
    return left


def _recorded(random, seen, noise, colour):
    noisy = seen + noise[:, None] * np.array([sensors.noise(random, SAMPLES, colour) for _ in seen])
    return np.array([sensors.converted(row, 1.2 * abs(row).max()) for row in noisy])

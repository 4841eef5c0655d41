"""A case of a switching rig from a seed: rig, excitation, sensors, hidden physics of a size that can be seen."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.switching import drive, reported_values, rig
from pipeline.blind_trial.generators.switching.event_motion import Mechanism, moved
from pipeline.blind_trial.generators.switching.hidden import (
    FAULTS,
    MEANS,
    PIECES,
    RATIOS,
    known_exactly,
    places,
    row_of,
)
from pipeline.blind_trial.generators.switching.instruments import PARTS, QUANTITIES, Sensor, gaps, noise, written
from pipeline.blind_trial.generators.switching.joint_laws import Spot
from pipeline.blind_trial.generators.switching.recalibration import GAIN_SPREAD, Beginning, Recalibration, linear
from pipeline.contract.errors import ConfigError, ConvergenceError

#: strengths of the runs, the last of which is held out; samples of a run; samples a period of the fastest mode
LEVELS, _SAMPLES, _A_PERIOD, _FINER = (0.4, 1.0, 1.8, 1.3), (500, 900), (15.0, 30.0), 60.0
#: periods of the slowest mode that a run lasts at least; root mean square of the motion at level 1, m
_PERIODS, _MOTION = 6.0, (5e-5, 1e-3)
#: band of shakers over the slowest and the fastest mode; seconds that a release is recorded late, in slowest periods
_BAND, _LATE = (0.4, 1.3), (0.2, 1.2)
#: standard deviations of the noise that a recalibrated nominal model leaves of hidden physics: wanted, at least
WANTED, LEAST = (25.0, 250.0), 12.0
#: trials of a size; how near what is left must come, in the logarithm, to end them, and at last; least size
_TRIALS, _NEAR, _FAR, _SMALLEST = 8, 0.4, 1.2, 1e-4
#: times as far as without what is hidden that a motion may go
_REACH = 5.0
#: share of its size, and of the range of its form, by which a law is changed to see what its values do
_LITTLE = 0.03
#: strengths over the mean of two that are tried in their place
_NEAR_MEAN = (0.8, 0.9, 1.0, 1.1, 1.25)
_LAYOUTS = ("single", "single", "row", "row", "bridge", "long row", "star")
_WAYS = ("multisine", "sweep", "steps", "wall", "release", "release", "blow")
_GAPS, _COLOURS = ("", "", "bursts", "uneven"), (0.0, 0.0, 0.3)


@dataclass(frozen=True)
class Case:
    """``planted`` (Piece or '', name, number or channel) and its ``size``; ``left``: see ``recalibration``.

    ``truth`` and ``belief`` are Rigs, ``exact`` names of values that are stated exactly, ``far`` that of a wrong one;
    ``runs`` [Beginning], ``shown`` [(sensor, n)] as written, ``noise`` (sensor,) in SI; ``change`` of what the sensors
    show, relative; ``at``: number of the body or spring that is excited; ``told`` {parameter: SI value} of what is
    hidden, where others have words for it; ``beyond``: ``left`` of it beside the mean of two strengths of friction;
    ``second``: what is hidden beside it, of a pair.
    """

    seed: int
    kind: str
    form: str
    name: str
    index: int
    size: float
    left: float
    level: float
    colour: float
    gap: str
    way: str
    at: int
    truth: rig.Rig
    belief: rig.Rig
    exact: tuple
    far: str
    rate: float
    runs: tuple
    sensors: tuple
    shown: tuple
    noise: np.ndarray
    change: float
    reach: float
    told: dict
    beyond: float = np.inf
    second: "Second | None" = None


@dataclass(frozen=True)
class Second:
    """A law hidden beside another one: its ``name``, the spring ``index``, the least that is ``left`` of it by itself
    and of either beside the other, and its values ``told``, as of ``Case``."""

    name: str
    index: int
    left: float
    told: dict


@dataclass(frozen=True)
class _Bench:
    """A rig, its runs [Beginning] and sensors."""

    rig: rig.Rig
    runs: tuple
    sensors: tuple

    def motions(self, laws=(), changed=None):
        """[Motion] with ``laws``, of the rig as ``changed``. Raises ConvergenceError."""
        accelerated = any(s.quantity == "acceleration" for s in self.sensors)
        whole = changed or self.rig
        mechanism = Mechanism(*whole.matrices(), laws, _MOTION[0], _MOTION[0] * 2 * np.pi * whole.frequencies[0])
        return [moved(mechanism, run.drive.pushing(run.fine), run.fine, run.start, run.drive.breaks, accelerated)
                for run in self.runs]

    def seen(self, motions, sensors=None):
        """[(sensor, n)] in SI."""
        return [np.array([s.shown(m, run.fine, run.time) for s in sensors or self.sensors])
                for m, run in zip(motions, self.runs, strict=True)]


def made(seed, kind, form="", level=0.01, second="", apart=False):
    """The Case of a seed: of a class ``kind``, with the Piece or fault ``form`` hidden ('' nothing), in noise of a
    ``level`` relative to what each sensor shows; a law ``second`` beside it, of the same visibility, at another spring
    if ``apart``. ConfigError, ConvergenceError where none can be made of this seed."""
    random = np.random.default_rng([seed, 22])
    piece = PIECES.get(form)
    layout = str(random.choice(_LAYOUTS))
    way = str(random.choice([w for w in _WAYS if w != "wall" or _beside_a_moved_wall(piece, layout)]))
    truth = rig.drawn(random, layout)
    rate, count = _sampling(random, truth)
    bench, at = _laid_out(random, truth, way, rate, count)
    if form in RATIOS and len(bench.sensors) == 1 and all(run.free for run in bench.runs):
        raise ConfigError(f"trial: {form}", "a second sensor, or a known drive", "one sensor of an unknown motion",
                          "draw another seed")
    index = _index(random, piece, bench, at if way == "wall" else None)
    exact = known_exactly(piece, truth, index) if piece else ()
    if not exact and kind != "wrong_value" and random.uniform() < 1 / 3:
        exact = (str(random.choice(truth.names)),)
    bare = bench.motions()
    base = bench.seen(bare)
    sizes = level * np.sqrt(np.mean([b**2 for b in base], axis=(0, 2)))
    trained = _Bench(truth, bench.runs[:-1], bench.sensors)
    nominal = Recalibration(truth, bench.sensors, trained.runs, exact, base[:-1])
    shape = tuple(map(float, random.uniform(size=3)))
    wanted = float(np.exp(random.uniform(*np.log(WANTED))))
    hiding = _Hiding(bench, nominal, bare, sizes, piece, form, index, shape)
    size, seen = hiding.sized(wanted) if form else (0.0, base)
    left = nominal.left(seen[:-1], sizes) if form else 0.0
    if form and left < LEAST:
        raise ConfigError(f"trial: {form}", f"at least {LEAST:g} standard deviations left", f"{left:.3g}",
                          "draw another seed")
    beside = None
    if second:
        springs = [k for k in places(PIECES[second], truth) if (k != index) == apart and (k != at or way != "wall")]
        beside, seen = _with_second(np.random.default_rng([seed, 23]), hiding, (size, seen), second, springs, wanted)
        left = min(left, beside.left)
    far = str(random.choice([n for n in truth.names if n not in exact])) if kind == "wrong_value" else ""
    belief = rig.believed(random, truth, exact, far)
    spread = level * np.sqrt(np.mean([s**2 for s in seen], axis=(0, 2)))
    colour, gap = float(random.choice(_COLOURS)), str(random.choice(_GAPS))
    if gap == "uneven" and rate < 2 * _A_PERIOD[0] * truth.frequencies[-1]:
        gap = ""
    shown = tuple(_written(random, run, spread, bench.sensors, colour, gap) for run in seen)
    beyond = hiding.beyond_mean(size, seen[:-1]) if form in MEANS else np.inf
    left *= np.sqrt(np.mean([np.isfinite(run).mean() for run in shown[:-1]]))     # missing samples tell nothing
    name = piece.name if piece else FAULTS.get(form, "")
    return Case(seed, kind, form, name, index, size, left, level, colour, gap, way, at, truth, belief, exact, far, rate,
                bench.runs, bench.sensors, shown, spread, _change(seen, base), _reach(seen, base), hiding.told(size),
                beyond, beside)


def _with_second(random, first, made, form, springs, wanted):
    """(Second, [(sensor, n)] of both) of a law ``form`` at one of ``springs`` beside that of a _Hiding ``first``, which
    was ``made`` (size, [(sensor, n)]); of each as much is left beside the other one as must be of it by itself."""
    size, one = made
    if not springs:
        raise ConfigError(f"trial: {form}", "another spring", "a rig of one", "draw another seed")
    second = replace(first, piece=PIECES[form], form=form, index=int(random.choice(springs)),
                     shape=tuple(map(float, random.uniform(size=3))))
    own, alone = second.sized(wanted)
    laws, others = first.piece.laws(first.spot, size), second.piece.laws(second.spot, own)
    seen = first.bench.seen(first.bench.motions((*laws, *others)))
    left = min(first.nominal.left(alone[:-1], first.noise),
               first.beside(seen[:-1], one, first.changes(size, others, seen[:-1])),
               first.beside(seen[:-1], alone, second.changes(own, laws, seen[:-1])))
    if min(left, first.nominal.left(seen[:-1], first.noise)) < LEAST or _reach(seen, first.nominal.base) > _REACH:
        raise ConfigError(f"trial: {form}", "two laws that are both seen, within the reach of the rig", "others",
                          "draw another seed")
    return Second(second.piece.name, second.index, left, second.told(own)), seen


def _beside_a_moved_wall(piece, layout):
    """Whether a Piece has a place on a rig one of whose walls is moved: not at the spring there."""
    return piece is None or piece.place == "mass" or (piece.place == "spring" and len(rig.LAYOUTS[layout]) > 1)


def _index(random, piece, bench, moved_spring):
    """Number of the spring or body of a Piece, bodies with a sensor alone, else that of a sensor."""
    if piece is None:
        return int(random.integers(len(bench.sensors)))
    sensed = [s.body for s in bench.sensors]
    return int(random.choice([
        k for k in places(piece, bench.rig) if (k in sensed if piece.place == "mass" else k != moved_spring)]))


def _sampling(random, truth):
    """(rate Hz, samples of a run)."""
    slowest, fastest = truth.frequencies[[0, -1]]
    finest = _FINER if len(truth.mass) == 1 else _A_PERIOD[1]
    rate = float(f"{random.uniform(_A_PERIOD[0], finest) * fastest:.4g}")
    return rate, int(max(random.integers(*_SAMPLES), _PERIODS * rate / slowest))


def _laid_out(random, truth, way, rate, count):
    """(_Bench of a rig that is excited in a way, number of the body or spring that is)."""
    n, slowest = len(truth.mass), truth.frequencies[0]
    walls = [k for k, (_, far) in enumerate(truth.ends) if far == rig.WALL]
    at = int(random.choice(walls)) if way == "wall" else int(random.integers(n))
    late = random.uniform(*_LATE) / slowest if way == "release" else 0.0
    before = int(np.ceil(late * rate * PARTS))
    fine = np.arange(-before, PARTS * (count - 1) + 1) / (rate * PARTS)
    time = np.arange(count) / rate
    runs = [_begun(random, truth, way, at, fine, time, rate) for _ in LEVELS]
    wanted = np.exp(random.uniform(*np.log(_MOTION)))
    typical = np.sqrt(np.mean([linear(truth, run).displacement ** 2 for run in runs]))
    runs = tuple(_scaled(run, level * wanted / typical) for run, level in zip(runs, LEVELS, strict=True))
    return _Bench(truth, runs, _sensors(random, n, way, rate)), at


def _begun(random, truth, way, at, fine, time, rate):
    """Beginning of a run of any strength."""
    n, (slowest, fastest) = len(truth.mass), truth.frequencies[[0, -1]]
    row, rest = np.eye(n)[at if way != "wall" else 0], np.zeros(2 * n)
    if way == "release":
        start = np.concatenate((random.standard_normal(n), random.standard_normal(n) * 2 * np.pi * slowest))
        return Beginning(fine, time, drive.still(row), start, "start")
    if way == "blow":
        instant = random.uniform(0.3, 0.8) / slowest
        return Beginning(fine, time, drive.blow(row, 1.0, instant, random.uniform(0.5, 1.5) / rate), rest, "blow")
    kind = str(random.choice(("multisine", "sweep"))) if way == "wall" else way
    shape = drive.course(random, kind, _BAND[0] * slowest, _BAND[1] * fastest, time[-1], rate)
    if way == "wall":
        return Beginning(fine, time, drive.wall(truth, at, 1.0, shape), rest)
    return Beginning(fine, time, drive.shaker(row, 1.0, shape), rest)


def _scaled(run, factor):
    return replace(run, start=factor * run.start, drive=run.drive.scaled(factor))


def _sensors(random, bodies, way, rate):
    """Sensors of the bodies: of all where the start or blow is unknown, else of most."""
    seen = [k for k in range(bodies) if way in ("release", "blow") or random.uniform() < 0.75]
    sensors = []
    for body in seen or [int(random.integers(bodies))]:
        quantity = str(random.choice(list(QUANTITIES)))
        unit = str(random.choice(list(QUANTITIES[quantity][1])))
        sensors.append(Sensor(f"ch{body + 1}", body, quantity, unit, random.uniform(0.2, 0.5) / rate,
                              1 + 0.7 * GAIN_SPREAD * float(np.clip(random.standard_normal(), -2, 2))))
    return tuple(sensors)


@dataclass(frozen=True)
class _Hiding:
    """How a piece or fault is put into a bench, and how large."""

    bench: _Bench
    nominal: Recalibration
    bare: list
    noise: np.ndarray
    piece: object
    form: str
    index: int
    shape: tuple

    @property
    def spot(self):
        """Spot of a piece."""
        truth = self.bench.rig
        row = row_of(self.piece, truth, self.index)
        length, speed = (float(np.sqrt(np.mean([(row @ getattr(m, what)) ** 2 for m in self.bare])))
                         for what in ("displacement", "velocity"))
        if self.piece.place == "mass":
            return Spot(row, length, speed, max(truth.stiffness), self.shape)
        return Spot(row, length, speed, truth.stiffness[self.index], self.shape, truth.damping[self.index])

    def seen(self, size, runs=slice(None)):
        """[(sensor, n)] in SI of some ``runs`` with what is hidden at a size."""
        bench = replace(self.bench, runs=self.bench.runs[runs])
        if self.piece is None:
            return bench.seen(self.bare[runs], self.faulty(size))
        if self.piece.change is not None:
            return bench.seen(bench.motions((), self.piece.change(bench.rig, self.index, size)))
        return bench.seen(bench.motions(self.piece.laws(self.spot, size)))

    def told(self, size):
        """{parameter: SI value} of a piece at a size; {} of a fault and of nothing."""
        if self.piece is None:
            return {}
        if self.piece.change is not None:
            return reported_values.of_change(self.form, self.bench.rig, self.index, size)
        return reported_values.of_law(self.form, self.spot, size)

    def faulty(self, size):
        """The sensors with the fault ``form`` in one of them."""
        sensor = self.bench.sensors[self.index]
        shown = [s[self.index] for s in self.bench.seen(self.bare)]
        peak, rms = max(abs(s).max() for s in shown), np.sqrt(np.mean(np.square(shown)))
        seconds = self.bench.runs[0].time[-1]
        way = 1 if self.shape[1] < 0.5 else -1
        changed = {"gain": {"gain": sensor.gain * (1 + way * (0.15 + 0.35 * self.shape[0]))},
                   "reversed": {"gain": -sensor.gain}, "factor_1000": {"gain": sensor.gain * 1000.0**way},
                   "delay": {"delay": (0.1 + 0.4 * self.shape[0]) / (2 * np.pi * self.bench.rig.frequencies[-1])},
                   "clipping": {"limit": peak * (0.3 + 0.4 * self.shape[0])},
                   "drift": {"offset": way * size * rms, "drift": size * rms * (self.shape[2] - 0.5) / seconds}}
        sensors = list(self.bench.sensors)
        sensors[self.index] = replace(sensor, **changed[self.form])
        return tuple(sensors)

    def sized(self, wanted):
        """(size, what is seen) of a size of which about ``wanted`` is left; of a fault as it was drawn.

        ConfigError where there is none within the reach of the rig."""
        if self.piece is None:
            return 0.5, self.seen(0.5)
        size, low, high, best = 0.03, _SMALLEST, self.piece.largest, (np.inf, 0.0, None)
        for _ in range(_TRIALS):
            seen, left = self._tried(size)
            best = min(best, (abs(np.log(max(left, 1e-12) / wanted)), size, seen), key=lambda b: b[0])
            if best[0] < _NEAR:
                break
            low, high = (size, high) if left < wanted else (low, size)
            guess = size * np.clip(wanted / max(left, 1e-12), 0.03, 5.0)
            size = float(guess if low < guess < high else np.sqrt(low * high))
        if best[0] > _FAR:
            raise ConfigError(f"trial: {self.form}", f"a size of which about {wanted:.3g} standard deviations are left",
                              f"one that is off by a factor of {np.exp(best[0]):.3g}", "draw another seed")
        return best[1], [*best[2], *self.seen(best[1], slice(-1, None))]

    def beyond_mean(self, size, seen):
        """What a recalibrated nominal model leaves where of what is ``seen`` one strength for both ways is known, that
        near the mean of the two which leaves least."""
        return min(self._beside_mean(factor * size, seen) for factor in _NEAR_MEAN)

    def _beside_mean(self, size, seen):
        return self.beside(seen, self.bench.seen(self.bench.motions(PIECES[MEANS[self.form]].laws(self.spot, size))))

    def beside(self, seen, known, changes=()):
        """What a recalibrated nominal model leaves of what is ``seen`` more than with the laws of which ``known`` comes
        (both [(sensor, n)]), and whose values may differ by multiples of ``changes``."""
        more = [b + s - k for b, s, k in zip(self.nominal.base, seen, known, strict=False)]
        return self.nominal.left(more, self.noise, changes)

    def changes(self, size, others, seen):
        """[[(sensor, n)]]: what of that ``seen`` with this law at a ``size`` and the laws ``others`` changes where its
        size or form do, a little."""
        forms = [self.shape[:k] + (abs(u - _LITTLE),) + self.shape[k + 1:] for k, u in enumerate(self.shape)]
        changed = [(self, size * (1 - _LITTLE)), *((replace(self, shape=shape), size) for shape in forms)]
        laws = [(*hiding.piece.laws(hiding.spot, of), *others) for hiding, of in changed]
        return [[c - s for c, s in zip(self.bench.seen(self.bench.motions(each)), seen, strict=False)] for each in laws]

    def _tried(self, size):
        """(What is seen in all runs but the last, what of it is left); infinite where the rig goes too far."""
        try:
            seen = self.seen(size, slice(-1))
        except ConvergenceError:
            return None, np.inf
        return seen, np.inf if _reach(seen, self.nominal.base) > _REACH else self.nominal.left(seen, self.noise)


def _written(random, seen, spread, sensors, colour, gap):
    """(sensor, n) of a run as the channels hold them."""
    count = seen.shape[1]
    return np.array([written(row + std * noise(random, count, colour), s.per_unit, gaps(random, count, gap))
                     for row, std, s in zip(seen, spread, sensors, strict=True)])


def _change(seen, base):
    """Root mean square change relative to the rig alone, of the sensor that changes most."""
    off = np.mean([(a - b) ** 2 for a, b in zip(seen, base, strict=True)], axis=(0, 2))
    return float(np.sqrt((off / np.mean([b**2 for b in base], axis=(0, 2))).max()))


def _reach(seen, base):
    """Largest peak of a sensor over that of the rig alone."""
    far, near = (np.max([abs(s).max(axis=1) for s in runs], axis=0) for runs in (seen, base))
    return float((far / near).max())

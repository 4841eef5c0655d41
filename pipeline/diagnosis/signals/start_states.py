"""States in which recorded runs begin, where nobody states them: parameters of one run each, fitted with all others.

    displacement and velocity of every coordinate at the first sample, and where joints with memory would be relaxed

The last only where the model or a candidate has such joints (``first_loading``). The estimate that fits begin from is
the least-squares solution of the nominal model over its slowest period, from all channels of the run. The prior is as
wide as the energy of the estimate would move each coordinate alone, or as much more as the recording moves beyond what
the estimate explains, so that it says next to nothing beside the data.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.case_models.force_balance import body_names
from pipeline.case_models.virtual_rig import only
from pipeline.contract import BrakechainError, ConfigError
from pipeline.diagnosis.problem import parameter_name
from pipeline.diagnosis.signals.unknown_blow import struck, with_blow
from pipeline.diagnosis.signals.unseen import without_jumps, without_past
from pipeline.diagnosis.signals.usable_runs import usable
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.response import Responder, at_begin, run_drive, run_friction
from pipeline.physics.virtual_rig.roots import linearised

#: owner of the parameters, as effects own theirs, and what they are, with the field of a Start and its unit
START = "start"
_PARTS = {"displacement of": ("displacement", "m"), "velocity of": ("velocity", "m/s"),
          "relaxed position of": ("relaxed", "m")}
#: relative difference of the strengths of free motions that count as one operating point
_ALIKE = 0.1
#: recorded motion that the model at rest shows at most in a run that is taken for a free motion
_STILL = 0.01
#: rounds of the estimate: the first from rest, others about the state that it gave
_ROUNDS = 3
#: change of a state, in units of what its energy would do, over which its effect is taken; before it is known, in SI
_CHANGE, _FIRST = 1e-4, 1e-9
#: singular values of the effects of states, over the largest, below which a state leaves no trace in the recording
_TRACELESS = 1e-6
#: least share of the recorded power that an estimate counts as explaining
_EXPLAINED = 1e-3
#: stiffness of a coordinate over the largest below which nothing makes it vibrate
_FREE = 1e-9


@dataclass(frozen=True)
class StartSpread:
    """Standard deviations of the prior of a start, (n,) each: ``displacement`` m, ``velocity`` m/s, ``relaxed`` m."""

    displacement: np.ndarray
    velocity: np.ndarray
    relaxed: np.ndarray

    @property
    def strength(self):
        """The size (n,) of the motion, whatever its phase at the start."""
        return self.velocity

    def parameters(self, bench, run, remembers):
        """Parameters of the start of a Run about its estimate."""
        names = body_names(bench)
        return tuple(
            Parameter(_name(run.name, part, name), unit, float(value), Normal(float(value), float(std)), run=run.name)
            for part, (field, unit) in _PARTS.items() if remembers or field != "relaxed"
            for name, value, std in zip(names, getattr(run.start, field), getattr(self, field), strict=True))


def started(bench, runs, settings, refused=None):
    """{name: Recorded} with the starts, or blows, that the section ``bench`` asks for, at their estimates.

    ConfigError for a run that is to be fitted and is shorter than a period, or does not show how it began; with
    ``refused``, which gets {name: why}, such runs are left out as long as others are left.
    """
    runs = {name: without_jumps(bench, run) for name, run in runs.items()}
    every = settings.start == "fitted" or settings.measured_start
    if settings.start == "rest" and settings.measured_start:
        raise ConfigError("bench.start", "fitted, or no measured_start", "rest beside measured_start: true")
    if settings.blow is not None and every:
        raise ConfigError("bench.blow", "none where starts are fitted: before a blow the rig is at rest", settings.blow)

    def begun(record):
        if settings.blow is not None:
            return _struck(bench, record, settings.blow) if moves_freely(bench, record) else record
        wanted = every or (settings.start is None and not settings.settled and moves_freely(bench, record))
        return estimated(bench, record) if wanted else record

    if refused is None:
        return _as_repeats({name: begun(run) for name, run in runs.items()})
    runs, left_out = usable(runs, begun)
    refused.update(left_out)
    return _as_repeats(runs)


def _as_repeats(runs):
    """{name: Recorded} in which free motions of about one strength, under the same conditions, repeat the first."""
    firsts, grouped = [], {}
    for name, record in runs.items():
        if record.unknown is not None and not record.repeat_of:
            like = next((first for first in firsts if first.run.conditions == record.run.conditions
                         and np.allclose(first.unknown.strength, record.unknown.strength, rtol=_ALIKE, atol=0)), None)
            if like is None:
                firsts.append(record)
            else:
                record = replace(record, repeat_of=like.run.name)
        grouped[name] = record
    return grouped


def moves_freely(bench, recorded):
    """Whether a Recorded run moves where the bench at rest would not: less than a hundredth of it, in all channels.

    Where a drive turns past contacts nothing moves freely.
    """
    if len(bench.model.contacts.area) and np.any(run_drive(bench, recorded.run)):
        return False
    moving = [k for k, name in enumerate(recorded.channels)
              if next(c.moves for c in bench.channels if c.name == name) and recorded.valid[k].any()]
    if recorded.run.start is not None or not moving or not np.abs(recorded.samples[moving]).any():
        return False
    shown = _shown(bench, recorded.channels, recorded.run)
    return all(np.sqrt(np.mean(shown[k, recorded.valid[k]] ** 2))
               <= _STILL * np.sqrt(np.mean(recorded.samples[k, recorded.valid[k]] ** 2)) for k in moving)


def _struck(bench, recorded, name):
    """The Recorded run with an unknown blow on the input ``name``."""
    return with_blow(bench, recorded, name, _first_samples(bench, recorded.run) - 1, _fastest(bench, recorded.run),
                     lambda run: _shown(bench, recorded.channels, run))


def estimated(bench, recorded):
    """The Recorded run with its start by least squares over the slowest period, and how uncertain that is."""
    recorded = without_past(bench, recorded)
    run, size = recorded.run, bench.model.size
    count = _first_samples(bench, run)
    first, (least, vectors) = run.until(count), _vibrations(bench, run)
    valid = recorded.valid[:, :count]
    samples = np.where(valid, recorded.samples[:, :count], 0.0)
    scale = np.sqrt(np.mean(samples**2, axis=1))
    if not scale.any():
        raise ConfigError(f"run {run.name}: start", "samples of a motion within the first period", "none but zeros",
                          "take a stretch in which the rig moves, or state bench.start: rest")
    weight = valid / np.where(scale > 0, scale, np.inf)[:, None]

    def left(state):
        start = Start(state[:size], state[size:], relaxed=np.zeros(size))
        return (weight * (samples - _shown(bench, recorded.channels, replace(first, start=start)))).ravel()

    state, change = _at_rest(bench, run), np.full(2 * size, _FIRST)
    rest = left(state)
    for _ in range(_ROUNDS):
        effect = np.array([(rest - left(state + step)) / step.sum() for step in np.diag(change)]).T
        moved = state + _least_squares(effect, rest, run.name)
        after = left(moved)
        if not after @ after < rest @ rest:
            break
        state, rest = moved, after
        change = _CHANGE * np.concatenate(_reach(bench.model, state, least, vectors))
    explained = 1 - rest @ rest / np.sum((weight * samples) ** 2)
    spread = [part / np.sqrt(max(explained, _EXPLAINED)) for part in _reach(bench.model, state, least, vectors)]
    start = Start(state[:size], state[size:], relaxed=np.zeros(size))
    return replace(recorded, run=replace(run, start=start), unknown=StartSpread(*spread, spread[0]))


def start_parameters(bench, recorded, remembers):
    """Parameters of how a Recorded run begins; none of one that is known.

    ``remembers``: whether any joint does, so that it matters where they were relaxed.
    """
    return () if recorded.unknown is None else recorded.unknown.parameters(bench, recorded.run, remembers)


def with_starts(nominal, bench, recorded, remembers):
    """The nominal hypothesis with the parameters of the unknown starts of all {name: Recorded}."""
    begins = [p for record in recorded.values() for p in start_parameters(bench, record, remembers)]
    return replace(nominal, parameters=(*nominal.parameters, *begins))


def begun(run, hypothesis, values):
    """The Run with the start, or blow, that the ``values`` {name: value} of a hypothesis give to it, if they do."""
    names, parts = [p.name for p in hypothesis.parameters if p.run == run.name], {}
    run = struck(run, {name: values[name] for name in names})
    for part, (field, _) in _PARTS.items():
        if members := [values[name] for name in names if name.startswith(_name(run.name, part, ""))]:
            parts[field] = np.array(members)
    return replace(run, start=replace(run.start, **parts)) if parts else run


def begun_as(runs, hypothesis, values):
    """{name: Run} with the starts that the ``values`` {name: value} of a hypothesis give to them."""
    return {name: begun(run, hypothesis, values) for name, run in runs.items()}


def held(model, start, known=None):
    """Start of a SlidingModel with coordinates that an effect added: where the springs of the others hold them.

    Where it says more than the ``known`` first ones, the rest is what the others would have to move by so that their
    springs moved these as far beyond: what hardly takes part, as a base that hardly gives way, starts at rest. Of
    coordinates that a vanishing effect did not add, nothing is kept.
    """
    size = len(start.displacement)
    known = min(size if known is None else known, size, model.size)
    if known == size == model.size:
        return start
    stiffness = model.supported()[2]
    follows = -np.linalg.pinv(stiffness[known:, known:]) @ stiffness[known:, :known]

    def whole(value):
        own, beyond = value[known:model.size], np.zeros(model.size - known)
        beyond[:len(own)] = own
        return np.append(value[:known], follows @ value[:known] + abs(follows).sum(axis=1) * beyond)

    every = {field: getattr(start, field) for field, _ in _PARTS.values()}
    return replace(start, **{field: whole(value) for field, value in every.items() if value is not None})


def own_start(run, field, coordinate):
    """Name of the parameter of a run for a ``field`` of the start of a coordinate that an effect adds."""
    return _name(run, next(part for part, (of, _) in _PARTS.items() if of == field), coordinate)


def _name(run, part, coordinate):
    return parameter_name(START, run, f"{part} {coordinate}")


def _shown(bench, channels, run):
    answer = Responder(only(bench, channels)).respond(run)
    return np.array([answer[c] for c in channels])


def _at_rest(bench, run):
    """State (2 n,) in which the bench starts of itself."""
    size, displacement = bench.model.size, np.zeros(bench.model.size)
    if bench.settled:
        speed, inputs = at_begin(bench, run)
        displacement = steady_start(bench.model.at_speed(speed), bench.law, run_friction(bench, run),
                                    inputs).displacement
    return np.concatenate((displacement, np.zeros(size)))


def _vibrations(bench, run):
    """(Squares of angular frequencies (n,), shapes (n, n) of unit mass) of the undamped bench; 0: nothing holds it."""
    mass, _, stiffness = bench.model.supported(gyroscopic=False)
    with suppress(BrakechainError):         # contacts that do not yield, friction with states
        stiffness = linearised(bench, run)[2]
    return scipy.linalg.eigh((stiffness + stiffness.T) / 2, (mass + mass.T) / 2)


def _first_samples(bench, run):
    """Number of samples of the slowest period of a run. ConfigError where the run is shorter."""
    square = _vibrations(bench, run)[0]
    held_by_springs = square[square > _FREE * abs(square).max()]
    if not len(held_by_springs):
        return run.samples
    period = 2 * np.pi / np.sqrt(held_by_springs.min())
    if run.duration < period:
        raise ConfigError(f"run {run.name}: start", f"a run of at least one period, {period:.3g} s, so that its start"
                          " can be estimated", f"{run.duration:.3g} s", "record longer, or state bench.start: rest")
    return min(int(np.ceil(period * run.sample_rate)) + 1, run.samples)


def _fastest(bench, run):
    """Highest natural frequency in Hz that the samples of a run resolve; half their rate where there is none."""
    natural, limit = np.sqrt(np.maximum(_vibrations(bench, run)[0], 0.0)) / (2 * np.pi), run.sample_rate / 2
    return float(natural[natural < limit].max(initial=0.0)) or limit


def _reach(model, state, square, shapes):
    """(Displacement (n,), velocity (n,)) of each coordinate alone with the energy of a state."""
    size = len(square)
    slowest = max(square[square > _FREE * abs(square).max()].min(initial=np.inf), 0.0) if len(square) else 0.0
    square = np.maximum(square, slowest if np.isfinite(slowest) else 1.0)
    modal = np.linalg.solve(shapes, np.column_stack((state[:size], state[size:])))
    energy = max(np.sum(square * modal[:, 0] ** 2) + np.sum(modal[:, 1] ** 2), np.finfo(float).tiny)
    return (np.sqrt(energy * np.sum(shapes**2 / square, axis=1)), np.sqrt(energy * np.sum(shapes**2, axis=1)))


def _least_squares(effect, left, run):
    """Change (2 n,) of the state that takes most of ``left``. ConfigError where some state leaves no trace."""
    size = np.linalg.norm(effect, axis=0)
    values = np.linalg.svd(effect / np.where(size > 0, size, 1.0), compute_uv=False)
    seen = int((values > _TRACELESS * values[0]).sum()) if size.all() else int((size > 0).sum())
    if seen < len(size):
        raise ConfigError(f"run {run}: start", f"channels that show, within the first period, how all {len(size) // 2}"
                          " coordinates began", f"{seen} of {len(size)} displacements and velocities",
                          "record more points or longer, or state bench.start: rest")
    return np.linalg.lstsq(effect / size, left)[0] / size

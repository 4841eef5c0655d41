"""Runs simulated with parameters and effects: the forward model of forced recordings."""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.case_models import corrections
from pipeline.case_models.virtual_rig import only
from pipeline.contract import ConfigError
from pipeline.diagnosis.experiment_design.next_run import altered
from pipeline.diagnosis.problem import label, parameter_name, split_name
from pipeline.diagnosis.settings import prior_of
from pipeline.diagnosis.signals.start_states import begun, held
from pipeline.effects import CATALOGUE, named
from pipeline.effects.effect import Term, compose
from pipeline.effects.typical import CHANNEL, JOINT, typical
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed
from pipeline.physics.time_stepping.elements import alone
from pipeline.physics.time_stepping.first_loading import remembers_loading
from pipeline.physics.virtual_rig.response import Responder

#: the solver as a hypothesis: its place, and its parameter: 0 as it is, 1 with half its step (4/3: none, at order 2)
STEP, SOLVER, REFINEMENT = "time_step", "solver", "refinement"
#: bytes of motions that are kept: some dozens of every run of a rig
_MOTIONS = 2**24
#: names of all effects; the solver and the friction map are none
NAMES = frozenset(effect.name for effect in CATALOGUE)


def observed(recorded, noise_std=None, held_out=False):
    """Observed of a Recorded run; ``noise_std`` {channel: SI value} where it is given, then of all its channels."""
    run, channels = recorded.run, recorded.channels
    lacking = [c for c in channels if c not in noise_std] if noise_std else []
    if lacking:
        raise ConfigError("diagnosis.noise.std", f"the noise of every channel of run {run.name}, or of none",
                          f"none of {', '.join(lacking)}", "give it too, or leave all to the repeats of runs")
    stated = np.array([noise_std[c] for c in channels]) if noise_std else None
    return Observed(run.name, run.conditions, channels, recorded.samples, run.sample_rate, recorded.valid,
                    noise_std=stated, held_out=held_out, repeat_of=recorded.repeat_of,
                    unlike=recorded.unknown is not None)


def completed(bench, hypothesis, values):
    """The bench with the values of a hypothesis: corrected numbers first, then its effects."""
    numbers = {p.name: values[p.name] for p in hypothesis.parameters
               if split_name(p.name)[:2] in (("", ""), *(() if bench.stated is None else bench.stated.pairs))}
    return compose(corrections.corrected(bench, numbers), terms(hypothesis, values))


def terms(hypothesis, values):
    """Terms of a Hypothesis with its ``values``; what is no effect of the catalogue, as the solver, is none."""
    given = {pair: {} for pair in hypothesis.effects if pair[0] in NAMES}
    for name, value in values.items():
        effect, location, parameter = split_name(name)
        if (effect, location) in given:
            given[effect, location][parameter] = value
    return tuple(Term(named(effect), location, numbers) for (effect, location), numbers in given.items())


@dataclass(frozen=True)
class Simulated:
    """Picklable prediction, of cut runs too: ``runs`` {name: Run}.

    ``altered`` {name: changes}: runs on another bench, see ``next_run``; ``built`` holds the last bench and what its
    runs share, ``motions`` what was measured of late before sensors wrote it; both are left out of pickles.
    """

    bench: object
    runs: dict
    altered: dict = field(default_factory=dict)
    built: dict = field(default_factory=dict, compare=False)
    motions: dict = field(default_factory=dict, compare=False)

    def __call__(self, hypothesis, values, run):
        observed_run, kept = begun(self.runs[run.name], hypothesis, values), run.samples.shape[1]
        observed_run = observed_run.until(kept) if kept < observed_run.samples else observed_run
        change = self.altered.get(run.name, {})
        responder = self._responder(hypothesis, values, run.channels, change)
        if observed_run.start is not None:
            start = held(responder.bench.model, observed_run.start, self.bench.model.size)
            observed_run = replace(observed_run, start=start)
        measured = self._measured(responder, observed_run, (kept, run.channels, *_moving(hypothesis, values)))
        answer = responder.written(observed_run, measured)
        predicted = np.array([answer[c] for c in run.channels])
        refinement = values.get(parameter_name(STEP, SOLVER, REFINEMENT), 0.0)
        if not refinement:
            return predicted
        return predicted + refinement * halved(responder.bench, observed_run, run.channels, predicted)

    def __reduce__(self):
        return Simulated, (self.bench, self.runs, self.altered)

    def _measured(self, responder, run, key):
        """Measured of a Run, as it was for the same ``key``: where gain or delay of a channel alone changes, as for its
        derivative, bodies move as before."""
        key, motions = (run.name, *key), self.motions
        if key not in motions:
            motions[key] = responder.measured(run)
            while len(motions) > 1 and len(motions) * motions[key].size > _MOTIONS:
                del motions[next(iter(motions))]
        return motions[key]

    def _responder(self, hypothesis, values, channels, change):
        """Responder of a hypothesis, kept as long as run after run asks for the same values and channels."""
        finer = hypothesis.halvings
        key = (hypothesis.effects, finer, tuple(values[p.name] for p in hypothesis.parameters if not p.run))
        if key not in self.built:
            self.built.clear()
            self.built[key] = completed(self.bench, hypothesis, values)
        bench = self.built[key]
        if change:
            return Responder(only(altered(bench, change), channels), halvings=finer)
        if channels not in self.built:
            self.built[channels] = Responder(only(bench, channels), halvings=finer)
        return self.built[channels]


def _moving(hypothesis, values):
    """What the motion of bodies follows from: (effects, halvings, values but those of nominal channels)."""
    return (hypothesis.effects, hypothesis.halvings,
            tuple(values[p.name] for p in hypothesis.parameters if not p.name.startswith("channels.")))


def shown(bench, run, channels):
    """Samples (c, n) of ``channels`` in one run; see ``held`` for starts that lack coordinates of the bench."""
    return _answer(Responder(only(bench, channels)), run, channels)


def _answer(responder, run, channels):
    bench = responder.bench
    if run.start is not None:
        run = replace(run, start=held(bench.model, run.start))
    answer = responder.respond(run)
    return np.array([answer[c] for c in channels])


def halved(bench, run, channels, predicted):
    """(c, n) what half the step changes in what is ``predicted`` (c, n) of one run."""
    return shown(replace(bench, step=bench.step / 2), run, channels) - predicted


def reach(bench, recorded):
    """Root mean square of recorded over nominal motion, over all displacement, velocity and acceleration channels.

    A resonance that missing physics limits moves much less than its nominal model: priors follow the recording.
    """
    ratios = []
    for record in recorded:
        for channel, samples, valid, known in zip(record.channels, record.samples, record.valid,
                                                  shown(bench, record.run, record.channels), strict=True):
            moves = next(c.moves for c in bench.channels if c.name == channel)
            if moves and valid.any() and known[valid].any():
                ratios.append(np.sqrt(np.mean(samples[valid] ** 2) / np.mean(known[valid] ** 2)))
    return float(np.exp(np.mean(np.log(ratios)))) if ratios and min(ratios) > 0 else 1.0


def remembers(bench, candidates):
    """Whether the bench, alone or with one of the ``candidates``, has joints that remember how they were loaded."""
    benches = (bench, *(completed(bench, c, {p.name: p.nominal for p in c.parameters}) for c in candidates))
    return any(remembers_loading(alone(each.model.elements)) for each in benches)


def largest(recorded):
    """{channel: largest recorded size of a sample} over [Recorded]."""
    peaks = {}
    for record in recorded:
        for channel, samples, valid in zip(record.channels, record.samples, record.valid, strict=True):
            peaks[channel] = max(peaks.get(channel, 0.0), float(np.abs(samples[valid]).max(initial=0.0)))
    return peaks


def candidates(bench, runs, catalogue, places=(), scale=1.0, priors=(), peaks=(), refused=None):
    """Hypotheses of every effect at each of its places (of ``places`` where given), with priors of nominal sizes.

    ``scale``: recorded over nominal motion (see ``reach``); ``peaks``: what channels showed at most (see ``largest``);
    ``priors`` {effect.parameter: section Prior} that are known otherwise. Effects that nominal runs give no size of are
    left out; ``refused`` gets a sentence for each.
    """
    hypotheses, sizes = [], {}
    for effect in catalogue:
        for location in effect.locations(bench) if effect.conditions_known(runs) else ():
            if places and location not in places:
                continue
            kind = effect.kind_at(location), location
            if kind not in sizes:       # nominal runs are simulated once for all effects of a place
                size = typical(kind[0], bench, location, runs).scaled(scale)
                sizes[kind] = _as_recorded(size, kind, bench, dict(peaks))
            pair = effect.name, location
            try:
                sized = effect.parameters(sizes[kind])
            except (ConfigError, ArithmeticError) as error:
                if refused is None:
                    raise
                refused.append(f"{label((pair,))} is not weighed: the nominal runs give no size of it"
                               f" ({error}); state one in diagnosis.priors, or leave it out")
                continue
            parameters = tuple(_named(p, effect, location, dict(priors)) for p in sized)
            hypotheses.append(Hypothesis(label((pair,)), (pair,), parameters, effect.kind,
                                         elaborate=effect.elaborate,
                                         extends=tuple(label(((name, location),)) for name in effect.extends)))
    return tuple(hypotheses)


def _as_recorded(size, kind, bench, peaks):
    """Typical quantities with what recordings show at most: of a channel, and of a joint without a spring, whose force
    no nominal motion tells, the largest force that a channel shows."""
    if kind[0] == CHANNEL:
        return replace(size, shown=peaks.get(kind[1]) or size.shown)
    if kind[0] == JOINT and not size.stiffness:
        forces = [peaks.get(c.name, 0.0) for c in bench.channels if c.measurand.unit == "N"]
        return replace(size, force=max([size.force, *forces]))
    return size


def _named(parameter, effect, location, priors):
    """The parameter of an effect under its name at a place, with the prior that the case states for it, if any.

    The size that recordings suggest gives way to the middle of a stated prior that excludes it.
    """
    key, name = f"{effect.name}.{parameter.name}", parameter_name(effect.name, location, parameter.name)
    if key not in priors:
        return replace(parameter, name=name)
    prior = prior_of(parameter.unit, parameter.nominal, priors[key], f"diagnosis.priors.{key}")
    low, high = prior.support
    size = parameter.nominal if low <= parameter.nominal <= high else prior.quantile(0.5)
    return replace(parameter, name=name, nominal=size, prior=prior, stated=True)


def solver_candidate():
    """The hypothesis that the time step is too long."""
    name = parameter_name(STEP, SOLVER, REFINEMENT)
    return Hypothesis(label(((STEP, SOLVER),)), ((STEP, SOLVER),),
                      (Parameter(name, "1", 0.0, Normal(0.0, 1.0), 0.0),), "numerics")

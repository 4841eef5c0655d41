"""What a diagnosis is asked: observed runs, a forward model, the nominal hypothesis and candidates."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from pipeline.contract.errors import ConfigError


@dataclass(frozen=True)
class Observed:
    """One run as sampled: ``samples`` (c, n) of ``channels`` (c,), each channel in its own SI unit.

    ``valid`` (c, n): False where a sample is missing (default: none is). ``rate`` [Hz]; None for features without an
    order in time (frequencies, growth rates), which then count as independent. ``noise_std`` (c,) or (c, n), or
    ``noise_psd`` (c, f), one-sided on the even grid from 0 to rate/2 [unit^2/Hz]; neither: noise is estimated.
    A held-out run is never fitted. ``repeat_of`` names the run whose conditions this one repeats; ``unlike``: it begins
    otherwise than its repeats, so that their difference is no noise.
    """

    name: str
    conditions: dict
    channels: tuple
    samples: np.ndarray
    rate: float | None = None
    valid: np.ndarray | None = None
    noise_std: np.ndarray | None = None
    noise_psd: np.ndarray | None = None
    held_out: bool = False
    repeat_of: str = ""
    unlike: bool = False

    def __post_init__(self):
        samples = np.asarray(self.samples, dtype=float)
        valid = np.ones(samples.shape, bool) if self.valid is None else np.asarray(self.valid, bool)
        if samples.ndim != 2 or samples.shape[0] != len(self.channels) or valid.shape != samples.shape:
            raise ConfigError(f"run {self.name}", f"samples and mask of {len(self.channels)} channels",
                              f"shapes {samples.shape} and {valid.shape}")
        if not np.isfinite(samples[valid]).all():
            raise ConfigError(f"run {self.name}", "finite samples", "others", "mark missing samples in the mask")
        object.__setattr__(self, "samples", np.where(valid, samples, 0.0))
        object.__setattr__(self, "valid", valid)

    def until(self, end):
        """The run cut to its first ``end`` samples; what it says of noise is that of the whole run."""
        return replace(self, samples=self.samples[:, :end], valid=self.valid[:, :end])

    @property
    def point(self):
        """Name of its operating point: repeats of one run share it."""
        return self.repeat_of or self.name


@dataclass(frozen=True)
class Hypothesis:
    """What may be so: ``effects`` ((effect, place), ...) and ``parameters`` (Parameter, ...) that come with them.

    ``kind``: ``physics``, ``sensor`` (the measurement) or ``numerics`` (the solver). ``elaborate``: weighed only where
    simpler ones leave something. ``extends``: names of hypotheses that it has as limits, beside which it counts by what
    it adds to them; no two of such a family act together.
    ``halvings``: how many times the time step of the forward model is halved where its error would matter, or, below
    0, doubled where it would not (see ``fitting.step_error``).
    """

    name: str
    effects: tuple = ()
    parameters: tuple = ()
    kind: str = "physics"
    elaborate: bool = False
    extends: tuple = ()
    halvings: int = 0

    def __post_init__(self):
        names = [p.name for p in self.parameters]
        if len(set(names)) < len(names):
            raise ConfigError(f"hypothesis {self.name}", "parameters of different names", ", ".join(names),
                              "carry the effect and its place in the name")
        if self.kind not in ("physics", "sensor", "numerics"):
            raise ConfigError(f"hypothesis {self.name}: kind", "physics, sensor or numerics", self.kind)

    @property
    def places(self):
        """Places of its effects, a set."""
        return {place for _, place in self.effects}

    @property
    def nominal(self):
        """Latent coordinates (k,) of the nominal values."""
        return np.array([p.prior.latent(p.nominal) for p in self.parameters], dtype=float)

    def values(self, latent):
        """{name: value} at latent coordinates (k,)."""
        return {p.name: float(p.prior.value(u)) for p, u in zip(self.parameters, latent, strict=True)}

    def in_run(self, values, run):
        """``values`` {name: value} as they are in the run of this name: those that differ between runs are its own."""
        own = {}
        for p in self.parameters:
            if p.of and p.run == run:
                factor = p.prior.support[0] >= 0
                own[p.of] = values[p.of] * values[p.name] if factor else values[p.of] + values[p.name]
        return values | own if own else values

    @property
    def shared(self):
        """True (k,) for parameters that may change every run, False for those of one run alone."""
        return np.array([not p.run for p in self.parameters], dtype=bool)

    @property
    def sizes(self):
        """Indices of the parameters, of all runs alike, at whose null an effect vanishes."""
        return [k for k, p in enumerate(self.parameters) if p.null is not None and not p.run]

    @property
    def shaping(self):
        """Indices of the parameters of a candidate, of all runs alike, that only shape it."""
        return [k for k, p in enumerate(self.parameters) if p.null is None and not p.run]

    def moves(self, run):
        """True (k,) for parameters that may change the prediction of the run of this name."""
        return np.array([p.run in ("", run) for p in self.parameters], dtype=bool)

    def excludes(self, other):
        """Whether the two cannot act together: one law or more of one family, or two faulty sensors.

        Of a family one is the other's limit, or they share a limit. Gains of several sensors shrink all data together,
        which takes away what is left without explaining anything.
        """
        own, others = {self.name, *self.extends}, {other.name, *other.extends}
        return bool(own & others) or self.kind == other.kind == "sensor"

    def joined(self, other):
        """Both together, named by their effects."""
        name = f"{self.name} + {other.name}" if self.effects else other.name
        kind = other.kind if not self.effects or other.kind == self.kind else "physics"
        return Hypothesis(name, self.effects + other.effects, self.parameters + other.parameters, kind,
                          halvings=max(self.halvings, other.halvings))


class ForwardModel(Protocol):
    """(c, n): what the channels of a run (Observed) would show under a hypothesis.

    ``values`` holds every parameter of the hypothesis by name: nominal ones first, then those of its effects. Runs in
    order of time may come cut to their first samples, so that only these need to be predicted. One that steps through
    time halves its step as often as the hypothesis says. It may raise a
    BrakechainError where it cannot predict (no convergence); it must be picklable to fan out.
    """

    def __call__(self, hypothesis: Hypothesis, values: dict, run: Observed) -> np.ndarray: ...


class FanOut(Protocol):
    """Maps a function over items as the builtin ``map`` does: in this process, in several, or on a cluster."""

    def __call__(self, function: Callable, items: Iterable, /) -> Iterable: ...


@dataclass(frozen=True)
class Problem:
    """Observed ``runs``, the forward model ``predict`` and the ``nominal`` hypothesis.

    ``own`` {run name: number of parameters of that run alone that a hypothesis has at most}, of the nominal one where
    not given (``for_all``): by it the first part of a held-out run is as long for all that are compared. ``stepped``:
    whether what a model is off by grows along a run, so that its begin is easier to fit than the whole of it.
    """

    runs: tuple
    predict: ForwardModel
    nominal: Hypothesis
    own: dict = field(default_factory=dict)
    stepped: bool = True

    def __post_init__(self):
        names = [run.name for run in self.runs]
        if not names:
            raise ConfigError("diagnosis", "at least one recorded run", "none", "name the recordings in the case")
        if len(set(names)) < len(names):
            raise ConfigError("diagnosis", "runs of different names", ", ".join(names))
        if not self.training:
            raise ConfigError("diagnosis", "at least one run to fit", "all runs held out", "hold fewer runs out")
        known = set(names)
        for run in self.runs:
            if run.repeat_of and run.repeat_of not in known:
                raise ConfigError(f"run {run.name}: repeat_of", f"one of {', '.join(names)}", run.repeat_of)

    @property
    def shown(self):
        """The forward model without what only keeps fits honest, as noise in place of what a law takes off it."""
        return getattr(self.predict, "plain", self.predict)

    @property
    def training(self):
        return tuple(run for run in self.runs if not run.held_out)

    @property
    def held_out(self):
        return tuple(run for run in self.runs if run.held_out)

    def for_all(self, candidates):
        """The same problem, its ``own`` those of the nominal hypothesis with that of ``candidates`` that has most."""
        def count(hypothesis, run):
            return sum(p.run == run.name for p in hypothesis.parameters)

        return replace(self, own={run.name: max((count(c, run) for c in candidates), default=0)
                                  + count(self.nominal, run) for run in self.runs} | self.own)

    def own_parameters(self, run):
        """How many parameters of ``run`` alone there are to fit."""
        return self.own.get(run.name, sum(p.run == run.name for p in self.nominal.parameters))

    def given(self, candidate):
        """The same problem with ``candidate`` taken as known: its effects and parameters join the nominal ones."""
        return replace(self, nominal=self.nominal.joined(candidate))


class LinearInLaws(ForwardModel, Protocol):
    """A ForwardModel along measured motions, which knows what errors of laws change in its predictions."""

    def law_errors(self, hypothesis, values, run, effects) -> list:
        """[(c, n)] what ``effects`` of a hypothesis change, times shapes that tell other laws of their kind apart."""


class Motions(Protocol):
    """Measured motions of all coordinates."""

    def along(self, null) -> Problem:
        """The Problem of the fitted runs along their motions, its forward model LinearInLaws.

        Raises what the forward model raises.
        """


def operating_points(runs):
    """{point: indices into ``runs``}, in order of appearance."""
    points = {}
    for index, run in enumerate(runs):
        points.setdefault(run.point, []).append(index)
    return points

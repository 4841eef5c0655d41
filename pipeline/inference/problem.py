"""What a diagnosis is asked: observed runs, a forward model, the nominal hypothesis and candidates."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError


@dataclass(frozen=True)
class Observed:
    """One run as sampled: ``samples`` (c, n) of ``channels`` (c,), each channel in its own SI unit.

    ``valid`` (c, n): False where a sample is missing (default: none is). ``rate`` [Hz]; None for features without an
    order in time (frequencies, growth rates), which then count as independent. ``noise_std`` (c,) or (c, n), or
    ``noise_psd`` (c, f), one-sided on the even grid from 0 to rate/2 [unit^2/Hz]; neither: noise is estimated.
    A held-out run is never fitted. ``repeat_of`` names the run whose conditions this one repeats.
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

    def until(self, kept):
        """The run cut to its first ``kept`` samples; what it says of noise is that of the whole run."""
        return replace(self, samples=self.samples[:, :kept], valid=self.valid[:, :kept])

    @property
    def point(self):
        """Name of its operating point: repeats of one run share it."""
        return self.repeat_of or self.name


@dataclass(frozen=True)
class Hypothesis:
    """What may be so: ``effects`` ((effect, place), ...) and ``parameters`` (Parameter, ...) that come with them.

    ``kind``: ``physics``, ``sensor`` (the measurement) or ``numerics`` (the solver). ``forbidden(values)``: a sentence
    where fitted values cannot be (a negative dissipation), else empty; priors already keep single signs.
    """

    name: str
    effects: tuple = ()
    parameters: tuple = ()
    kind: str = "physics"
    forbidden: Callable | None = None

    def __post_init__(self):
        names = [p.name for p in self.parameters]
        if len(set(names)) < len(names):
            raise ConfigError(f"hypothesis {self.name}", "parameters of different names", ", ".join(names),
                              "carry the effect and its place in the name")
        if self.kind not in ("physics", "sensor", "numerics"):
            raise ConfigError(f"hypothesis {self.name}: kind", "physics, sensor or numerics", self.kind)

    @property
    def nominal(self):
        """Latent coordinates (k,) of the nominal values."""
        return np.array([p.prior.latent(p.nominal) for p in self.parameters], dtype=float)

    def values(self, latent):
        """{name: value} at latent coordinates (k,)."""
        return {p.name: float(p.prior.value(u)) for p, u in zip(self.parameters, latent, strict=True)}

    def joined(self, other):
        """Both together, named by their effects."""
        name = f"{self.name} + {other.name}" if self.effects else other.name
        kind = other.kind if not self.effects or other.kind == self.kind else "physics"
        return Hypothesis(name, self.effects + other.effects, self.parameters + other.parameters, kind)


@dataclass(frozen=True)
class Problem:
    """``predict(hypothesis, values, run)`` -> (c, n), what the channels of ``run`` (Observed) would show.

    Runs in order of time may come cut to their first samples, so that only these need to be predicted.
    ``values`` holds every parameter of the hypothesis by name: those of ``nominal`` first, then those of its effects.
    ``predict`` may raise a BrakechainError where it cannot (no convergence); it must be picklable to fan out.
    """

    runs: tuple
    predict: Callable
    nominal: Hypothesis

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
    def training(self):
        return tuple(run for run in self.runs if not run.held_out)

    @property
    def held_out(self):
        return tuple(run for run in self.runs if run.held_out)

    def given(self, candidate):
        """The same problem with ``candidate`` taken as known: its effects and parameters join the nominal ones."""
        return replace(self, nominal=self.nominal.joined(candidate))


def operating_points(runs):
    """{point: indices into ``runs``}, in order of appearance."""
    points = {}
    for index, run in enumerate(runs):
        points.setdefault(run.point, []).append(index)
    return points

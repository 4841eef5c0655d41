"""The problem that a diagnosis solves, whatever was recorded: runs, a forward model, hypotheses, noise, and how to read
what is left."""

from dataclasses import dataclass
from typing import Any, Protocol

from pipeline.inference.diagnosis import Diagnosis, Settings
from pipeline.inference.problem import Hypothesis, Motions, Problem
from pipeline.inference.procedure import diagnose
from pipeline.inference.time_budget import TimeBudget


class LocatedAxes(dict):
    """{axis: ...} of a Locator, with ``failures``: a sentence for each axis that could not be computed."""

    failures = ()


class Locator(Protocol):
    """Where the mismatch lies: {axis: (Location, unit of its bins or "", edges (n, 2) or None)}, or LocatedAxes."""

    def located(self, diagnosis: Diagnosis) -> dict: ...


class LatentForces(Protocol):
    """What force is missing at the leading place, whatever its physics."""

    def described(self, diagnosis: Diagnosis, axes: dict) -> Any:
        """Description of the force, or None where nothing stands out of the noise."""

    def predicted(self, diagnosis: Diagnosis, description: Any) -> Any:
        """LatentUse: held-out runs with this force."""


class SquealComparison(Protocol):
    """Saturated squeal of recordings beside that of the recalibrated and the completed model (Fits)."""

    def compared(self, recalibrated, completed) -> dict: ...


class Revision(Protocol):
    """What this kind of data adds to the product Diagnosis, or lets it say only with reserve."""

    def revised(self, product, diagnosis: Diagnosis): ...


#: hypotheses whose time is told
_TOLD = 3


@dataclass(frozen=True)
class Nowhere:
    """Locator of data that cannot locate."""

    def located(self, diagnosis):
        return {}


@dataclass(frozen=True)
class DiagnosisProblem:
    """Runs, forward model and nominal hypothesis (``problem``), their {run: Noise} ``budget`` and the ``candidates``
    (Hypotheses of effects alone), solved under ``settings``.

    ``units`` {channel: SI unit}. ``latent`` describes a missing force, which predicts held-out runs where
    ``predicts_with_force``. ``next_runs`` (Observed, whose samples do not count): what could be recorded next, named by
    what is changed, each with its budget. ``noise_levels``: multiples of the noise at which the verdict is told too.
    ``nuisances``: hidden values (Hypotheses of parameters alone) that the case declares.
    ``motions``: measured ones of all coordinates, along which several laws are selected. ``step``: time step of the
    model in s, 0 where it does not step through time. ``remarks``: sentences on what could not be used of the case.
    """

    problem: Problem
    budget: dict
    candidates: tuple
    units: dict
    settings: Settings = Settings()
    locator: Locator = Nowhere()
    latent: LatentForces | None = None
    predicts_with_force: bool = False
    squeals: SquealComparison | None = None
    revision: Revision | None = None
    next_runs: tuple = ()
    noise_levels: tuple = ()
    motions: Motions | None = None
    step: float = 0.0
    remarks: tuple = ()
    nuisances: tuple = ()

    def __post_init__(self):
        object.__setattr__(self, "problem", self.problem.for_all(self.candidates))

    @property
    def rules(self):
        return self.settings.rules

    def solved(self, fan_out=map, log=None):
        """Diagnosis by the five steps of inference, within the time of the settings; ``log`` gets sentences: what is
        decided first, and what took the time."""
        time, said = TimeBudget(self.settings.seconds), log or (lambda _: None)

        def tell(decision):
            first = next(filter(None, (*decision.named, decision.leading)), None)
            said(f"first verdict after {time.used:.0f} s: {decision.verdict}"
                 + (f", led by {first.name}" if first else "") + "; it is sharpened")

        with time.counting():
            solved = diagnose(self.problem, self.budget, self.candidates, self.settings, time.over(fan_out),
                              self.motions, tell, self.nuisances)
        most = ", ".join(f"{name} {seconds:.0f} s" for name, seconds in time.by_name.most_common(_TOLD) if name)
        said(f"{time.used:.0f} s of a core were used" + f", most by {most}" * bool(most))
        return solved


def parameter_name(effect, location, parameter):
    """Name of a parameter of an effect at a location, among all parameters of a hypothesis."""
    return f"{effect}@{location}.{parameter}"


def split_name(name):
    """(effect, location, parameter) of such a name, all empty for a nominal one; locations may hold dots."""
    effect, _, rest = name.partition("@") if "@" in name else ("", "", "")
    location, _, parameter = rest.rpartition(".")
    return effect, location, parameter


def label(effects):
    """Name of a hypothesis from its ((effect, location), ...)."""
    return " + ".join(f"{effect} at {location}" for effect, location in effects)


def nominal(parameters):
    """The hypothesis that nothing is missing."""
    return Hypothesis("nominal", (), tuple(parameters))

"""The question that a diagnosis answers: runs, a forward model, hypotheses, noise, and where it looks for the place."""

from collections.abc import Callable
from dataclasses import dataclass

from pipeline.inference import procedure as course
from pipeline.inference.decision.decision_rules import Rules
from pipeline.inference.problem import Hypothesis, Problem


def _nowhere(diagnosis):
    return {}


def nothing(first, second):
    """What a Question answers where it is not asked."""
    return


@dataclass(frozen=True)
class Question:
    """A Problem with {run: Noise} ``budget`` and ``candidates`` (Hypotheses of effects alone).

    ``units`` {channel: SI unit}; ``axes(diagnosis)`` -> {axis: (Location, unit, edges)} tells where the mismatch lies,
    ``describe(diagnosis, axes)`` -> Description or None what force is missing there, whatever its physics;
    ``use(diagnosis, description)`` -> LatentUse or None predicts held-out runs with that force, where this is asked;
    ``squeal(recalibrated, completed)`` of their Fits -> {run: Compared} or None verifies by saturated squeal;
    ``next_runs`` (Observed, whose samples do not count): what could be recorded next, named by what is changed, each
    with its budget;
    ``starts``: latent values of effects where fits begin, beside those of the screen.
    """

    problem: Problem
    budget: dict
    candidates: tuple
    units: dict
    rules: Rules = Rules()
    axes: Callable = _nowhere
    describe: Callable = nothing
    use: Callable = nothing
    squeal: Callable = nothing
    next_runs: tuple = ()
    starts: tuple = course.Settings.starts


def parameter_name(effect, place, parameter):
    """Name of a parameter of an effect at a place, among all parameters of a hypothesis."""
    return f"{effect}@{place}.{parameter}"


def split_name(name):
    """(effect, place, parameter) of such a name, all empty for a nominal one; places may hold dots."""
    effect, _, rest = name.partition("@") if "@" in name else ("", "", "")
    place, _, parameter = rest.rpartition(".")
    return effect, place, parameter


def label(effects):
    """Name of a hypothesis from its ((effect, place), ...)."""
    return " + ".join(f"{effect} at {place}" for effect, place in effects)


def nominal(parameters):
    """The hypothesis that nothing is missing."""
    return Hypothesis("nominal", (), tuple(parameters))

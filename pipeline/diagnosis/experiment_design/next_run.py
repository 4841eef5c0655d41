"""What to record next: runs like a fitted one with one thing changed each, and the one that separates a tie best.

A condition or number of the bench is given as a value with its unit, or as a factor on that of the recorded run:

    normal_load: [2 N, 10 N]        joints.arm.stiffness: [5]        drive: [0.1]

Numbers of the bench are changed as each hypothesis has completed it: an arm five times as stiff is so with all that
gives way in it.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models import corrections
from pipeline.contract import BrakechainError, ConfigError
from pipeline.contract.units import to_si
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.planning.experiment_choice import choose, predicted
from pipeline.inference.problem import Observed
from pipeline.physics.virtual_rig.inputs import input_unit, stated_inputs
from pipeline.physics.virtual_rig.normal_load import CONDITION as NORMAL_LOAD
from pipeline.physics.virtual_rig.response import Run, run_drive

#: factor on the speed of the drive, whether it is constant or recorded
DRIVE = "drive"
#: fields of the product Diagnosis where no next experiment is told
NOTHING = {"next_condition": [], "next_separates": [], "next_value": 0.0}


@dataclass(frozen=True)
class Feasible:
    """A run that could be recorded: ``observed``, whose samples do not count, what is done, what bench it is done on.

    ``altered`` {number of the bench: (value in SI or factor, whether it is a factor)}.
    """

    observed: Observed
    run: Run
    altered: dict


@dataclass(frozen=True)
class Planned:
    """A record that could be made like the recorded run ``like``, whose noise it has: ``shown``, what its forward model
    makes of a record (a Balance on the nominal bench, Features); ``altered`` as of a Feasible run."""

    name: str
    like: str
    shown: object
    altered: dict


def feasible(bench, given, like, where="diagnosis.next"):
    """Feasible runs (n,) of the section ``next`` {name: values}, each like the Recorded ``like`` but for one thing.

    ConfigError for names that the bench does not have, and units that do not fit.
    """
    runs = []
    for name, values in given.items():
        for value in values:
            run, altered = changed(bench, like.run, name, value, f"{where}.{name}")
            condition = words(name, value)
            blank = Observed(condition, run.conditions, like.channels, np.zeros(like.samples.shape), run.sample_rate)
            runs.append(Feasible(blank, replace(run, name=condition), altered))
    return tuple(runs)


def words(name, value):
    """What is changed, as it is told: 'load = 5 N', 'stiffness x 5'."""
    return f"{name} = {value}" if isinstance(value, str) else f"{name} x {value:g}"


def altered(bench, changes):
    """The bench with the changed numbers of a Feasible run."""
    return corrections.corrected(bench, {name: value * corrections.nominal(bench, name) if factor else value
                                         for name, (value, factor) in changes.items()})


def next_experiment(problem, diagnosis):
    """Fields next_condition, next_separates and next_value of the product Diagnosis; empty where nothing is tied.

    Predictions are tempered as the evidence was: by the mean weight of the fitted runs. Runs that one of the rivals
    cannot predict are left out.
    """
    rivals = rivals_of(diagnosis)
    planned = [(run, _predictions(problem, diagnosis, rivals, run)) for run in problem.next_runs] if rivals else []
    planned = [(run, predictions) for run, predictions in planned if predictions]
    if not planned:
        return NOTHING
    probability = np.array([rival.share for rival in rivals])
    choice = choose(probability / probability.sum(), [predictions for _, predictions in planned])
    return {"next_condition": [planned[choice.index][0].name],
            "next_separates": [rivals[k].name for k in choice.separates],
            "next_value": float(choice.value[choice.index])}


@dataclass(frozen=True)
class Rival:
    """A hypothesis that the next run should tell from others: its ``share`` of probability and its Fit."""

    name: str
    share: float
    fit: object


def rivals_of(diagnosis):
    """Rivals in a tie, none elsewhere. One that is named alone has the nominal model and the runner-up beside it."""
    if diagnosis.decision.verdict != "tie" or not diagnosis.named:
        return []
    names = {w.candidate.name for w in diagnosis.named}
    every = [Rival(w.candidate.name, w.statistics.posterior, w.fit) for w in diagnosis.weighed]
    named, others = [r for r in every if r.name in names], [r for r in every if r.name not in names]
    known = diagnosis.nominal
    nothing = Rival(known.name if known.effects else "nothing missing", diagnosis.posterior[0], diagnosis.null)
    return named if len(named) > 1 else [*named, nothing, *others[:1]]


def _predictions(problem, diagnosis, rivals, run):
    """Predictions of one run by every rival, or none."""
    try:
        return [_prediction(problem, diagnosis, rival.fit, run) for rival in rivals]
    except BrakechainError:
        return []


def _prediction(problem, diagnosis, fit, run):
    noise, weight = problem.budget[run.name], np.sqrt(np.mean(diagnosis.weights))
    there = linearised(problem.problem, [noise], fit.hypothesis, fit.latent, [run])
    return predicted(-weight * there.residuals[0], weight * there.jacobians[0], fit.covariance(diagnosis.weights))


def changed(bench, run, name, value, where):
    """(Run, altered) with one thing changed: a value with a unit or a factor. ConfigError where it cannot be."""
    factor = not isinstance(value, str)
    numbers = corrections.known(bench)
    if name in numbers:
        return run, {name: (value if factor else to_si(value, numbers[name], where), factor)}
    conditions = _conditions(bench, run)
    if name not in conditions or (name == DRIVE and not factor):
        known = f"one of {', '.join(conditions)} or a number of the bench ({DRIVE}: a factor)"
        raise ConfigError(where, known, repr(value))
    if name == DRIVE:
        return replace(run, drive=value * np.asarray(run_drive(bench, run), float)), {}
    unit = "rad/s" if name == "speed" else input_unit(bench, name)
    there = value * np.asarray(conditions[name], float) if factor else to_si(value, unit, where)
    if name in bench.model.input_name:
        others = {n: pulse for n, pulse in run.pulses.items() if n != name}
        return replace(run, inputs={**run.inputs, name: there}, pulses=others), {}
    drive = None if name == "speed" else run.drive
    return replace(run, drive=drive, conditions={**run.conditions, name: float(there)}), {}


def _conditions(bench, run):
    """{name: value or samples} of what can be done differently."""
    inputs = dict(zip(bench.model.input_name, stated_inputs(bench, run), strict=True))
    conditions = {DRIVE: run_drive(bench, run), **inputs}
    if np.ndim(conditions[DRIVE]) == 0:
        conditions["speed"] = conditions[DRIVE]
    contacts = bench.model.contacts
    if len(contacts.fixed) and contacts.fixed.all():
        conditions[NORMAL_LOAD] = run.conditions.get(NORMAL_LOAD, contacts.preload.sum())
    return conditions

"""The latent force as a function of what it was found to follow: a description that predicts, not identified physics.

    f = f_0 + sum_k c_k x^k + d_1 v + d_2 |v| v + d_0 sgn(v) + sum_n (a_n cos n angle + b_n sin n angle)

of the quantities alone whose dependence is significant; d_2 and d_0 only where they resist the motion. Coefficients are
regressed on the force of the runs that were fitted; as elements along the place it joins the nominal model, and is
fitted once more with its values to what these runs recorded.
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from pipeline.contract import BrakechainError
from pipeline.diagnosis.problem import parameter_name
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.diagnosis.signals.forward_model import completed
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Problem
from pipeline.physics.time_stepping.elements import Dry, Element, Polynomial, Power, Wave

#: harmonics of the drive's angle
_ORDERS = (1, 2, 3)
#: what the force is called wherever it predicts
LABEL = "description, not identified physics"
_FORCE = "latent_force"
_CONSTANT, _RESISTING = "constant", ("sign of v", "|v| v")
#: {quantity: {term: its unit}} of those that do not turn with the drive
_TERMS = {"displacement": {"x": "N/m", "x^2": "N/m^2", "x^3": "N/m^3"},
          "velocity": {"v": "N s/m", "|v| v": "N s^2/m^2", "sign of v": "N"}}
_ANGLE = "angle of the drive"


@dataclass(frozen=True)
class LatentLaw:
    """``coefficient`` {term: value in SI} of the force in N; ``share`` of its variance that it explains;
    ``size`` {term: what would make a force as large as the whole}; ``reach`` m and m/s: the largest displacement and
    velocity that it was learned from."""

    coefficient: dict
    size: dict
    share: float
    reach: tuple

    def unit(self, term):
        """SI unit of the coefficient of a term."""
        return next((units[term] for units in _TERMS.values() if term in units), "N")

    def elements(self, bench, row):
        """Elements along a row (n,) of a Bench that put the force on its bodies."""
        given = self.coefficient
        laws = {_CONSTANT: Wave(1.0, amplitude=given[_CONSTANT])}
        if "x" in given:
            laws["displacement"] = Polynomial(-given["x"], -given["x^2"], -given["x^3"])
        if "v" in given:
            laws["linear"] = Power(-given["v"], 1.0)
        if "|v| v" in given:
            laws["quadratic"] = Power(-given["|v| v"], 2.0)
        if dry := -given.get("sign of v", 0.0):
            laws["dry"] = Dry(forward=dry, backward=dry)
        for n in _ORDERS if f"cos {_ORDERS[0]} angle" in given else ():
            wave = given[f"cos {n} angle"] + 1j * given[f"sin {n} angle"]
            laws[f"order {n}"] = Wave(1.0, amplitude=abs(wave), order=n, phase=float(np.angle(wave)))
        return tuple(Element(f"latent force, {name}", row, law) for name, law in laws.items())


@dataclass(frozen=True)
class LatentUse:
    """Predictions ``runs`` {held-out run: (c, n)} of the recalibrated nominal model with the force, its LatentLaw or
    None, and a ``sentence`` that says what was done, or why not."""

    runs: dict
    law: LatentLaw | None
    sentence: str


def regressed(runs, follows, largest_p=DEFAULTS.latent_force.dependence_p):
    """LatentLaw over LatentRuns ``runs`` that ``follows`` ((Dependence, unit), ...), or None where nothing is clear."""
    clear = {dependence.name for dependence, _ in follows if dependence.p_value <= largest_p}
    x, v, force = (np.concatenate([getattr(run, key) for run in runs]) for key in ("displacement", "velocity", "force"))
    columns = {_CONSTANT: np.ones(len(x))}
    if "displacement" in clear:
        columns |= {"x": x, "x^2": x**2, "x^3": x**3}
    if "velocity" in clear:
        columns |= {"v": v, "|v| v": abs(v) * v, "sign of v": np.sign(v)}
    if _ANGLE in clear:
        angle = np.concatenate([run.angle for run in runs])
        columns |= {f"{name} {n} angle": wave(n * angle) for n in _ORDERS
                    for name, wave in (("cos", np.cos), ("sin", np.sin))}
    if len(columns) == 1:
        return None
    coefficient = _fitted(columns, force)
    left = force - sum(c * columns[term] for term, c in coefficient.items())
    whole = float(np.sqrt(np.mean(force**2)))
    size = {term: whole / float(np.sqrt(np.mean(columns[term] ** 2))) for term in coefficient}
    return LatentLaw(coefficient, size, float(1 - np.var(left) / np.var(force)),
                     (float(abs(x).max()), float(abs(v).max())))


class Simulator(Protocol):
    """(c, n): what the channels of a run (Observed) show on a Bench."""

    def simulated(self, bench, run) -> np.ndarray: ...


@dataclass(frozen=True)
class WithForce:
    """Picklable prediction of a Bench with a LatentLaw at ``location`` along ``row`` (n,)."""

    bench: object
    row: np.ndarray
    location: str
    law: LatentLaw
    simulator: Simulator

    def __call__(self, hypothesis, values, run):
        bench, law = completed(self.bench, hypothesis, values), self.law_of(values)
        return self.simulator.simulated(bench.with_elements(*law.elements(bench, self.row)), run)

    def name(self, term):
        """Name of the parameter of a term."""
        return parameter_name(_FORCE, self.location, term)

    def law_of(self, values):
        """The LatentLaw with the ``values`` {name: value}; terms that resist are never turned round."""
        given = {term: values[self.name(term)] for term in self.law.coefficient}
        return replace(self.law, coefficient={t: min(c, 0.0) if t in _RESISTING else c for t, c in given.items()})


def used(bench, row, description, problem, budget, null, simulator, rules=DEFAULTS):
    """LatentUse of a Description on the held-out runs of a Problem under {run: Noise} ``budget``.

    ``bench`` is the nominal one, ``null`` the Fit that recalibrates it, ``row`` (n,) that of the place,
    ``simulator`` a Simulator.
    """
    learned = [description.runs[run.name] for run in problem.training if run.name in description.runs]
    law = regressed(learned, description.follows, rules.latent_force.dependence_p)
    if law is None:
        return LatentUse({}, None, "The latent force follows nothing that a law can use: it predicts nothing.")
    whole = WithForce(bench, row, description.location, law, simulator)
    terms = tuple(Parameter(whole.name(t), law.unit(t), c, Normal(c, law.size[t])) for t, c in law.coefficient.items())
    hypothesis = replace(null.hypothesis, name=_FORCE, parameters=null.hypothesis.parameters + terms)
    asked = Problem(problem.runs, whole, hypothesis)
    try:
        refitted = fit(asked, [budget[run.name] for run in problem.training], hypothesis,
                    np.concatenate((null.latent, np.zeros(len(terms)))), problem.training)
        runs = {run.name: whole(hypothesis, refitted.values, run) for run in problem.held_out}
    except BrakechainError as error:
        return LatentUse({}, law, f"With the latent force the runs could not be predicted: {error}")
    beyond = [run.name for run in problem.held_out if _beyond(description.runs.get(run.name), law.reach)]
    said = [f"A function of {', '.join(t for t in law.coefficient if t != _CONSTANT)}, fitted to the training runs,"
            f" stands for the latent force at {description.location}, of which it explains {100 * law.share:.0f} %:"
            f" {LABEL}."]
    if not refitted.ended(refitted.explains(null), rules.evidence.nothing_more):
        said.append("Its fit had not converged.")
    said += [f"Beyond what it was learned from: {', '.join(beyond)}."] if beyond else []
    return LatentUse(runs, whole.law_of(refitted.values), " ".join(said))


def _fitted(columns, force):
    """{term: coefficient}; terms that must resist are left out where they would not."""
    while True:
        table = np.column_stack(list(columns.values()))
        size = np.maximum(abs(table).max(axis=0), 1e-300)
        coefficient = dict(zip(columns, np.linalg.lstsq(table / size, force, rcond=None)[0] / size, strict=True))
        wrong = max((t for t in _RESISTING if coefficient.get(t, 0.0) > 0), key=coefficient.get, default=None)
        if wrong is None:
            return {term: float(value) for term, value in coefficient.items()}
        columns = {term: column for term, column in columns.items() if term != wrong}


def _beyond(run, reach):
    return run is not None and (abs(run.displacement).max() > reach[0] or abs(run.velocity).max() > reach[1])

"""Lines and modes as features: what a model shows at each of them, and what alternatives to it would show.

Published numbers are few, and every alternative is one other list of numbers. A hypothesis moves the prediction from
the nominal one by a share of the way to its alternative:

    predicted = factor * nominal + sum_a share_a (alternative_a - nominal),

share 0 is the nominal model, share 1 the alternative whole.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract import ConfigError
from pipeline.diagnosis.problem import DiagnosisProblem, label, nominal, parameter_name
from pipeline.diagnosis.rules import DEFAULTS, ListRules
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.fit_state import whitened
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.search.localisation import Location, holm

#: the parameter of every alternative, and the one nominal value that lists of frequencies may have
SHARE, FACTOR = "share", "frequency_factor"


@dataclass(frozen=True)
class Features:
    """One recorded list: ``channel``, its ``unit``, ``samples`` (n,) and their standard deviation ``std`` (n,)."""

    channel: str
    unit: str
    samples: np.ndarray
    std: np.ndarray


@dataclass(frozen=True)
class Alternative:
    """What lists would show if ``effect`` acted at ``location``: ``shown`` {run: (n,)}; runs left out are as nominal.

    ``scale``: prior of its share; above 1 for alternatives that could lie anywhere.
    """

    effect: str
    location: str
    shown: dict
    kind: str = "physics"
    scale: float = 1.0

    @property
    def hypothesis(self):
        """Its Hypothesis: one parameter, the fraction of it that acts."""
        pair = (self.effect, self.location)
        share = Parameter(parameter_name(*pair, SHARE), "1", 0.0, HalfNormal(self.scale), 0.0)
        return Hypothesis(label((pair,)), (pair,), (share,), self.kind)


@dataclass(frozen=True)
class Blended:
    """Picklable prediction: ``shown`` {run: (n,)} of the nominal model, ``alternatives`` {(effect, place): it}."""

    shown: dict
    alternatives: dict

    def __call__(self, hypothesis, values, run):
        given = np.asarray(self.shown[run.name], float)
        moved = values.get(FACTOR, 1.0) * given
        for pair in hypothesis.effects:
            other = np.asarray(self.alternatives[pair].shown.get(run.name, given), float)
            moved = moved + values[parameter_name(*pair, SHARE)] * (other - given)
        return moved[None]


def list_problem(features, shown, alternatives, parameters=(), rules=DEFAULTS):
    """DiagnosisProblem over {run: Features} and the nominal ``shown`` {run: (n,)}; ``parameters``: FACTOR or none.

    Lists cannot always separate second alternatives: other than for recorded runs, a tie of them completes a first one.
    """
    lists = tuple(Observed(name, {}, (f.channel,), np.asarray(f.samples, float)[None],
                          noise_std=np.asarray(f.std, float)[None]) for name, f in features.items())
    known = {(a.effect, a.location): a for a in alternatives}
    problem = Problem(lists, Blended(shown, known), nominal(parameters))
    return DiagnosisProblem(problem, budget(problem), tuple(a.hypothesis for a in alternatives),
                            {f.channel: f.unit for f in features.values()},
                            Settings(kept=len(alternatives), rules=rules, tied_seconds=True),
                            DifferingLists(problem, rules.lists))


@dataclass(frozen=True)
class DifferingLists:
    """Locator of lists: the axis ``run``, those that differ from the nominal model, by their chi^2 (Holm over all)."""

    problem: Problem
    rules: ListRules = DEFAULTS.lists

    def located(self, diagnosis):
        """Against the given, the recalibrated or the named values of the nominal parameters.

        That is, whichever leaves the smallest sum of squares with their prior, each square counted up to that of
        ``outlying`` deviations: lists that differ pull a fit aside.
        """
        best, limit = diagnosis.named[0].fit if diagnosis.named else diagnosis.null, self.rules.outlying**2
        nominal_values = slice(len(self.problem.nominal.parameters))
        tried = []
        for latent in (self.problem.nominal.nominal, diagnosis.null.latent, best.latent):
            values = latent[nominal_values]
            residuals, _ = whitened(self.problem, best.noises, self.problem.nominal, values, best.runs)
            tried.append((values @ values + sum(np.minimum(r**2, limit).sum() for r in residuals), residuals))
        _, residuals = min(tried, key=lambda t: t[0])
        single = np.array([np.clip(scipy.stats.chi2.sf(r @ r, len(r)), 1e-300, 1 - 1e-12) for r in residuals])
        p_value, deviation = holm(single), scipy.stats.norm.isf(single)
        members = p_value <= self.rules.differs_p
        return {"run": (Location(tuple(r.name for r in best.runs), deviation, p_value, members),)}


def lines_of(recording, run, name, where="diagnosis.lines"):
    """Lines of the list ``name`` of ``run`` of a product Recording; ConfigError at ``where`` for one not there."""
    if run not in recording.runs:
        raise ConfigError(where, f"runs among {', '.join(recording.runs)}", run)
    lists = recording.runs[run].lines
    if name not in lists:
        raise ConfigError(where, f"lists of run {run}: {', '.join(lists) or 'none'}", name)
    return lists[name]

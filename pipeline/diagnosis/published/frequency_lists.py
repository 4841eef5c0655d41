"""Lines and modes as features: what a model shows at each of them, and what alternatives to it would show.

Published numbers are few, and every alternative is one other list of numbers. A hypothesis moves the prediction from
the nominal one by a share of the way to its alternative:

    predicted = factor * nominal + sum_a share_a (alternative_a - nominal),

share 0 is the nominal model, share 1 the alternative whole.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy

from pipeline.contract import ConfigError
from pipeline.diagnosis.question import Question, label, nominal, parameter_name
from pipeline.inference.fitting.least_squares import whitened
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.procedure import diagnose
from pipeline.inference.search.localisation import Location, holm

#: the parameter of every alternative, and the one nominal value that lists of frequencies may have
SHARE, FACTOR = "share", "frequency_factor"
#: largest p-value over all lines of one that differs from the model
_LEVEL = 0.05
#: deviations beyond which a list counts as one that differs
_OUTLYING = 3.0


@dataclass(frozen=True)
class Features:
    """One recorded list: ``channel``, its ``unit``, ``samples`` (n,) and their standard deviation ``std`` (n,)."""

    channel: str
    unit: str
    samples: np.ndarray
    std: np.ndarray


@dataclass(frozen=True)
class Alternative:
    """What lists would show if ``effect`` acted at ``place``: ``shown`` {run: (n,)}; runs left out are as nominal.

    ``scale``: prior of its share; above 1 for alternatives that could lie anywhere.
    """

    effect: str
    place: str
    shown: dict
    kind: str = "physics"
    scale: float = 1.0

    @property
    def hypothesis(self):
        """Its Hypothesis: one parameter, the share of it that acts."""
        pair = (self.effect, self.place)
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


def question(features, shown, alternatives, parameters=()):
    """Question over {run: Features} and the nominal ``shown`` {run: (n,)}; ``parameters``: FACTOR or none."""
    seen = tuple(Observed(name, {}, (f.channel,), np.asarray(f.samples, float)[None],
                          noise_std=np.asarray(f.std, float)[None]) for name, f in features.items())
    known = {(a.effect, a.place): a for a in alternatives}
    problem = Problem(seen, Blended(shown, known), nominal(parameters))
    return Question(problem, budget(problem), tuple(a.hypothesis for a in alternatives),
                    {f.channel: f.unit for f in features.values()}, axes=partial(differing, problem))


def diagnosed(asked, settings, fan_out=map):
    """Diagnosis of inference over a Question of lists; where one alternative is not enough, a second beside it.

    Lists cannot always tell the second ones apart: other than for recorded runs, a tie of them counts as found.
    """
    single = diagnose(asked.problem, asked.budget, asked.candidates, settings, fan_out)
    if single.decision.verdict != "unknown":
        return single
    rules = asked.rules
    for first in single.weighed:
        seen = first.contender
        if seen.p_value > rules.p_value or seen.evidence_gain < rules.evidence_gain:
            continue
        rest = tuple(c for c in asked.candidates if c.name != first.candidate.name)
        pair = diagnose(asked.problem.given(first.candidate), asked.budget, rest, settings, fan_out)
        if pair.decision.named:
            return replace(pair, base=single)
    return single


def differing(problem, diagnosis):
    """Axis ``run``: the lists that differ from the nominal model, by their chi^2 (Holm over all).

    Its parameters are the given, the recalibrated or those of the named hypothesis, whichever leaves the smallest sum
    of squares with their prior, each square counted up to that of three deviations: lists that differ pull a fit aside.
    """
    best = diagnosis.named[0].fit if diagnosis.named else diagnosis.null
    own = len(problem.nominal.parameters)
    tried = [(latent[:own], whitened(problem, best.noises, problem.nominal, latent[:own], best.runs)[0])
             for latent in (problem.nominal.nominal, diagnosis.null.latent, best.latent)]
    _, residuals = min(tried, key=lambda t: t[0] @ t[0] + sum(np.minimum(r**2, _OUTLYING**2).sum() for r in t[1]))
    single = np.array([np.clip(scipy.stats.chi2.sf(r @ r, len(r)), 1e-300, 1 - 1e-12) for r in residuals])
    p_value = holm(single)
    deviation = scipy.stats.norm.isf(single)
    return {"run": (Location(tuple(r.name for r in best.runs), deviation, p_value, p_value <= _LEVEL),)}


def lines_of(recording, run, name):
    """Lines of the list ``name`` of ``run`` of a product Recording; ConfigError for one that is not there."""
    where = "diagnosis.lines"
    if run not in recording.runs:
        raise ConfigError(where, f"runs among {', '.join(recording.runs)}", run)
    lists = recording.runs[run].lines
    if name not in lists:
        raise ConfigError(where, f"lists of run {run}: {', '.join(lists) or 'none'}", name)
    return lists[name]

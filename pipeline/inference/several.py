"""Several laws at once: the set that the equation of motion asks for, none of which has to pass alone.

Where all motions are measured, a prediction along them is linear in every coefficient (``Motions``); elsewhere it is
the screen's linearisation about the recalibrated nominal model. There the best subsets of candidates are compared
exhaustively (``subset_selection``). Every law that is taken for true is wrong by some percent: along measured motions
the error of each member's law is one more uncertain direction, so that no further law is named that only mends it.
"""

from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference import regular
from pipeline.inference.fitting.fit_state import Fit, from_prior_mean
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.problem import Motions, Problem
from pipeline.inference.rules import DecisionRules
from pipeline.inference.search.score_screen import directions_with_tones, scaled
from pipeline.inference.search.selection import Combination, Selection
from pipeline.inference.search.subset_selection import best_subsets, left_by, multiplicity, table


@dataclass(frozen=True)
class _Columns:
    """Moments (run, k, k), (run, k) of all columns of a Table's best set: nominal ones, members, errors of laws.

    ``owner`` (k,): -1 of nominal columns, else the candidate that a column belongs to.
    """

    information: np.ndarray
    projection: np.ndarray
    owner: np.ndarray

    def log_evidence(self, members, left_out=None):
        """ln Z of the ``members`` (candidate, ...), up to a constant; without the run ``left_out``, where given."""
        hessian, projection = self._posed(members, left_out)
        return float(0.5 * projection @ regular.solved(hessian, projection) - 0.5 * regular.log_determinant(hessian))

    def nominal(self, members):
        """Latent values (k,) of the nominal parameters beside the ``members``."""
        solved = regular.solved(*self._posed(members))
        return np.clip(solved[:np.count_nonzero(self.owner == -1)], -3, 3)

    def _posed(self, members, left_out=None):
        kept = np.flatnonzero(np.isin(self.owner, (-1, *members)))
        runs = [r for r in range(len(self.projection)) if r != left_out]
        return (np.eye(len(kept)) + self.information[runs].sum(axis=0)[np.ix_(kept, kept)],
                self.projection[runs].sum(axis=0)[kept])

    def predictive(self, members):
        """(run,) log predictive density of each run from the others, up to a constant of the run."""
        whole = self.log_evidence(members)
        return np.array([whole - self.log_evidence(members, run) for run in range(len(self.projection))])


def along_motions(null, catalogue, motions: Motions, rules, fan_out):
    """Along of the Motions that the Fit ``null`` of the nominal hypothesis completes; None where they fail."""
    try:
        along = motions.along(null)
        null = fit(along, null.noises, along.nominal, null.latent, along.runs)
    except BrakechainError:
        return None
    every = tuple(fan_out(partial(directions_with_tones, along, null), catalogue))
    return Along(null, _of_physics(every, catalogue), catalogue, rules, along)


@dataclass(frozen=True)
class Along:
    """Problem ``along`` measured motions with the Fit ``null`` of its nominal hypothesis and the Directions ``every``
    of a ``catalogue``."""

    null: Fit
    every: tuple
    catalogue: tuple
    rules: DecisionRules
    along: Problem

    def selected(self, without=frozenset()):
        """Selection among all candidates but those ``without`` (indices)."""
        every = tuple(_unseen(d) if i in without else d for i, d in enumerate(self.every))
        return _selected(self.null, every, self.catalogue, self.rules, self.along)


def linearised_about(null, every, catalogue, rules):
    """Selection by the Directions ``every`` of a ``catalogue`` at the Fit ``null`` itself; it judges nobody."""
    return replace(_selected(null, _of_physics(every, catalogue), catalogue, rules), judged=frozenset())


def _of_physics(every, catalogue):
    """The Directions, none of a candidate that changes what sensors show: several together shrink all data, which takes
    away what is left without explaining anything."""
    return tuple(d if c.kind == "physics" else _unseen(d) for d, c in zip(every, catalogue, strict=True))


def _unseen(directions):
    return replace(directions, vectors=directions.vectors[:0], sign=directions.sign[:0], tried=())


def _selected(null, every, catalogue, rules, along=None):
    of = table(null, every)
    subsets, judged = best_subsets(of), frozenset(int(i) for i in of.owner)
    if not subsets:
        return Selection((), (), (), null.latent, {}, judged, np.inf)
    best = subsets[0]
    values = {owner: scaled(catalogue[owner].parameters, of.tried[direction], coefficient)
              for owner, coefficient, direction in zip(best.owners, best.coefficients, best.directions, strict=True)}
    residual, directions_of_best = np.concatenate(from_prior_mean(null)), _directions(null, every, of, best)
    columns = _columns(null, of, best, residual, directions_of_best,
                       _law_errors(along, null, catalogue, values, rules.law_error))
    gains = _gains(columns, best.owners, of.count)
    members, wider = (_necessary(columns, gains, rules.evidence_gain, share) for share in (rules.second_share, 0.0))
    tried = [Combination(_names(catalogue, owners), gain) for owners, gain in gains.items() if owners]
    tried += [Combination(_names(catalogue, s.owners), s.gain) for s in subsets if s.owners not in gains]
    return Selection(members, wider, tuple(sorted(tried, key=lambda c: -c.gain)), columns.nominal(wider), values,
                     judged, float((left_by(directions_of_best, residual) ** 2).mean()))


def _names(catalogue, owners):
    return tuple(catalogue[i].name for i in owners)


def _law_errors(along, null, catalogue, values, size):
    """{index: whitened (e, m) errors} of the laws of candidates at latent ``values`` {index: (k,)}, each of this
    relative ``size``; none without a Problem ``along`` motions."""
    errors = {}
    for index, latent in values.items() if along else ():
        hypothesis = null.hypothesis.joined(catalogue[index])
        given, effect = hypothesis.values(np.concatenate((null.latent, latent))), catalogue[index].effects
        errors[index] = size * np.concatenate([
            noise.whiten(np.array(along.predict.law_errors(hypothesis, given, run, effect)))
            for run, noise in zip(null.runs, null.noises, strict=True)], axis=1)
    return errors


def _directions(null, every, of, best):
    """(m, k) columns of the nominal parameters and of the best Subset."""
    vectors = np.concatenate([d.vectors for d in every])[of.index[list(best.directions)]]
    return np.concatenate([np.concatenate(null.jacobians), vectors.T], axis=1)


def _columns(null, of, best, residual, directions_of_best, errors):
    """_Columns of the best Subset, its _directions beside the ``errors`` {index: (e, m)} of its laws."""
    columns = np.concatenate([directions_of_best, *(e.T for e in errors.values())], axis=1)
    owner = [-1] * len(null.latent) + list(best.owners) + [i for i, e in errors.items() for _ in e]
    ends = np.cumsum(null.counts)[:-1]
    parts = list(zip(of.weights, np.split(columns, ends), np.split(residual, ends), strict=True))
    return _Columns(np.array([w * c.T @ c for w, c, _ in parts]), np.array([w * c.T @ r for w, c, r in parts]),
                    np.array(owner))


def _gains(columns, owners, count):
    """{members: ln Z over the nominal model, multiplicity paid for} of all sets of ``owners``, the empty one too."""
    nothing = columns.log_evidence(())
    return {members: columns.log_evidence(members) - nothing - multiplicity(count, len(members))
            for size in range(len(owners) + 1) for members in combinations(owners, size)}


def _necessary(columns, gains, evidence_gain, share):
    """Members of the best set each of which is needed, the least needed last.

    By evidence, of which it gives this ``share``, and for runs left out.
    """
    for members in sorted(gains, key=lambda m: -gains[m]):
        lost = {m: gains[members] - gains[tuple(i for i in members if i != m)] for m in members}
        predicted = columns.predictive(members)
        needed = all(loss >= max(evidence_gain, share * gains[members])
                     and (predicted - columns.predictive([i for i in members if i != m])).sum() > 0
                     for m, loss in lost.items())
        if needed:
            return tuple(sorted(members, key=lambda m: -lost[m]))
    return ()

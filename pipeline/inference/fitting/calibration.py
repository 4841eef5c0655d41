"""Calibration: the best of several least-squares fits, approached by easier problems where the starts are far off."""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import BrakechainError, ConvergenceError
from pipeline.inference.fitting.fit_state import FAR, Fit, linearised, refreshed, whitened
from pipeline.inference.fitting.least_squares import again, continued, iterated
from pipeline.inference.fitting.run_parameters import with_own_parameters
from pipeline.inference.problem import Problem
from pipeline.inference.rules import DEFAULTS

#: iterations from every start before only the best goes on
_TRIAL = 3
#: how many starts near enough are tried, those that leave least
_NEAREST = 3
#: share of a mean square by which predictions of two starts differ that count as one, and the ends of two fits
_ALIKE = 0.05
#: iterations of an easier problem on the way
_EASIER = 8
#: fractions of the runs that are fitted first where the residual is beyond FAR noise powers: over a short horizon the
#: phase of a nonlinear motion cannot slip, so that the optimum is reached from far away
_HORIZONS, _FEWEST = (0.08, 0.3), 32
#: the same, where the fit ends far off all the same: how much a short part of a run tells is a matter of its course
_OTHER_HORIZONS = ((0.025, 0.05, 0.1, 0.2, 0.4, 0.7), (0.15, 0.5))
#: latent values at which thresholds are tried beside fits to short parts of the runs
_THRESHOLDS = np.linspace(-2.0, 2.0, 33)
#: standard deviations, as multiples of the true ones, with which features are fitted first where they are that far off:
#: then priors hold what few features tell, and each is paired with what it belongs to before it counts in full. Under
#: the first, features known to a few parts in ten thousand weigh no more than values known to a few per cent
_LOOSE = (300.0, 30.0, 6.0)
#: the same, where the first ones end at so many noise powers: whether roots pass each other is a matter of chance
_LOOSER, _OFF = (1000.0, 100.0, 10.0, 3.0), 4.0
#: times that a fit of features begins again where the prior of a value all but excludes it
_AGAIN = 2


@dataclass(frozen=True)
class Calibration:
    """First step: the Fit ``null`` of the nominal hypothesis of a Problem under its {run: Noise} ``budget``."""

    problem: Problem
    budget: dict
    null: Fit

    def improved(self, fits, rules):
        """This Calibration with the best of further ``fits`` (Fit or None) of the null, where that is better."""
        best = min([self.null, *(fit for fit in fits if fit is not None)], key=lambda fit: fit.objective)
        return replace(self, null=best) if best.objective < self.null.objective - rules.better_null else self

    def gone_on(self, restarts):
        """This Calibration, its null gone on with until it has converged, so many times at most: first as it is, whose
        iterations may have been too few, then with differences over wide steps."""
        null = self.null
        for k in range(restarts):
            if null.converged:
                break
            null = continued(self.problem, again(self.problem, null) if k else null)
        return replace(self, null=null)


def recalibrate(problem, budget, rules, start=None):
    """Calibration from the nominal values, or from the Fit ``start`` of the same hypothesis.

    It may not have converged, but it is never worse than the given values are, each run begun as suits these best;
    ConvergenceError where there is no fit at all.
    """
    if start and start.converged:
        return Calibration(problem, budget, start)
    runs, hypothesis = problem.training, problem.nominal
    noises = tuple(budget[run.name] for run in runs)
    latent = start.latent if start else hypothesis.nominal
    fit = calibrate(problem, noises, hypothesis, [latent], runs, False, rules)
    return Calibration(problem, budget, fit if start else _not_worse_than_given(problem, fit))


def _not_worse_than_given(problem, fit):
    """The Fit, or a lower one from the given values, where runs have parameters of their own, fitted to these first.

    A start state that makes up for a wrong frequency leads the values of the model to a wrong optimum. Where even the
    given values are far off, they are tried one prior standard deviation off to either side, one at a time.
    """
    hypothesis, given = fit.hypothesis, fit.hypothesis.nominal
    shared = np.flatnonzero(hypothesis.shared)
    if fit.unordered or hypothesis.shared.all():
        return fit
    best = fit
    for k, side in [(0, 0.0), *((k, side) for k in shared for side in (-1.0, 1.0))]:
        if side and not best.far:
            break
        with suppress(BrakechainError):
            latent = np.where(np.arange(len(given)) == k, given + side, given)
            latent = with_own_parameters(problem, fit.noises, hypothesis, latent, fit.runs)
            residuals, _ = whitened(problem, fit.noises, hypothesis, latent, fit.runs)
            if residuals is not None and sum(r @ r for r in residuals) + latent @ latent < best.objective:
                begin = linearised(problem, fit.noises, hypothesis, latent, fit.runs)
                best = min(best, continued(problem, begin, patient=False), key=lambda f: f.objective)
    return best


def calibrate(problem, noises, hypothesis, starts, runs, settled=True, rules=DEFAULTS.calibration):
    """The best of several fits. Raises ConvergenceError where none converged, saying what stopped them.

    A few iterations are made from each start; then the best goes on, the next best only where it does not converge.
    Without ``settled`` the best is returned even if its iterations were not enough, and no other goes on.
    """
    reasons = []
    for begin in _begun(problem, noises, hypothesis, starts, runs, reasons):
        fit = begin if begin.converged else continued(problem, begin, patient=settled)
        if fit.converged or not settled:
            fit = _by_other_deviations(problem, paired_anew(problem, fit, rules), starts, rules)
            return _by_other_horizons(problem, fit, starts)
        reasons.append(f"not converged after {fit.evaluations} predictions")
    raise _stopped(hypothesis, reasons)


def _by_other_horizons(problem, fit, starts):
    """The Fit, or where it is far off a lower one that comes from ``starts`` over other horizons, until two agree."""
    for fractions in _OTHER_HORIZONS:
        if fit.unordered or not fit.far:
            break
        ends = _over_horizons(problem, fit.noises, fit.hypothesis, starts, fit.runs, [], fractions)
        near = [end.latent for end in ends[-1:]]
        other = _ended(problem, _tried(problem, fit.noises, fit.hypothesis, near, fit.runs, []))
        if other is None:
            continue
        alike = fit.converged and len(_distinct([np.concatenate(f.residuals) for f in (fit, other)])) == 1
        fit = min(fit, other, key=lambda f: f.objective)
        if alike:
            break
    return fit


def _by_other_deviations(problem, fit, starts, rules):
    """The Fit, or a lower one of features that comes from ``starts`` by other standard deviations."""
    if not fit.unordered or fit.chi_square.sum() < _OFF * fit.counts.sum():
        return fit
    other = _ended(problem, _tightened(problem, fit.noises, fit.hypothesis, starts, fit.runs, [], _LOOSER))
    return min(fit, paired_anew(problem, other, rules), key=lambda f: f.objective) if other else fit


def paired_anew(problem, fit, rules):
    """The Fit, or a lower one of features, begun with those values at their prior means that priors exclude.

    A feature paired with what it does not belong to drags the value that moves this there; as long as it is there, the
    two stay paired.
    """
    for _ in range(_AGAIN):
        pulled = abs(fit.latent) > rules.excluded
        if not (fit.unordered and pulled.any()):
            break
        start = np.where(pulled, 0.0, fit.latent)
        other = _ended(problem, _begun(problem, fit.noises, fit.hypothesis, [start], fit.runs, []))
        if other is None or other.objective >= fit.objective:
            break
        fit = other
    return fit


def _ended(problem, begins):
    """The first of fits that began, continued; None where there is none or the forward model fails on the way."""
    try:
        return continued(problem, begins[0], patient=False) if begins else None
    except BrakechainError:
        return None


def begun(problem, noises, hypothesis, starts, runs, anchors=(), ahead=(), enough=np.inf):
    """The best Fit after a few iterations from each of ``starts``, to be ``continued``.

    ``anchors``: for each start the Fit of the nominal hypothesis beside which it lies, whose Jacobians serve at first,
    or None; where that is not far off, no easier problem is needed. Where it is, ``ahead`` are its ``ahead_of``, beside
    which the easier problems begin. Near ones go no further where they cannot come down to an objective ``enough``.

    Raises ConvergenceError where the forward model cannot begin from any.
    """
    reasons = []
    begins = _begun(problem, noises, hypothesis, starts, runs, reasons, anchors, ahead, enough)
    if not begins:
        raise _stopped(hypothesis, reasons)
    return begins[0]


def _stopped(hypothesis, reasons):
    return ConvergenceError(f"calibration of {hypothesis.name}", "a fit that converges from one of its starts",
                            "; ".join(dict.fromkeys(reasons)), "check the nominal values and priors")


def ahead_of(problem, anchor):
    """(Fit, ...) of the hypothesis of the Fit ``anchor``, which is far off, over rising horizons; () where none can, or
    where these are no easier."""
    if not problem.stepped:
        return ()
    ends = _over_horizons(problem, anchor.noises, anchor.hypothesis, [anchor.latent], anchor.runs, [])
    return tuple(fit if fit.fresh else refreshed(problem, fit) for fit in ends)


def _begun(problem, noises, hypothesis, starts, runs, reasons, anchors=(), ahead=(), enough=np.inf):
    """[Fit] after a few iterations from each start, best first; ``reasons`` gets what stopped the others."""
    residuals = [_residuals(problem, noises, hypothesis, start, runs) for start in starts]
    sizes, nearest = [_mean_square(r) for r in residuals], _distinct(residuals)
    known = [anchor.jacobians if anchor else () for anchor in anchors or [None] * len(starts)]
    far = min(sizes) >= FAR and all(anchor is None or anchor.far for anchor in anchors)
    if not ahead and not (far and problem.stepped):
        near = [k for k in nearest if sizes[k] < max(FAR, 2 * min(sizes))][:_NEAREST]
        begins, slopes = [starts[k] for k in near], [known[k] for k in near]
        if far and anchors:
            others = _other_thresholds(problem, noises, hypothesis, runs, begins[:1], anchors[:1])
            begins, slopes = begins + others, slopes + slopes[:1] * len(others)
        fits = _tried(problem, noises, hypothesis, begins, runs, reasons, slopes, enough=enough)
        return [iterated(problem, fits[0], _TRIAL, enough), *fits[1:]] if fits and anchors else fits
    if not all(noise.ordered for noise in noises):
        return _tightened(problem, noises, hypothesis, starts, runs, reasons, _LOOSE)
    nearest = nearest[:_NEAREST - 1]
    ends = (_beside(problem, ahead, hypothesis, starts, reasons) if ahead else
            _over_horizons(problem, noises, hypothesis, starts, runs, reasons))
    near = [*(fit.latent for fit in ends[-1:]), *(starts[k] for k in nearest)]
    near += _other_thresholds(problem, noises, hypothesis, runs, near[:1], ahead)
    return _tried(problem, noises, hypothesis, near, runs, reasons, [known[nearest[0]]] * len(near))


def _tried(problem, noises, hypothesis, starts, runs, reasons, known=(), rough=False, enough=np.inf):
    fits = []
    for start, slopes in zip(starts, known or [()] * len(starts), strict=True):
        try:
            begin = linearised(problem, noises, hypothesis, start, runs, slopes)
            fits.append(iterated(problem, begin, _EASIER if rough else _TRIAL, enough, patient=not rough, rough=rough,
                                 frugal=len(slopes) > 0))
        except BrakechainError as error:
            reasons.append(str(error))
    return sorted(fits, key=lambda fit: fit.objective)


def _over_horizons(problem, noises, hypothesis, starts, runs, reasons, fractions=_HORIZONS):
    """[Fit] over rising horizons, the best start of each the begin of the next; [] where none can."""
    ends = []
    for fewer, shorter in _horizons(noises, runs, fractions):
        begins = [ends[-1].latent] if ends else starts
        fits = _tried(problem, fewer, hypothesis, begins, shorter, reasons, rough=True)
        if not fits:
            return []
        ends.append(fits[0])
    return ends


def _beside(problem, ahead, hypothesis, starts, reasons):
    """[Fit] of the last horizon, each begun beside the Fit of the nominal hypothesis ``ahead``; [] where none can."""
    ends = []
    for short in ahead:
        own = [start[len(short.latent):] for start in ends or starts]
        begins = [*ends, *(np.concatenate((short.latent, latent)) for latent in own)]
        begins += _other_thresholds(problem, short.noises, hypothesis, short.runs, [*ends, begins[-1]], ahead)
        known = [short.jacobians] * len(begins)
        if not ends:        # what misleads the nominal hypothesis may have led it far off in few samples as well
            begins, known = [*begins, *starts], known + [()] * len(starts)
        fits = _tried(problem, short.noises, hypothesis, begins, short.runs, reasons, known, rough=True)
        ends = [fits[0].latent] if fits else []
    return fits[:1]


def _other_thresholds(problem, noises, hypothesis, runs, begins, ahead):
    """Latent values (k,) of the best few of ``begins`` with thresholds moved over their priors, beside the nominal ones
    ``ahead``; [] without any.

    As long as no motion reaches a gap, nothing tells how wide it is; once one does, it tells that at once.
    """
    own = range(len(ahead[0].latent) if ahead else len(hypothesis.parameters), len(hypothesis.parameters))
    moved = [np.where(np.arange(len(begin)) == k, value, begin) for k in own if hypothesis.parameters[k].threshold
             for begin in begins for value in _THRESHOLDS]
    residuals = [_residuals(problem, noises, hypothesis, latent, runs) for latent in moved]
    return [moved[k] for k in _distinct(residuals)[:_NEAREST - 1]]


def _horizons(noises, runs, fractions):
    """[(noises, runs)] cut to each of the ``fractions`` of the runs."""
    for fraction in fractions:
        ends = [noise.horizon(fraction, _FEWEST) for noise in noises]
        yield (tuple(noise.until(n) for noise, n in zip(noises, ends, strict=True)),
               tuple(run.until(n) for run, n in zip(runs, ends, strict=True)))


def _tightened(problem, noises, hypothesis, starts, runs, reasons, factors):
    """[Fit] of features after a few iterations under standard deviations larger by falling ``factors``, from the start
    that does best under the largest; [] where none can."""
    fits, known = [], ()
    for start in starts:
        try:
            begin = linearised(problem, noises, hypothesis, start, runs, known)
            known = [j[:, :len(problem.nominal.parameters)] for j in begin.jacobians]
            fits.append(_roughly(problem, begin, noises, factors[0]))
        except BrakechainError as error:
            reasons.append(str(error))
    if not fits:
        return []
    fit = min(fits, key=lambda f: f.objective)
    for factor in factors[1:]:
        fit = _roughly(problem, fit, noises, factor)
    return _tried(problem, noises, hypothesis, [fit.latent], runs, reasons)


def _roughly(problem, fit, noises, factor):
    return iterated(problem, _under(fit, noises, factor), _EASIER, patient=False, rough=True)


def _under(fit, noises, factor):
    """A Fit of features under standard deviations ``factor`` times those of ``noises``."""
    looser = tuple(replace(noise, filter=noise.filter / factor) for noise in noises)
    scale = [float(new.filter[0, 0] / old.filter[0, 0]) for new, old in zip(looser, fit.noises, strict=True)]
    return replace(fit, noises=looser, residuals=tuple(k * r for k, r in zip(scale, fit.residuals, strict=True)),
                   jacobians=tuple(k * j for k, j in zip(scale, fit.jacobians, strict=True)), converged=False)


def _residuals(problem, noises, hypothesis, start, runs):
    """Whitened residuals (m,) of all runs, or None where the forward model cannot."""
    residuals = whitened(problem, noises, hypothesis, start, runs)[0]
    return None if residuals is None else np.concatenate(residuals)


def _mean_square(residuals):
    return np.inf if residuals is None else float(np.mean(residuals ** 2))


def _distinct(residuals):
    """Indices of starts, least mean square first, without those that predict what an earlier one does."""
    found = []
    for k in np.argsort([_mean_square(r) for r in residuals]):
        own = residuals[k]
        if not found or own is not None and all(
                _mean_square(own - residuals[i]) > _ALIKE * _mean_square(own) for i in found):
            found.append(int(k))
    return found

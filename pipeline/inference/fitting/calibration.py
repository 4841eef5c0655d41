"""Calibration: the best of several least-squares fits, approached by easier problems where the starts are far off."""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import BrakechainError, ConvergenceError
from pipeline.inference.decision.candidate_statistics import EXCLUDED
from pipeline.inference.fitting.least_squares import FAR, continued, iterated, linearised, of_features, whitened

#: iterations from every start before only the best goes on
_TRIAL = 3
#: iterations of an easier problem on the way
_EASIER = 8
#: shares of the runs that are fitted first where the residual is beyond FAR noise powers: over a short horizon the
#: phase of a nonlinear motion cannot slip, so that the optimum is reached from far away
_HORIZONS, _FEWEST = (0.08, 0.3), 32
#: standard deviations, as multiples of the true ones, with which features are fitted first where they are that far off:
#: then priors hold what few features tell, and each is paired with what it belongs to before it counts in full. Under
#: the first, features known to a few parts in ten thousand weigh no more than values known to a few per cent
_LOOSE = (300.0, 30.0, 6.0)
#: the same, where the first ones end at so many noise powers: whether roots pass each other is a matter of chance
_LOOSER, _OFF = (1000.0, 100.0, 10.0, 3.0), 4.0
#: times that a fit of features begins again where the prior of a value all but excludes it
_AGAIN = 2


def calibrate(problem, noises, hypothesis, starts, runs, settled=True):
    """The best of several fits. Raises ConvergenceError where none converged, telling what stopped them.

    A few iterations are made from each start; then the best goes on, the next best only where it does not converge.
    Without ``settled`` the best is returned even if its iterations were not enough, and no other goes on.
    """
    reasons = []
    for state in _begun(problem, noises, hypothesis, starts, runs, reasons):
        best = state if state.converged else continued(problem, state, patient=settled)
        if best.converged or not settled:
            return _on_another_way(problem, paired_anew(problem, best), starts)
        reasons.append(f"not converged after {best.evaluations} predictions")
    raise _stopped(hypothesis, reasons)


def _on_another_way(problem, fit, starts):
    """The Fit ``fit``, or a lower one of features that comes from ``starts`` by other standard deviations."""
    if not of_features(fit.noises) or fit.chi_square.sum() < _OFF * fit.counts.sum():
        return fit
    other = _ended(problem, _tightened(problem, fit.noises, fit.hypothesis, starts, fit.runs, [], _LOOSER))
    return min(fit, paired_anew(problem, other), key=lambda f: f.objective) if other else fit


def paired_anew(problem, fit):
    """The Fit ``fit``, or a lower one of features, begun with those values at their prior means that priors exclude.

    A feature paired with what it does not belong to drags the value that moves this there; as long as it is there, the
    two stay paired.
    """
    for _ in range(_AGAIN):
        pulled = abs(fit.latent) > EXCLUDED
        if not (of_features(fit.noises) and pulled.any()):
            break
        start = np.where(pulled, 0.0, fit.latent)
        other = _ended(problem, _begun(problem, fit.noises, fit.hypothesis, [start], fit.runs, []))
        if other is None or other.objective >= fit.objective:
            break
        fit = other
    return fit


def _ended(problem, states):
    """The first of fits that began, continued; None where there is none or the forward model fails on the way."""
    try:
        return continued(problem, states[0], patient=False) if states else None
    except BrakechainError:
        return None


def begun(problem, noises, hypothesis, starts, runs, known=()):
    """The best Fit after a few iterations from each of ``starts``, to be ``continued``; ``known`` as ``linearised``.

    Raises ConvergenceError where the forward model cannot begin from any.
    """
    reasons = []
    states = _begun(problem, noises, hypothesis, starts, runs, reasons, known)
    if not states:
        raise _stopped(hypothesis, reasons)
    return states[0]


def _stopped(hypothesis, reasons):
    return ConvergenceError(f"calibration of {hypothesis.name}", "a fit that converges from one of its starts",
                            "; ".join(dict.fromkeys(reasons)), "check the nominal values and priors")


def _begun(problem, noises, hypothesis, starts, runs, reasons, known=()):
    """[Fit] after a few iterations from each start, best first; ``reasons`` gets what stopped the others."""
    sizes = [_mean_square(problem, noises, hypothesis, start, runs) for start in starts]
    if min(sizes) < FAR:
        return _tried(problem, noises, hypothesis, starts, runs, reasons, known)
    if of_features(noises):
        return _tightened(problem, noises, hypothesis, starts, runs, reasons, _LOOSE)
    near = [*_over_horizons(problem, noises, hypothesis, starts, runs, reasons), starts[int(np.argmin(sizes))]]
    return _tried(problem, noises, hypothesis, near, runs, reasons, known)


def _tried(problem, noises, hypothesis, starts, runs, reasons, known=(), rough=False):
    fits = []
    for start in starts:
        try:
            state = linearised(problem, noises, hypothesis, start, runs, known)
            fits.append(iterated(problem, state, _EASIER if rough else _TRIAL, patient=not rough, rough=rough))
        except BrakechainError as error:
            reasons.append(str(error))
    return sorted(fits, key=lambda f: f.objective)


def _over_horizons(problem, noises, hypothesis, starts, runs, reasons):
    """[latent] where fits over rising horizons end, the best start of each the begin of the next; [] where none can."""
    ahead = starts
    for share in _HORIZONS:
        kept = [noise.horizon(share, _FEWEST) for noise in noises]
        fits = _tried(problem, [noise.until(n) for noise, n in zip(noises, kept, strict=True)], hypothesis, ahead,
                       [run.until(n) for run, n in zip(runs, kept, strict=True)], reasons, rough=True)
        ahead = [fits[0].latent] if fits else []
    return ahead


def _tightened(problem, noises, hypothesis, starts, runs, reasons, factors):
    """[Fit] of features after a few iterations under standard deviations larger by falling ``factors``, from the start
    that does best under the largest; [] where none can."""
    fits, known = [], ()
    for start in starts:
        try:
            state = linearised(problem, noises, hypothesis, start, runs, known)
            known = [j[:, :len(problem.nominal.parameters)] for j in state.jacobians]
            fits.append(_roughly(problem, state, noises, factors[0]))
        except BrakechainError as error:
            reasons.append(str(error))
    if not fits:
        return []
    state = min(fits, key=lambda f: f.objective)
    for factor in factors[1:]:
        state = _roughly(problem, state, noises, factor)
    return _tried(problem, noises, hypothesis, [state.latent], runs, reasons)


def _roughly(problem, state, noises, factor):
    return iterated(problem, _under(state, noises, factor), _EASIER, patient=False, rough=True)


def _under(state, noises, factor):
    """A Fit of features under standard deviations ``factor`` times those of ``noises``."""
    looser = tuple(replace(noise, filter=noise.filter / factor) for noise in noises)
    scale = [float(new.filter[0, 0] / old.filter[0, 0]) for new, old in zip(looser, state.noises, strict=True)]
    return replace(state, noises=looser, residuals=tuple(k * r for k, r in zip(scale, state.residuals, strict=True)),
                   jacobians=tuple(k * j for k, j in zip(scale, state.jacobians, strict=True)), converged=False)


def _mean_square(problem, noises, hypothesis, start, runs):
    """Mean square of whitened residuals, infinite where the forward model cannot."""
    residuals = whitened(problem, noises, hypothesis, start, runs)[0]
    return np.inf if residuals is None else float(np.mean(np.concatenate(residuals) ** 2))

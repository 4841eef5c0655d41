"""The numbers that the rules see: of each refitted candidate, and of the recalibrated nominal model."""

import numpy as np
import scipy

from pipeline.contract.errors import BrakechainError
from pipeline.inference.decision.decision_rules import Contender, Situation
from pipeline.inference.decision.held_out import gain, held_out_residuals
from pipeline.inference.fitting.effective_sample_size import coherent_energy, doubt, effective_share
from pipeline.inference.fitting.least_squares import (
    HOPE,
    NOTHING_MORE,
    ended,
    linearised,
    of_features,
    orthogonal,
    promised,
    whitened,
)
from pipeline.inference.fitting.parameter_drift import agreement
from pipeline.inference.priors import LATENT_LIMIT

#: standard deviations of a prior beyond which it all but excludes a value (1 in 2 million)
EXCLUDED = 5.0
#: squared error of a recalibration that did not converge over that of a candidate, beyond which its end cannot matter
_FAR_BELOW = 30.0
#: NOTHING_MORE of a fit that reaches the noise already
_AT_NOISE = 1e-2


def held_out_gains(problem, budget, null, fits, share):
    """{index: (Gain or None, whether it beats a decoy of equal size or None)}."""
    runs = problem.held_out
    if not runs:
        return dict.fromkeys(fits, (None, None))
    noises = tuple(budget[run.name] for run in runs)
    reference = held_out_residuals(problem, noises, null, runs)
    gains = {}
    for i, fit in fits.items():
        try:
            gains[i] = gain(noises, reference, held_out_residuals(problem, noises, fit, runs))
        except BrakechainError:
            gains[i] = gain(noises, reference, reference)
    return {i: (gains[i], _beats_decoy(i, null, fits, gains, share)) for i in fits}


def _beats_decoy(index, null, fits, gains, share):
    """Against the best candidate of as many parameters that is out of the question.

    That is: posterior below 5 %, and less than half of what this candidate explains; another name for nearly the same
    force is a rival, no decoy.
    """
    explained = {i: fit.explains(null) for i, fit in fits.items()}
    decoys = [i for i, fit in fits.items() if i != index and share[i] < 0.05
              and explained[i] < 0.5 * explained[index] and len(fit.latent) == len(fits[index].latent)]
    if not decoys:
        return None
    return bool(gains[index].value > gains[max(decoys, key=lambda i: share[i])].value)


def contender(null, null_evidence, candidate, fit, support, share, p_value, held_out, weights, rules):
    """Contender of a refitted candidate: its Fit, Evidence, posterior ``share`` and held-out (Gain, decoy)."""
    size, std, gained = len(null.latent), fit.spread(weights), held_out[0]
    moved = [abs(fit.values[p.name] - p.null) / max(std[p.name], 1e-300) for p in candidate.parameters
             if p.null is not None]
    differing = [agreement(fit, size + k, weights, _immaterial(fit, size + k, rules))[0]
                 for k, p in enumerate(candidate.parameters) if p.null is not None]
    left_out = support.left_out - null_evidence.left_out
    unfitted = gained and (gained.errors_with(left_out) if len(left_out) > 1 else gained.errors)
    return Contender(
        candidate.name, candidate.kind, float(share), support.log_evidence - null_evidence.log_evidence, float(p_value),
        float(left_out.sum()), unfitted, gained and gained.errors, gained and gained.share_at_most,
        gained and gained.left(rules.noise_uncertainty),
        gained and _growth(gained, fit, rules), held_out[1],
        max(differing, default=0.0), max(moved, default=0.0), unexplained(null, fit, rules),
        candidate.forbidden(fit.values) if candidate.forbidden else "",
        unfinished(fit, null) + excluded(fit, LATENT_LIMIT - 1e-6))


def _growth(gained, fit, rules):
    """Power of a Fit's error on held-out runs over that on the fitted ones; of features, whose errors are shared, 1."""
    power = fit.chi_square.sum() / fit.counts.sum()
    return 1.0 if of_features(fit.noises) else gained.growth(power, rules.noise_uncertainty)


def unfinished(fit, null):
    """Why the end of a Fit, or of that of the nominal model, says little of one beside the other, in words."""
    gained = fit.betters(null)
    share = _AT_NOISE if fit.chi_square.sum() <= fit.counts.sum() else NOTHING_MORE
    doubts = () if ended(fit, gained, share) else ("its fit did not converge",)
    near = null.chi_square.sum() < _FAR_BELOW * fit.chi_square.sum()
    if not null.converged and near and HOPE * promised(null) > gained:
        doubts += ("the recalibration of the nominal model did not converge, so that nothing lies far below it",)
    return doubts


def excluded(fit, beyond):
    """A sentence for each parameter of a Fit that lies ``beyond`` so many standard deviations of its prior."""
    return tuple(f"the prior of {p.name} excludes the data: they ask for {fit.values[p.name]:.4g} {p.unit} or beyond,"
                 f" {abs(u):.1f} of its standard deviations away; check its unit, or widen the prior"
                 for p, u in zip(fit.hypothesis.parameters, fit.latent, strict=True) if abs(u) > beyond)


def _immaterial(fit, index, rules):
    """The latent change of an effect parameter that changes its distance from null by the rules' tolerance."""
    parameter, latent = fit.hypothesis.parameters[index], fit.latent[index]
    slope = (parameter.prior.value(latent + 1e-4) - parameter.prior.value(latent - 1e-4)) / 2e-4
    change = rules.tolerance * abs(parameter.prior.value(latent) - parameter.null)
    return change / slope if slope * LATENT_LIMIT > change else LATENT_LIMIT


def unexplained(null, fit, rules):
    """Share of the null's excess error that a Fit leaves: by squared error or in frequencies noise does not explain."""
    level, counts = 1 + rules.noise_uncertainty, fit.counts.sum()
    excess = max(null.chi_square.sum() - counts, fit.explains(null), 1e-300)
    by_size = max(0.0, fit.chi_square.sum() - counts - doubt(counts, rules.noise_uncertainty)) / excess
    return float(max(by_size, _coherent(fit, level) / max(_coherent(null, level), excess)))


def reaches_noise(fit, rules):
    """Whether a Fit leaves no more than noise whose power is known as well as the rules say."""
    return fit.chi_square.sum() <= (1 + rules.noise_uncertainty) * fit.counts.sum()


def _coherent(fit, level):
    return sum(coherent_energy(n, r, level) for n, r in zip(fit.noises, fit.residuals, strict=True))


def situation(problem, budget, null, weights, drifting, rules):
    """Situation of the recalibrated nominal model ``null`` (Fit) with its Drift, under {run: Noise} ``budget``."""
    return Situation(
        len(problem.runs), len(drifting.points), _misfit(null.noises, null.residuals, null.chi_square.sum(), rules),
        _misfit_held_out(problem, budget, null, weights, rules), _coherent(null, 1 + rules.noise_uncertainty) > 0,
        _moved_p(problem, null, weights), drifting.p_value, excluded(null, EXCLUDED))


def _misfit(noises, residuals, square, rules):
    """Standard deviations that a ``square`` of residuals lies beyond noise, whose power is as uncertain as it is."""
    count = sum(len(r) for r in residuals)
    effective = sum(len(r) * effective_share(n, r) for n, r in zip(noises, residuals, strict=True))
    return float((square - (1 + rules.noise_uncertainty) * count) / (count * np.sqrt(2 / effective))) if count else 0.0


def _misfit_held_out(problem, budget, null, weights, rules):
    """The same on held-out runs; what the uncertainty of the values explains there does not count.

    With C their covariance, e'(I + J C J')^-1 e of the residual e with Jacobian J. Features are not asked: the error of
    a model is common to all those of a run.
    """
    runs = problem.held_out
    if not runs or of_features(null.noises):
        return 0.0
    seen = linearised(problem, tuple(budget[run.name] for run in runs), null.hypothesis, null.latent, runs)
    jacobian, residual = np.concatenate(seen.jacobians), np.concatenate(seen.residuals)
    left = orthogonal(residual, jacobian, np.linalg.inv(null.covariance(weights)))
    return _misfit(seen.noises, seen.residuals, residual @ left, rules)


def _moved_p(problem, null, weights):
    """p-value of the given values: their squared error over the refitted ones', chi^2 with one degree per parameter."""
    if not len(null.latent):
        return 1.0
    given, error = whitened(problem, null.noises, null.hypothesis, null.hypothesis.nominal, null.runs)
    if error:
        return 0.0
    square = np.array([r @ r for r in given])
    return float(scipy.stats.chi2.sf(weights @ (square - null.chi_square), len(null.latent)))

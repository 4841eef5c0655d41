"""The numbers that the rules see: of each refitted candidate, and of the recalibrated nominal model."""

import numpy as np
import scipy

from pipeline.contract.errors import BrakechainError
from pipeline.inference.decision.decision_rules import CandidateStatistics, RunStatistics
from pipeline.inference.decision.held_out import Gain, gain, held_out_residuals, judged
from pipeline.inference.fitting.effective_sample_size import coherent_energy, doubt, effective_share
from pipeline.inference.fitting.fit_state import linearised, nominal_p, orthogonal, whitened
from pipeline.inference.fitting.parameter_drift import agreement
from pipeline.inference.fitting.run_parameters import with_own_parameters
from pipeline.inference.fitting.varying_values import followed
from pipeline.inference.priors import LATENT_LIMIT, LogNormal
from pipeline.inference.search.score_screen import short_name

#: share of the range of a size of either sign that counts as its end
_EDGE = 0.01


def held_out_gains(problem, budget, null, fits, posterior, rules):
    """{index: (Gain or None, whether it beats a decoy of equal size or None)} of the Fits ``fits`` {index: Fit}."""
    runs = problem.held_out
    if not runs:
        return dict.fromkeys(fits, (None, None))
    noises, share = tuple(budget[run.name] for run in runs), rules.decision.start_share
    reference, gains = held_out_residuals(problem, noises, null, runs, share), {}
    rest = judged(problem, noises, runs, share)
    for i, fit in fits.items():
        try:
            gains[i] = gain(rest, reference, held_out_residuals(problem, noises, fit, runs, share))
        except BrakechainError:
            gains[i] = gain(rest, reference, reference)
    return {i: (gains[i], _beats_decoy(i, null, fits, gains, posterior, rules.evidence)) for i in fits}


def _beats_decoy(index, null, fits, gains, posterior, rules):
    """Against the best candidate of as many parameters that is out of the question.

    That is: its posterior is small, and it explains much less than this candidate; another name for nearly the same
    force is a rival, no decoy.
    """
    explained = {i: fit.explains(null) for i, fit in fits.items()}
    decoys = [i for i, fit in fits.items() if i != index and posterior[i] < rules.decoy_posterior
              and explained[i] < rules.decoy_explains * explained[index]
              and len(fit.latent) == len(fits[index].latent)]
    if not decoys:
        return None
    return bool(gains[index].value > gains[max(decoys, key=lambda i: posterior[i])].value)


def candidate_statistics(null, null_evidence, candidate, fit, evidence, posterior, p_value, held_out, weights, rules):
    """CandidateStatistics of a refitted candidate: its Fit, Evidence, posterior and held-out (Gain, decoy)."""
    size, gained = len(null.latent), held_out[0]
    added = [(size + k, p) for k, p in enumerate(candidate.parameters) if p.null is not None]
    moved = [*fit.from_none([p for _, p in added], weights), *_shaped(fit, null, candidate)]
    differing = [agreement(fit, k, weights, _immaterial(fit, k, rules.decision))[0] for k, _ in added]
    left_out, uncertainty = evidence.left_out - null_evidence.left_out, rules.decision.noise_uncertainty
    unfitted = gained and (gained.errors_with(left_out) if len(left_out) > 1 else gained.errors)
    powered = bool(gained) and (null.unordered or gained.powered(uncertainty))
    judged = gained if powered else _everywhere(gained, null, fit)
    varying, remarks = _varying(fit, [k for k, _ in added], weights, rules.decision)
    beside = _varying(fit, null.hypothesis.sizes, weights, rules.decision, True)
    return CandidateStatistics(
        candidate.name, candidate.kind, float(posterior), evidence.log_evidence - null_evidence.log_evidence,
        float(p_value), float(left_out.sum()), unfitted, gained and gained.errors, gained and gained.share_at_most,
        gained and gained.left(uncertainty), gained and _growth(gained, fit, uncertainty), held_out[1],
        max(differing, default=0.0), max(moved, default=0.0), unexplained(null, fit, rules),
        "; ".join(_beyond(fit, candidate)),
        (*unfinished(fit, null, rules.evidence), *_at_edges(fit, null, rules), *_one_factor(fit, null, rules.decision)),
        powered, float(max(judged.share, 0.0)), float(judged.left(uncertainty)),
        max(-gained.value, 0.0) / max(fit.explains(null), 1e-300) if gained else 0.0,
        varying + beside[0], gained and gained.error,
        candidate.kind == "physics" and bool(candidate.shaping) and not fit.unordered, nominal_p(fit, null.hypothesis),
        remarks + beside[1])


def _beyond(fit, candidate):
    """Sentences on values at which an effect, or one that is taken as known beside it, is not what its name says."""
    own = {parameter.name for parameter in candidate.parameters}
    beside = [parameter for parameter in fit.hypothesis.parameters if parameter.name not in own]
    for parameter in (*candidate.parameters, *beside):
        value, (low, high) = fit.values[parameter.name], parameter.within
        if not low <= value <= high:
            side, end = ("below", low) if value < low else ("above", high)
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            whose = f"its {short_name(parameter)}" if parameter.name in own else f"{parameter.name}, beside it,"
            yield f"{whose} of {value:.3g}{unit} is {side} {end:.3g}{unit}, where it is another law"


def _shaped(fit, null, candidate):
    """[Distance from none in standard deviations] of a candidate of one size and shapes that may trade with it, by what
    the size takes off the objective; [] of others, and of a law at the place of one that is taken as known, whose error
    it may take off."""
    if len(candidate.sizes) != 1 or not candidate.shaping or null.hypothesis.places & candidate.places:
        return []
    return [np.sqrt(fit.weights.max() * max(fit.betters(null), 0.0))]


def _varying(fit, indices, weights, rules, beside=False):
    """(What values of an effect follow along the runs so much that its law is of another form, what they follow less),
    both in words; ``beside``: of effects that the nominal hypothesis takes as known."""
    against, remarks = [], []
    for k in indices:
        whose = f"{fit.hypothesis.parameters[k].name}, beside it," if beside else "its value"
        for one in followed(fit, k, weights):
            told = (f"{whose} follows {one.what} along the runs, by {abs(one.change):.0%} ({one.deviate:.1f} standard"
                    " deviations)")
            if one.deviate <= rules.varies or abs(one.change) <= rules.varies_by:
                continue
            if abs(one.change) > rules.varies_too_much:
                against.append(f"{told}: a law of another form")
            else:
                remarks.append(f"{told}: its law holds in part")
    return tuple(against), tuple(remarks)


def _at_edges(fit, null, rules):
    """Sentences on values at the edge of their priors: nominal ones, and sizes that are all but none, at the end of
    what can be; others of an effect that priors all but exclude; sizes of either sign at an end of their range."""
    size, own = len(null.latent), range(len(null.latent), len(fit.latent))
    gone = [k for k in own if fit.hypothesis.parameters[k].sign * fit.latent[k] < 0]
    yield from fit.excluded(LATENT_LIMIT - 1e-6, (*range(size), *gone))
    yield from fit.excluded(rules.calibration.excluded, set(own).difference(gone))
    for parameter, latent in zip(fit.hypothesis.parameters[size:], fit.latent[size:], strict=True):
        low, high = parameter.prior.support
        value, within = parameter.prior.value(latent), (1 - _EDGE) * (high - low)
        if parameter.null is not None and low < parameter.null < high and max(value - low, high - value) > within:
            yield f"its {short_name(parameter)} of {value:.3g} is at the end of its range, {low:g} to {high:g}"


def _one_factor(fit, null, rules):
    """A sentence where a Fit moves all sizes of the nominal model by one factor, as the Fit ``null`` does not."""
    def moved(one):
        return np.array([np.log(one.values[p.name] / p.nominal) for p in null.hypothesis.parameters
                         if isinstance(p.prior, LogNormal) and p.null is None and not p.run])

    factors, before = moved(fit), moved(null)
    least = np.log(rules.one_factor)
    if len(factors) < 2 or abs(factors.mean()) < least or np.ptp(factors) > least / 4 or abs(before.mean()) > least / 2:
        return ()
    return (f"it moves all nominal values by one factor, {np.exp(factors.mean()):.2g}: what is left shrinks with them",)


def _everywhere(gained, null, fit):
    """Gain over all runs, those fitted included; ``gained``: that on held-out runs, or None without any."""
    return (gained or Gain(0.0, 0.0, 0.0, 0)).with_fitted(null, fit)


def _growth(gained, fit, uncertainty):
    """Power of a Fit's error on held-out runs over that on the fitted ones; of features, whose errors are shared, 1."""
    return 1.0 if fit.unordered else gained.growth(fit.chi_square.sum() / fit.counts.sum(), uncertainty)


def unfinished(fit, null, rules):
    """Why the end of a Fit, or of that of the nominal model, says little of one beside the other, in words."""
    gained, reasons = fit.betters(null), ()
    at_noise = fit.chi_square.sum() <= fit.counts.sum()
    if not fit.ended(gained, rules.nothing_more_at_noise if at_noise else rules.nothing_more):
        reasons += ("its fit did not converge",)
    near = null.chi_square.sum() < rules.far_below * fit.chi_square.sum()
    if not null.converged and near and rules.hope * null.promised > gained:
        reasons += ("the recalibration of the nominal model did not converge, so that nothing lies far below it",)
    return reasons


def _immaterial(fit, index, rules):
    """The latent change of an effect parameter that changes its distance from null by the rules' tolerance."""
    parameter, latent = fit.hypothesis.parameters[index], fit.latent[index]
    slope = parameter.prior.slope(latent)
    change = rules.tolerance * abs(parameter.prior.value(latent) - parameter.null)
    return change / slope if slope * LATENT_LIMIT > change else LATENT_LIMIT


def unexplained(null, fit, rules):
    """Fraction of the null's excess error that a Fit leaves: by squared error, beside that of its time step, or in
    frequencies that noise does not explain."""
    counts, uncertainty = fit.counts.sum(), rules.decision.noise_uncertainty
    excess = max(null.chi_square.sum() - counts, fit.explains(null), 1e-300)
    by_size = max(0.0, fit.chi_square.sum() - counts - doubt(counts, uncertainty) - fit.step_error) / excess
    return float(max(by_size, _coherent(fit, rules) / max(_coherent(null, rules), excess)))


def _coherent(fit, rules):
    level, chance = 1 + rules.decision.noise_uncertainty, rules.evidence.coherent_chance
    return sum(coherent_energy(n, r, level, chance) for n, r in zip(fit.noises, fit.residuals, strict=True))


def run_statistics(problem, budget, null, weights, drift, rules):
    """RunStatistics of the recalibrated nominal model ``null`` (Fit) with its Drift, under {run: Noise} ``budget``."""
    uncertainty, without = rules.decision.noise_uncertainty, _powerless(problem, budget, null, rules)
    return RunStatistics(
        len(problem.runs), len(drift.points),
        _misfit(null.noises, null.residuals, null.chi_square.sum(), uncertainty),
        _misfit_held_out(problem, budget, null, weights, uncertainty), _coherent(null, rules) > 0,
        _moved_p(problem, null, weights), drift.p_value, null.excluded(rules.calibration.excluded), without)


def _powerless(problem, budget, null, rules):
    """Names of held-out runs that the Fit ``null`` predicts to the noise, on which no effect has anything to gain."""
    runs = () if null.unordered else problem.held_out
    noises = tuple(budget[run.name] for run in runs)
    whites = held_out_residuals(problem, noises, null, runs, rules.decision.start_share)
    return tuple(run.name for run, white in zip(runs, whites, strict=True)
                 if white @ white - len(white) <= doubt(len(white), rules.decision.noise_uncertainty))


def _misfit(noises, residuals, square, uncertainty):
    """Standard deviations that a ``square`` of residuals lies beyond noise of a power of this uncertainty."""
    count = sum(len(r) for r in residuals)
    effective = sum(len(r) * effective_share(n, r) for n, r in zip(noises, residuals, strict=True))
    return float((square - (1 + uncertainty) * count) / (count * np.sqrt(2 / effective))) if count else 0.0


def _misfit_held_out(problem, budget, null, weights, uncertainty):
    """The same on held-out runs; what the uncertainty of the values explains there does not count.

    With C their covariance, e'(I + J C J')^-1 e of the residual e with Jacobian J; the runs' own parameters, of which
    the fitted runs say nothing, are as uncertain as their priors. Features are not asked: the error of a model is
    common to all those of a run.
    """
    runs = problem.held_out
    if not runs or null.unordered:
        return 0.0
    noises = tuple(budget[run.name] for run in runs)
    latent = with_own_parameters(problem, noises, null.hypothesis, null.latent, runs)
    there = linearised(problem, noises, null.hypothesis, latent, runs)
    jacobian, residual = np.concatenate(there.jacobians), np.concatenate(there.residuals)
    left = orthogonal(residual, jacobian, null.precision(weights))
    return _misfit(there.noises, there.residuals, residual @ left, uncertainty)


def _moved_p(problem, null, weights):
    """p-value of the given values: their squared error over the refitted ones', chi^2 with one degree per parameter.

    Parameters of single runs are refitted beside the given values: nobody has given theirs.
    """
    shared = null.hypothesis.shared
    if not shared.any():
        return 1.0
    try:
        start = np.where(shared, null.hypothesis.nominal, null.latent)
        latent = with_own_parameters(problem, null.noises, null.hypothesis, start, null.runs)
    except BrakechainError:
        return 0.0
    given, error = whitened(problem, null.noises, null.hypothesis, latent, null.runs)
    if error:
        return 0.0
    square = np.array([r @ r for r in given])
    return float(scipy.stats.chi2.sf(weights @ (square - null.chi_square), shared.sum()))

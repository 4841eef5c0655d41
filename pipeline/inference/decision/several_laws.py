"""Whether each of several laws is needed beside the others: by evidence, and on runs that were not fitted."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.inference.decision.candidate_statistics import held_out_gains, unexplained
from pipeline.inference.decision.evidence import evidence
from pipeline.inference.decision.held_out import gain, held_out_residuals, judged
from pipeline.inference.fitting.effective_sample_size import doubt
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued


@dataclass(frozen=True)
class Needed:
    """What a member of a set of laws is worth: ``evidence_gain`` (nat), its ``share`` of what the set explains of the
    objective, and ``errors``: its gain on runs not fitted in standard errors, None without any."""

    name: str
    evidence_gain: float
    share: float
    errors: float | None

    def objections(self, rules):
        """Why the set can do without it, in words."""
        reasons = []
        if self.evidence_gain < rules.evidence_gain:
            reasons.append(f"{self.name} adds an evidence of {self.evidence_gain:.1f} nat")
        if self.share < rules.second_share:
            reasons.append(f"{self.name} gives {self.share:.2%} of what the laws explain together, which an error of"
                           " the others may be")
        if self.errors is not None and self.errors < rules.gain_errors:
            reasons.append(f"the gain by {self.name} on runs that were not fitted is {self.errors:.1f} standard errors")
        return tuple(reasons)


def allowing(settings, laws, beside=False):
    """The settings of inference for a set of so many ``laws``: a coefficient takes up the errors of all their laws.

    It may follow the motion along the runs by as much, and between runs, where one law fades before the others, by
    more: whether coefficients hold for other runs is asked by leaving runs out (``several``). A shape that adapts may
    leave the square of the errors of all. What holds only in part is not named with others, nor ``beside`` one that is
    taken as known: two laws together imitate many a third.
    """
    decision = settings.rules.decision
    if laws == 1:
        strict = replace(decision, varies_too_much=decision.varies_by)
        return replace(settings, rules=replace(settings.rules, decision=strict)) if beside else settings
    varies = max(decision.varies_by, laws * decision.law_error)
    return replace(settings, rules=replace(settings.rules, decision=replace(
        decision, varies_by=varies, varies_too_much=varies, disagreement=np.inf,
        law_error=laws * decision.law_error)))


def against(null, problem, budget, weighing, rules):
    """The Weighing of the last law of a set with what each candidate leaves of the error of the nominal model alone.

    ``null``: the Fit of that. What a small law leaves beside the large ones is small, though much of its own.
    """
    fits = {k: w.fit for k, w in enumerate(weighing.weighed)}
    gains = held_out_gains(problem, budget, null, fits, np.ones(len(fits)), rules)
    uncertainty = rules.decision.noise_uncertainty

    def of_all(k, weighed):
        gained, statistics = gains[k][0], weighed.statistics
        statistics = replace(statistics, unexplained=unexplained(null, weighed.fit, rules))
        if gained is not None and gained.powered(uncertainty):
            left = gained.left(uncertainty)
            statistics = replace(statistics, powered=True, held_out_left=left, takes=max(gained.share, 0.0), stays=left,
                                 held_out_share=gained.share_at_most)
        return replace(weighed, statistics=statistics)

    return replace(weighing, weighed=tuple(of_all(k, w) for k, w in enumerate(weighing.weighed)))


def noise_reached(fit, rules):
    """Objective below which a fit with a further law than a Fit may reach the noise; one of its values may be as far
    from its prior as any."""
    counts, priors = fit.counts.sum(), fit.latent @ fit.latent + rules.calibration.excluded**2
    return (1 + rules.decision.noise_uncertainty) * counts + priors


def hoped(null, rules, times=2.0):
    """Objective that a fit has to promise so that it may leave no more than is allowed of the excess error of the Fit
    ``null``; ``times``: priors add to what it leaves."""
    counts = null.counts.sum()
    excess = max(null.chi_square.sum() - counts, 0.0)
    return counts + doubt(counts, rules.decision.noise_uncertainty) + times * rules.decision.unexplained * excess


def left_by(problem, budget, null, fit, rules):
    """(Share of the excess error of the Fit ``null`` that a Fit leaves; on held-out runs its error in noise floors and
    the share it leaves there, None without any, or where these need nothing)."""
    gained, _ = held_out_gains(problem, budget, null, {0: fit}, np.ones(1), rules)[0]
    uncertainty = rules.decision.noise_uncertainty
    powered = bool(gained) and gained.powered(uncertainty)
    return unexplained(null, fit, rules), gained and gained.error, gained.left(uncertainty) if powered else None


def too_much(left, rules):
    """That laws leave the share ``left`` of the excess error, in words."""
    return (f"together they leave {left:.1%} of the excess error, where {rules.decision.unexplained:.0%} may stay"
            " (decision.unexplained)")


def values_of(fit, laws):
    """((parameter, value, unit), ...) of ``laws`` (Hypothesis, ...) in a Fit."""
    return tuple((p.name, fit.values[p.name], p.unit) for law in laws for p in law.parameters)


def leading(combinations, decision, rules, alone=1.0):
    """Index of the set of laws that predicts held-out runs best, else fits best, among the ``combinations`` that leave
    little together, on held-out runs too, by values that no prior excludes: half of what the leading law of a Decision
    ``unknown`` leaves, and clearly less than the share ``alone`` of the best fit of one; None where none does."""
    if decision.verdict != "unknown":
        return None
    together, led = rules.decision.leads_together, 1 - decision.leading.takes if decision.leading else 1.0
    most = min(together, led / 2, rules.decision.leads_clearly * alone)
    good = [k for k, c in enumerate(combinations) if c.left is not None and c.left <= most
            and (c.held_out_left or 0.0) <= together and not c.excluded]
    return min(good, key=lambda k: (combinations[k].held_out or 0.0, combinations[k].left), default=None)


def unneeded(problem, budget, null, without, whole, members, rules):
    """Why ``members`` (Hypotheses), fitted together as the Fit ``whole``, can do without one of them, in words.

    ``null``: Fit of the nominal model alone; ``without``: that without the last member. The others are left out one by
    one and the rest fitted once more. Raises what the forward model raises.
    """
    *others, last = members
    fits = [(member.name, _without(problem, whole, null.hypothesis, [m for m in members if m is not member]))
            for member in others]
    return tuple(why for name, fit in (*fits, (last.name, without))
                 for why in _needed(problem, budget, name, null, fit, whole, rules).objections(rules))


def _needed(problem, budget, name, null, without, whole, rules):
    """Needed of what the Fit ``whole`` has and the Fit ``without`` has not; ``null`` Fit of the nominal model."""
    with_it, other = evidence(whole, whole.weights), evidence(without, whole.weights)
    runs, errors = problem.held_out, None
    if runs:
        noises, share = tuple(budget[run.name] for run in runs), rules.start_share
        gained = gain(judged(problem, noises, runs, share),
                      *(held_out_residuals(problem, noises, fit, runs, share) for fit in (without, whole)))
        errors = gained.errors_with(with_it.left_out - other.left_out)
    return Needed(name, with_it.log_evidence - other.log_evidence,
                  whole.betters(without) / max(whole.betters(null), 1e-300), errors)


def _without(problem, whole, nominal, members):
    """Fit of the Hypothesis ``nominal`` with ``members`` alone, from the values that they have in the Fit ``whole``."""
    hypothesis = nominal
    for member in members:
        hypothesis = hypothesis.joined(member)
    names = {p.name for p in hypothesis.parameters}
    kept = np.array([p.name in names for p in whole.hypothesis.parameters])
    begin = linearised(problem, whole.noises, hypothesis, whole.latent[kept], whole.runs)
    return continued(problem, begin, patient=False)

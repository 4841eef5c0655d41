"""The rules by which a diagnosis names, abstains or says that nothing is missing."""

from dataclasses import dataclass, replace

#: relative difference of numbers that are the same
_ROUNDING = 1e-6
VERDICTS = ("consistent", "parameters", "missing", "tie", "sensor", "numerics", "unknown")


@dataclass(frozen=True)
class CandidateStatistics:
    """A refitted candidate, in numbers. ``held_out_*`` are of runs never fitted, or None where there are none.

    ``left_out_gain``: log predictive density of left-out operating points over the null's; ``unfitted_errors``: gain on
    left-out points and held-out runs together, in standard errors (None as those). ``held_out_share``: what its gain
    may be of the excess error, a standard error allowed for; ``held_out_left``: what it leaves of it beyond doubt;
    ``growth``: the power of its error there over that on the fitted runs. ``from_null``: largest distance of an effect
    parameter from its null, in standard deviations. ``forbidden``: at which of its values it is another law, or
    empty; ``doubts``: why its fit cannot be relied on, in words. ``powered``: whether held-out runs can tell, as the
    nominal model errs on them; ``takes`` and ``stays``: shares of the excess error on them, else on all runs.
    ``loses``: its loss on held-out runs over what it explains of the fitted ones. ``varying``: what its values follow
    along the runs, in words; ``remarks`` the same where it is told, and does not speak against it. ``held_out_error``:
    root mean square that it leaves there, in noise floors. ``adapts``: whether it is a law of samples in time whose
    shape adapts to them. ``nominal_p``: p-value of the nominal values that it asks for, under their priors.
    """

    name: str
    kind: str
    posterior: float
    evidence_gain: float
    p_value: float
    left_out_gain: float
    unfitted_errors: float | None
    held_out_errors: float | None
    held_out_share: float | None
    held_out_left: float | None
    growth: float | None
    beats_decoy: bool | None
    disagreement: float
    from_null: float
    unexplained: float
    forbidden: str = ""
    doubts: tuple = ()
    powered: bool = True
    takes: float = 0.0
    stays: float = 1.0
    loses: float = 0.0
    varying: tuple = ()
    held_out_error: float | None = None
    adapts: bool = False
    nominal_p: float = 1.0
    remarks: tuple = ()

    def significant(self, rules):
        """Whether it helps beyond chance on the runs that were fitted, by DecisionRules."""
        return self.p_value <= rules.p_value and self.evidence_gain >= rules.evidence_gain


@dataclass(frozen=True)
class RunStatistics:
    """The recordings and the recalibrated nominal model, in numbers.

    ``misfit``: standard deviations of its chi^2 beyond noise (noise uncertainty taken off), ``held_out`` the same on
    runs never fitted; ``coherent``: whether its residual holds frequencies that noise does not explain; ``moved_p``: of
    the nominal values; ``drift_p``: drift test; ``excluded``: nominal values that the data want where their priors all
    but exclude them, in words; ``powerless``: held-out runs that the nominal model predicts to the noise.
    """

    runs: int
    points: int
    misfit: float
    held_out: float
    coherent: bool
    moved_p: float
    drift_p: float
    excluded: tuple = ()
    powerless: tuple = ()


@dataclass(frozen=True)
class Decision:
    """``verdict``, the ``named`` CandidateStatistics (one, or all of a tie), and the ``reasons`` in words.

    ``leading``: where nothing is named although something is missing, the CandidateStatistics of what explains most of
    it beyond chance; None where no candidate helps. ``family``: others at its place that take about as much.
    ``runs_differ``: a sentence where each run alone is what the nominal model predicts; ``failure``: one where nothing
    could be judged.
    """

    verdict: str
    named: tuple
    reasons: tuple
    leading: CandidateStatistics | None = None
    family: tuple = ()
    runs_differ: str = ""
    failure: str = ""


def decide(runs, candidates, rules):
    """Decision over the CandidateStatistics of all refitted ``candidates`` and the RunStatistics ``runs``."""
    significant = [c for c in candidates if c.significant(rules)]
    judged = [(c, objections(c, runs, rules)) for c in significant]
    reasons = [f"{c.name}: {why}" for c, objected in judged for why in objected]
    survivors, refused = ([c for c, objected in judged if bool(objected) is broken] for broken in (False, True))
    if survivors and _posterior(survivors) >= rules.outweighed * _posterior(refused):
        decision = _among(survivors, [c for c, objected in judged if _rival(c, objected, rules)], runs, rules)
    else:
        reasons += [f"{c.name}: candidates that break a rule are more likely" for c in survivors]
        decision = _nothing_named(runs, rules, bool(significant))
        decision = replace(decision, reasons=decision.reasons + runs.excluded)
    if decision.verdict == "unknown":
        decision = replace(decision, leading=leading(significant, rules))
        decision = replace(decision, family=_family(decision.leading, significant, rules))
    remarks = tuple(f"{c.name}: {why}" for c in decision.named for why in c.remarks)
    return replace(decision, reasons=decision.reasons + remarks + tuple(reasons) + _not_tested(runs, rules))


def leading(significant, rules):
    """The most probable of the ``significant`` candidates that help beyond chance on runs not fitted, or None.

    None leads whose posterior is negligible beside one that cannot be relied on.
    """
    helping = [c for c in significant if _helps(c, rules) and c.posterior >= rules.leads]
    return max(helping, key=lambda c: c.posterior, default=None)


def _helps(candidate, rules):
    """Whether a candidate helps beyond chance on runs not fitted, by a fit that can be relied on."""
    beyond = candidate.unfitted_errors is None or candidate.unfitted_errors >= rules.gain_errors
    return (beyond and candidate.left_out_gain > 0 and candidate.takes >= rules.gain_share
            and candidate.from_null >= rules.from_null and not candidate.forbidden and not candidate.doubts
            and candidate.nominal_p >= rules.nominal_p
            and not (candidate.powered and (candidate.growth or 0.0) > rules.growth))


def _family(first, significant, rules):
    """Candidates of the kind and at the place of the ``first`` that take nearly as much: of its family, if no more."""
    if first is None:
        return ()
    return tuple(c for c in significant if c is not first and c.kind == first.kind and _place(c) == _place(first)
                 and c.takes >= rules.first_share * first.takes and _helps(c, rules))


def _place(candidate):
    return candidate.name.partition(" at ")[2]


def objections(candidate, runs, rules):
    """Rules that a significant candidate breaks, in words."""
    reasons = [*candidate.doubts, *candidate.varying]
    if candidate.forbidden:
        reasons.append(candidate.forbidden)
    if candidate.nominal_p < rules.nominal_p:
        reasons.append("the nominal values that it asks for are unlikely together under their priors"
                       f" (p {candidate.nominal_p:.1g}): a law of another form, or spreads that are stated too small")
    if candidate.from_null < rules.from_null:
        reasons.append(f"its value lies {candidate.from_null:.1f} standard deviations from none at all")
    reasons += _form(candidate, rules)
    if runs.points >= rules.agreement_points and candidate.disagreement > rules.disagreement:
        reasons.append(f"its value differs between operating points ({candidate.disagreement:.1f} standard deviations)")
    if runs.points >= 2 and candidate.left_out_gain <= 0:
        reasons.append("it predicts left-out operating points no better than the recalibrated nominal model")
    if candidate.held_out_errors is not None:
        if candidate.unfitted_errors < rules.gain_errors:
            reasons.append(f"its gain on runs that were not fitted is {candidate.unfitted_errors:.1f} standard errors")
        if not candidate.powered:
            if candidate.evidence_gain < rules.evidence_unconfirmed:
                reasons.append(f"no held-out run can confirm it, and its evidence is {candidate.evidence_gain:.1f}")
            if candidate.stays > rules.held_out_left:
                reasons.append(f"it leaves {candidate.stays:.0%} of the excess error on all runs, of which the held-out"
                               " ones cannot tell")
            if candidate.held_out_errors < -rules.loss_errors and candidate.loses > rules.held_out_left:
                reasons.append(f"it loses {candidate.loses:.0%} of what it explains again on held-out runs, which need"
                               " nothing")
        elif candidate.held_out_errors < -rules.loss_errors:
            reasons.append(f"it predicts held-out runs worse, by {-candidate.held_out_errors:.1f} standard errors")
        elif candidate.held_out_share < rules.gain_share:
            reasons.append(f"it takes {candidate.held_out_share:.1%} of the excess error on held-out runs at most")
        elif candidate.held_out_left > rules.held_out_left:
            reasons.append(f"it leaves {candidate.held_out_left:.0%} of the excess error on held-out runs")
        elif candidate.growth > rules.growth:
            reasons.append(f"its squared error on held-out runs is {candidate.growth:.1f} times that on the fitted"
                           " ones")
        if candidate.powered and candidate.beats_decoy is False:
            reasons.append("it predicts held-out runs no better than a decoy of equal size")
    return reasons


def _form(candidate, rules):
    """The objection to a law whose shape adapts and which leaves more than a right one would, in a list."""
    if not candidate.adapts or candidate.unexplained <= rules.law_error**2:
        return []
    return [f"it leaves {candidate.unexplained:.2%} of the excess error, though its shape adapts: a law of another"
            " form"]


def _rival(candidate, objected, rules):
    """Whether nothing but its form is ``objected``: not to be named for itself, but not excluded either."""
    return bool(objected) and objected == _form(candidate, rules)


def _posterior(candidates):
    """Posterior of several candidates together."""
    return sum(c.posterior for c in candidates)


def _among(survivors, rivals, runs, rules):
    """Decision among ``survivors`` of every rule; ``rivals``, refused for their form alone, can only tie with them."""
    total = _posterior(survivors) + _posterior(rivals)
    ordered = sorted((replace(c, posterior=c.posterior / max(total, 1e-300)) for c in survivors + rivals),
                     key=lambda c: -c.posterior)
    ordered, named, posterior = _each_once(ordered), [], 0.0
    for candidate in ordered:
        named.append(candidate)
        posterior += candidate.posterior
        if posterior >= rules.posterior:
            break
    names = ", ".join(c.name for c in named)
    if not any(c.unexplained <= rules.unexplained for c in named):
        left = min(c.unexplained for c in named)
        return Decision("unknown", (), (f"{names} would help but leaves {left:.0%} of the excess error on"
                                       " the fitted runs",))
    if runs.runs < rules.naming_runs:
        return Decision("tie", tuple(named), (f"{names} explains the only run; one run names nothing",))
    if len(named) > 1:
        if {c.kind for c in named} == {"sensor"}:
            return Decision("sensor", tuple(named), (f"the measurement: {names}, not told apart",))
        return Decision("tie", tuple(named), (f"these runs cannot tell {names} apart",))
    best = named[0]
    verdict = {"physics": "missing"}.get(best.kind, best.kind)
    return Decision(verdict, (best,), (f"{best.name}: posterior {best.posterior:.3f}, p {best.p_value:.2g} over the"
                                       f" catalogue, evidence {best.evidence_gain:.1f} over the nominal model",))


def _each_once(candidates):
    """The ``candidates``; of one effect at places that are one coordinate the first alone, as likely as all of it."""
    once = []
    for candidate in candidates:
        k = next((k for k, first in enumerate(once) if _same(first, candidate)), None)
        if k is None:
            once.append(candidate)
        else:
            first, place = once[k], _place(candidate)
            once[k] = replace(first, posterior=first.posterior + candidate.posterior, remarks=(
                *first.remarks, f"{place} is the same coordinate: one place with two names"))
    return once


def _same(first, other):
    """Whether two candidates are one effect that predicts the same."""
    alike = [(one.evidence_gain, one.takes, one.unexplained, one.left_out_gain) for one in (first, other)]
    return (first.name.partition(" at ")[0] == other.name.partition(" at ")[0]
            and all(abs(a - b) <= _ROUNDING * (abs(a) + abs(b)) for a, b in zip(*alike, strict=True)))


def _nothing_named(runs, rules, some_significant):
    if runs.misfit > rules.misfit or runs.coherent:
        why = "a significant candidate breaks a rule" if some_significant else "no candidate is significant"
        return Decision("unknown", (), (f"the recalibrated nominal model does not reach the noise, and {why}",))
    if runs.held_out > rules.misfit:
        return Decision("unknown", (), ("the recalibrated nominal model reaches the noise on the fitted runs, but is"
                                        f" {runs.held_out:.1f} standard deviations off on held-out ones",))
    if runs.drift_p <= rules.drift and not some_significant:
        return Decision("unknown", (), (f"fitted values drift over operating points (p {runs.drift_p:.2g})",))
    if runs.moved_p <= rules.moved:
        return Decision("parameters", (), (f"other values of the nominal parameters suffice (p {runs.moved_p:.2g}"
                                           " that the given ones are right)",))
    return Decision("consistent", (), ("the nominal model with its given values explains the runs within noise",))


def _not_tested(runs, rules):
    """What could not be tested with so few runs, in words."""
    reasons = []
    if runs.powerless:
        reasons.append(f"held-out runs without power: {', '.join(runs.powerless)}; the recalibrated nominal model"
                       " predicts them to the noise, so that they cannot tell what is missing")
    if runs.points < rules.agreement_points:
        reasons.append(f"{runs.points} operating point(s): whether values agree across them was not tested"
                       f" ({rules.agreement_points} are needed)")
    if runs.runs < rules.naming_runs:
        reasons.append("one run only: nothing was held out, the verdict is at most a tie")
    return tuple(reasons)

"""The rules by which a diagnosis names, abstains or says that nothing is missing."""

from dataclasses import dataclass, replace

VERDICTS = ("consistent", "parameters", "missing", "tie", "sensor", "numerics", "unknown")


@dataclass(frozen=True)
class Rules:
    """What must hold before an effect is named, and what counts as a misfit."""

    posterior: float = 0.9              # of the named set among all that survive
    outweighed: float = 1.0             # posterior of all that survive over that of all that break a rule
    p_value: float = 0.01               # family-wise, over the whole catalogue
    evidence_gain: float = 5.0          # ln Z over the refitted null
    gain_errors: float = 3.0            # gain on runs that were not fitted, in standard errors
    gain_share: float = 0.05            # held-out gain as a share of the excess error
    loss_errors: float = 1.0            # loss on held-out runs that chance explains, in standard errors
    # of coefficients across operating points, standard deviations; 2 would refuse a true effect of two coefficients in
    # one case of ten
    disagreement: float = 3.0
    tolerance: float = 0.05             # spread of coefficients that does not matter, relative
    from_null: float = 2.0              # distance of the coefficient from its null, standard deviations
    unexplained: float = 0.05           # share of the excess that the named effect may leave
    held_out_left: float = 0.1          # the same on held-out runs, whose conditions may be new
    growth: float = 3.0                 # power of what it leaves on held-out runs over that on the fitted ones
    second_share: float = 1e-2          # of what a first effect explains: its law may be wrong by a tenth of its force
    second_at_noise: float = 1e-4       # the same where both together reach the noise on all runs
    misfit: float = 3.0                 # standard deviations of chi^2 beyond which the nominal model does not fit
    noise_uncertainty: float = 0.05     # relative uncertainty of the noise power
    moved: float = 0.01                 # p-value below which nominal values count as wrong
    drift: float = 0.001                # p-value below which drift alone tells of missing physics


@dataclass(frozen=True)
class Contender:
    """A refitted candidate, in numbers. ``held_out_*`` are of runs never fitted, or None where there are none.

    ``left_out_gain``: log predictive density of left-out operating points over the null's; ``unfitted_errors``: gain on
    left-out points and held-out runs together, in standard errors (None as those). ``held_out_share``: what its gain
    may be of the excess error, a standard error allowed for; ``held_out_left``: what it leaves of it beyond doubt;
    ``growth``: the power of its error there over that on the fitted runs. ``from_null``: largest distance of an effect
    parameter from its null, in standard deviations. ``forbidden``: why its values cannot be (sign, passivity), or
    empty; ``doubts``: why its fit cannot be relied on, in words.
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


@dataclass(frozen=True)
class Situation:
    """The recordings and the recalibrated nominal model, in numbers.

    ``misfit``: standard deviations of its chi^2 beyond noise (noise uncertainty taken off), ``held_out`` the same on
    runs never fitted; ``coherent``: whether its residual holds frequencies that noise does not explain; ``moved_p``: of
    the nominal values; ``drift_p``: drift test; ``excluded``: nominal values that the data want where their priors all
    but exclude them, in words.
    """

    runs: int
    points: int
    misfit: float
    held_out: float
    coherent: bool
    moved_p: float
    drift_p: float
    excluded: tuple = ()


@dataclass(frozen=True)
class Decision:
    """``verdict``, the ``named`` contenders (one, or all of a tie), and the ``reasons`` in words."""

    verdict: str
    named: tuple
    reasons: tuple


def decide(situation, contenders, rules):
    """Decision over all refitted ``contenders``."""
    waived = _waivers(situation)
    significant = [c for c in contenders if c.p_value <= rules.p_value and c.evidence_gain >= rules.evidence_gain]
    asked = [(c, objections(c, situation, rules)) for c in significant]
    reasons = [f"{c.name}: {why}" for c, objected in asked for why in objected]
    survivors, refused = ([c for c, objected in asked if bool(objected) is broken] for broken in (False, True))
    outweighed = _weight(survivors) < rules.outweighed * _weight(refused)
    if survivors and not outweighed:
        decision = _among(survivors, situation, rules)
    else:
        reasons += [f"{c.name}: candidates that break a rule are more likely" for c in survivors]
        decision = _nothing_named(situation, contenders, rules, bool(significant))
        decision = replace(decision, reasons=decision.reasons + situation.excluded)
    return replace(decision, reasons=decision.reasons + tuple(reasons) + waived)


def objections(contender, situation, rules):
    """Rules that a significant contender breaks, in words."""
    reasons = list(contender.doubts)
    if contender.forbidden:
        reasons.append(contender.forbidden)
    if contender.from_null < rules.from_null:
        reasons.append(f"its value lies {contender.from_null:.1f} standard deviations from none at all")
    if situation.points >= 3 and contender.disagreement > rules.disagreement:
        reasons.append(f"its value differs between operating points ({contender.disagreement:.1f} standard deviations)")
    if situation.points >= 2 and contender.left_out_gain <= 0:
        reasons.append("it predicts left-out operating points no better than the recalibrated nominal model")
    if contender.held_out_errors is not None:
        if contender.unfitted_errors < rules.gain_errors:
            reasons.append(f"its gain on runs that were not fitted is {contender.unfitted_errors:.1f} standard errors")
        if contender.held_out_errors < -rules.loss_errors:
            reasons.append(f"it predicts held-out runs worse, by {-contender.held_out_errors:.1f} standard errors")
        elif contender.held_out_share < rules.gain_share:
            reasons.append(f"it takes {contender.held_out_share:.1%} of the excess error on held-out runs at most")
        elif contender.held_out_left > rules.held_out_left:
            reasons.append(f"it leaves {contender.held_out_left:.0%} of the excess error on held-out runs")
        elif contender.growth > rules.growth:
            reasons.append(f"its squared error on held-out runs is {contender.growth:.1f} times that on the fitted"
                           " ones")
        if contender.beats_decoy is False:
            reasons.append("it predicts held-out runs no better than a decoy of equal size")
    return reasons


def _weight(contenders):
    """Posterior of several Contenders together."""
    return sum(c.posterior for c in contenders)


def _among(survivors, situation, rules):
    total = _weight(survivors)
    ordered = sorted((replace(c, posterior=c.posterior / max(total, 1e-300)) for c in survivors),
                     key=lambda c: -c.posterior)
    named, share = [], 0.0
    for contender in ordered:
        named.append(contender)
        share += contender.posterior
        if share >= rules.posterior:
            break
    explaining = [c for c in named if c.unexplained <= rules.unexplained]
    names = ", ".join(c.name for c in named)
    if not explaining:
        left = min(c.unexplained for c in named)
        return Decision("unknown", (), (f"{names} would help but leaves {left:.0%} of the excess error",))
    if situation.runs < 2:
        return Decision("tie", tuple(named), (f"{names} explains the only run; one run names nothing",))
    if len(named) > 1:
        if {c.kind for c in named} == {"sensor"}:
            return Decision("sensor", tuple(named), (f"the measurement: {names}, not told apart",))
        return Decision("tie", tuple(named), (f"these runs cannot tell {names} apart",))
    best = named[0]
    verdict = {"physics": "missing"}.get(best.kind, best.kind)
    return Decision(verdict, (best,), (f"{best.name}: posterior {best.posterior:.3f}, p {best.p_value:.2g} over the"
                                       f" catalogue, evidence {best.evidence_gain:.1f} over the nominal model",))


def _nothing_named(situation, contenders, rules, some_significant):
    misfit = situation.misfit > rules.misfit or situation.coherent
    if misfit:
        state = "a significant candidate breaks a rule" if some_significant else "no candidate is significant"
        return Decision("unknown", (), (f"the recalibrated nominal model does not reach the noise, and {state}",))
    if situation.held_out > rules.misfit:
        return Decision("unknown", (), ("the recalibrated nominal model reaches the noise on the fitted runs, but is"
                                        f" {situation.held_out:.1f} standard deviations off on held-out ones",))
    if situation.drift_p <= rules.drift and not some_significant:
        return Decision("unknown", (), (f"fitted values drift over operating points (p {situation.drift_p:.2g})",))
    if situation.moved_p <= rules.moved:
        return Decision("parameters", (), (f"other values of the nominal parameters suffice (p {situation.moved_p:.2g}"
                                           " that the given ones are right)",))
    return Decision("consistent", (), ("the nominal model with its given values explains the runs within noise",))


def _waivers(situation):
    waivers = []
    if situation.points < 3:
        waivers.append(f"{situation.points} operating point(s): whether values agree across them was not tested"
                       " (three are"
                    " needed)")
    if situation.runs < 2:
        waivers.append("one run only: nothing was held out, the verdict is at most a tie")
    return tuple(waivers)

"""Every threshold that decides something between a recorded run and the verdict, step by step.

Constants that only tune a solver (step lengths, iterations, tolerances) stay beside the solver.
"""

from dataclasses import dataclass, field, fields


def threshold(default, meaning, unit="1"):
    """A field of a group of rules, with its default, its meaning and its unit."""
    return field(default=default, metadata={"meaning": meaning, "unit": unit})


@dataclass(frozen=True)
class CalibrationRules:
    """When a recalibrated nominal model is trusted."""

    excluded: float = threshold(5.0, "standard deviations beyond which a prior all but excludes a value (1 in 2"
                                     " million at 5)")
    better_null: float = threshold(0.1, "decrease of the objective at which a fit of the nominal model begun at a"
                                        " candidate's optimum replaces the first one")


@dataclass(frozen=True)
class ScreeningRules:
    """Which candidates the screen hands on."""

    p_value: float = threshold(0.1, "largest family-wise p-value of a score that is refitted, where the linearisation"
                                    " of the nominal model holds")
    visible: float = threshold(1e-8, "fraction of its squared change that an effect keeps beside the nominal"
                                     " parameters; below, it cannot be distinguished from them")


@dataclass(frozen=True)
class RefitRules:
    """Which refits go on, and which are given up."""

    within_reach: float = threshold(20.0, "log evidence of the best candidate within which another must be able to"
                                          " come, else its fit is given up", "nat")
    imitates: float = threshold(0.25, "fraction of the best candidate's squared score, at the nominal values that it"
                                      " asks for, at which another one is refitted there too")
    moves_alike: float = threshold(0.8, "the same, at which a candidate that comes nowhere near is led over")
    step_error: float = threshold(1e-3, "fraction of the noise power, or of what is left where that is more, that half"
                                        " the time step may change in what a leading candidate predicts; beyond, its"
                                        " step is halved")
    step_shift: float = threshold(0.5, "standard deviations that this change may shift one of its values")
    halvings: int = threshold(3, "times that the time step of a candidate may be halved")
    restarts: int = threshold(2, "times that the fit of the leading candidate, or of the nominal model where nothing is"
                                 " missing, begins again where it does not converge")
    better_by: float = threshold(1.0, "decrease of the objective at which the nominal model is refitted from a"
                                      " candidate's optimum")


@dataclass(frozen=True)
class EvidenceRules:
    """What a fit is worth as evidence."""

    coherent_chance: float = threshold(1e-3, "probability that noise shows a spectral line taken as not noise")
    nothing_more: float = threshold(1e-3, "fraction of what a fit explains below which the decrease that its slopes"
                                          " promise cannot matter")
    nothing_more_at_noise: float = threshold(1e-2, "the same for a fit that reaches the noise")
    hope: float = threshold(10.0, "times the promised decrease that an unconverged nominal fit may still come down")
    far_below: float = threshold(30.0, "ratio of squared errors beyond which it cannot matter where an unconverged"
                                       " nominal fit ends")
    decoy_posterior: float = threshold(0.05, "posterior below which a candidate of equal size serves as a decoy")
    decoy_explains: float = threshold(0.5, "fraction of what a candidate explains that its decoy may explain")


@dataclass(frozen=True)
class DecisionRules:
    """What must hold before an effect is named, and what counts as a misfit."""

    posterior: float = threshold(0.9, "posterior of the named set among all candidates that break no rule")
    leads: float = threshold(0.05, "posterior without which nothing is told as the leading explanation")
    leads_together: float = threshold(0.25, "fraction of the excess error that laws may leave together which are told"
                                            " as the leading explanation")
    leads_clearly: float = threshold(0.75, "fraction of what one law leaves that several may leave to lead in its"
                                           " place")
    one_factor: float = threshold(1.5, "factor by which a candidate that moves all nominal values alike explains"
                                       " nothing")
    outweighed: float = threshold(1.0, "posterior of the candidates that break no rule over that of those that do")
    p_value: float = threshold(0.01, "family-wise p-value, over the whole catalogue")
    evidence_gain: float = threshold(5.0, "log evidence over the recalibrated nominal model", "nat")
    evidence_unconfirmed: float = threshold(10.0, "the same where held-out runs cannot tell, so that none confirms it",
                                            "nat")
    nominal_p: float = threshold(1e-3, "p-value, under their priors, of all nominal values together that a candidate"
                                       " asks for")
    gain_errors: float = threshold(3.0, "standard errors of the gain on runs that were not fitted")
    gain_share: float = threshold(0.05, "held-out gain as a fraction of the excess error")
    loss_errors: float = threshold(1.0, "standard errors of a loss on held-out runs that chance explains")
    disagreement: float = threshold(3.0, "standard deviations between coefficients at different operating points (2"
                                         " would refuse a true effect of two coefficients in one case of ten)")
    tolerance: float = threshold(0.05, "relative spread of coefficients that does not matter")
    varies: float = threshold(4.0, "standard deviations by which a value may follow time or the size of the motion"
                                   " along the runs")
    varies_by: float = threshold(0.1, "relative change of a value along the runs that does not matter; beyond, it is"
                                      " told beside the name")
    varies_too_much: float = threshold(0.3, "relative change of a value along the runs at which its law is of another"
                                            " form, as one by a whole power of the motion is where that grows by two;"
                                            " below, no real law is exact")
    from_null: float = threshold(2.0, "distance of the coefficient from its null in standard deviations")
    unexplained: float = threshold(0.05, "fraction of the excess error that the named effect may leave")
    in_part: float = threshold(1.2, "noise floors that a law leaves from which on it holds in part, and from which on"
                                    " it is asked what holds beside an error of the model")
    held_out_left: float = threshold(0.1, "the same on held-out runs, whose conditions may be new")
    start_share: float = threshold(0.25, "fraction of a held-out run to which its unknown start is fitted; the rest is"
                                         " judged")
    growth: float = threshold(3.0, "power of the error on held-out runs over that on the fitted ones")
    second_share: float = threshold(1e-2, "fraction of what a first effect explains that a second one must explain:"
                                          " the law of the first may be wrong by a tenth of its force")
    law_error: float = threshold(0.05, "relative standard deviation of the force of a law, by which a further law is"
                                       " not needed; a law whose shape adapts may leave no more than its square")
    form_p: float = threshold(1e-3, "p-value at which what a named law leaves moves as other laws at its place do")
    along_motions: float = threshold(30.0, "noise powers that the best set of laws may leave along measured motions;"
                                           " beyond, pairs are tried before it: what switches shows badly along noisy"
                                           " motions")
    second_at_noise: float = threshold(1e-4, "the same where both together reach the noise on all runs, at another"
                                             " place than the first; at its place the square of `law_error`")
    misfit: float = threshold(3.0, "standard deviations of chi^2 beyond which the nominal model does not fit")
    noise_uncertainty: float = threshold(0.05, "relative uncertainty of the noise power")
    moved: float = threshold(0.01, "p-value below which nominal values count as wrong")
    drift: float = threshold(0.001, "p-value below which drift alone tells of missing physics")
    first_share: float = threshold(0.9, "fraction of what the best first effect explains at which another one is tried"
                                        " as the first of a pair")
    first_unexplained: float = threshold(0.7, "fraction of the excess error that the first of a pair may leave")
    posterior_of_few: float = threshold(0.95, "takes the place of `posterior` where runs hold a few dozen numbers"
                                              " (poles, friction): evidence e^3 times that of the next")
    agreement_points: int = threshold(3, "operating points from which agreement of coefficients is tested")
    naming_runs: int = threshold(2, "runs without which nothing is named")


@dataclass(frozen=True)
class Rules:
    """The rules of all steps of a diagnosis."""

    calibration: CalibrationRules = CalibrationRules()
    screening: ScreeningRules = ScreeningRules()
    refit: RefitRules = RefitRules()
    evidence: EvidenceRules = EvidenceRules()
    decision: DecisionRules = DecisionRules()

    def rows(self):
        """[(name, value, unit, meaning)] of every threshold, ``name`` as in the settings: ``decision.posterior``."""
        return [(f"{group.name}.{rule.name}", float(getattr(getattr(self, group.name), rule.name)),
                 rule.metadata["unit"], rule.metadata["meaning"])
                for group in fields(self) for rule in fields(getattr(self, group.name))]


#: the rules as they are where a case says nothing else
DEFAULTS = Rules()

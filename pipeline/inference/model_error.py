"""What is named where no model reaches the noise: laws that hold in part, beside the error of the model.

No law of a real joint is exact, and noise that was measured at rest knows nothing of that. Where the best candidates
leave far more than noise, all of them are refused, those first that adapt to what is left. Then all is asked once more
with noise as large as what the best of them leaves of fitted and of held-out runs: what the ordinary rules name beside
that explains nearly all, predicts runs not fitted as well, and has no rival. That it holds in part is told.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import sentence_of
from pipeline.inference.time_budget import spent

#: times that all is asked, and factor from one noise to the next where nothing is named beside the first
_ROUNDS, _LARGER = 4, 2.0
#: factor of the noise at which a law is named over the next that is tried
_LESS = 1.2
#: verdicts that may hold in part
_OF_LAWS = ("missing", "tie")


def beside_it(asked, told):
    """The Diagnosis ``told`` of what was Asked; where it names nothing, as no model of one law reaches the noise, that
    which names a law beside larger noise, which its ``model_error`` is over the stated one."""
    if not _open(told):
        return told
    rules, named = asked.settings.rules.decision, told
    factor, largest = _left(told, told.weighed), np.sqrt(rules.unexplained) * _floors(told.null)
    for _ in range(_ROUNDS):
        if spent() or not rules.in_part < factor < largest:
            break
        larger = {name: noise.scaled(factor) for name, noise in asked.budget.items()}
        try:
            again = replace(asked, budget=larger, tell=None, alone=True).told()
        except Exception as error:      # what was told beside the stated noise stands
            return named.remarked(f"whether a law holds in part could not be computed: {sentence_of(error)}")
        if again.decision.verdict in _OF_LAWS and {w.candidate.kind for w in again.named} == {"physics"}:
            named = _beside_stated(again, factor)
            less = _left(named, named.named)
            factor = less if less * _LESS < factor else np.inf
        elif named is told and again.decision.verdict == "unknown":     # else nothing is missing beside that error
            factor *= _LARGER
        else:
            break
    return named


def _open(told):
    """Whether a Diagnosis of samples by one law leaves what noise is not."""
    return (told.decision.verdict == "unknown" and not told.cut_short and told.base is None
            and not told.null.unordered)


def _left(told, weighed):
    """Noise floors that the best of the physics ``weighed`` leaves of the fitted and of held-out runs, the larger of
    both."""
    return min((max(_floors(w.fit), told.model_error * (w.statistics.held_out_error or 0.0)) for w in weighed
                if w.statistics.kind == "physics"), default=np.inf)


def _floors(fit):
    return float(np.sqrt(fit.chi_square.sum() / fit.counts.sum()))


def _beside_stated(again, factor):
    """A Diagnosis beside noise ``factor`` times as large, its fits beside the stated noise, and a word on that."""
    refits = again.refits.at_noise(1 / factor)
    weighed = tuple(replace(w, fit=w.fit.at_noise(1 / factor)) for w in again.weighed)
    names = " or ".join(c.name for c in again.decision.named)
    why = (f"no model reaches the noise: beside an error of the model of {factor:.2g} noise floors, which the best ones"
           f" leave, {names} holds in part")
    return replace(again, calibration=refits.calibration, refits=refits, model_error=factor,
                   weighing=replace(again.weighing, weighed=weighed),
                   decision=replace(again.decision, reasons=(why, *again.decision.reasons)))

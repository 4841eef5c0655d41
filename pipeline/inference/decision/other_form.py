"""Whether what a named law leaves moves as other laws at its place would: then it is of another form.

What is left is read along the directions g in which other laws at the place would change the prediction beside the
named one, cleaned of what any values explain: the largest |g'r| / |g|. How large that is by chance the residual itself
tells, each channel of each run shifted round by a random number of samples: so it keeps the level and the colour of
its noise, whatever was stated of them, and is parted from the motions. A sum of squares cannot see what is less than
the noise power is uncertain by; along a few directions it is plain.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from pipeline.inference.search.score_screen import directions

#: residuals shifted round
DRAWS = 1999
#: share of its length that a direction keeps beside those of the values, below which it is one of them
_OWN = 1e-3
#: p-value above which what is left moves along a law by chance
_CHANCE = 0.05


@dataclass(frozen=True)
class Left:
    """What is left along the law ``name``: the largest ``score``, how often shifted residuals reach it (``p_value``),
    and its ``energy`` beyond theirs, in noise powers."""

    name: str
    score: float
    p_value: float
    energy: float


def left_along(problem, fit, candidates, fan_out=map, seed=0):
    """Left of a Fit along ``candidates`` (Hypothesis, ...) beside it, None where none of them changes what it predicts.

    ``problem``: a Problem whose nominal hypothesis is that of the fit.
    """
    return along(fit, list(fan_out(partial(directions, problem, fit), candidates)), seed)


def along(fit, every, seed=0):
    """The same along ``every`` Directions at the Fit."""
    owner = [d.candidate.name for d in every for _ in d.sign]
    vectors = np.concatenate([np.empty((0, fit.counts.sum())), *(d.vectors for d in every)])
    values = scipy.linalg.orth(np.concatenate(fit.jacobians))
    cleaned = vectors - (vectors @ values) @ values.T
    size = np.linalg.norm(cleaned, axis=1)
    seen = np.flatnonzero(size > _OWN * np.linalg.norm(vectors, axis=1))
    if not len(seen):
        return None
    unit = cleaned[seen] / size[seen][:, None]
    scores, by_chance = np.abs(unit @ np.concatenate(fit.residuals)), largest_shifted(unit, fit, seed)
    most = float(scores.max())
    return Left(owner[seen[scores.argmax()]], most, float(np.mean(np.append(by_chance, most) >= most)),
                max(most**2 - float(np.mean(by_chance**2)), 0.0))


def largest_shifted(unit, fit, seed=0, draws=DRAWS):
    """Largest |g'r| (draws,) over the rows g of ``unit`` (q, m), each channel of each run of a Fit shifted round."""
    generator, begin, sums = np.random.default_rng(seed), 0, np.zeros((draws, len(unit)))
    for noise, white in zip(fit.noises, fit.residuals, strict=True):
        for part in noise.by_channel(white):
            own, begin = unit[:, begin:begin + len(part)], begin + len(part)
            if len(part):
                every = np.fft.irfft(np.fft.rfft(own).conj() * np.fft.rfft(part), len(part))
                sums += every[:, generator.integers(len(part), size=draws)].T
    return np.abs(sums).max(axis=1)


def of_noise(diagnosis, seed=0):
    """That what the nominal model of a Diagnosis leaves may be noise of another colour than is stated, in words; empty
    where a law of the catalogue moves along it, and of features."""
    null = diagnosis.null
    left = None if null.unordered else along(null, diagnosis.refits.directions, seed)
    if left is None or left.p_value <= _CHANCE:
        return ""
    return ("what the recalibrated nominal model leaves moves along no law of the catalogue by more than chance (p"
            f" {left.p_value:.2g}): noise of another colour or size than stated would leave as much, or physics unlike"
            " any of these; repeat a run, which measures the noise")


def objection(diagnosis, weighed, catalogue, rules, fan_out=map, seed=0):
    """Why the ``weighed`` law that a Diagnosis names is of another form, in words; empty where nothing says so.

    Only the simple ones of a ``catalogue`` are asked, and none of features, which have no order in time.
    """
    fit = weighed.fit
    if fit.unordered:
        return ""
    known = {effect for effect, _ in fit.hypothesis.effects}
    others = tuple(c for c in catalogue if c.kind == "physics" and not c.elaborate and c.effects[0][0] not in known
                   and fit.hypothesis.places & c.places)
    left = left_along(diagnosis.calibration.problem.given(weighed.refined), fit, others, fan_out, seed)
    if left is None or left.p_value > rules.form_p:
        return ""
    count, null = fit.counts.sum(), diagnosis.recalibrated
    share = left.energy / max(null.chi_square.sum() - count, fit.explains(null))
    if share <= (rules.law_error**2 if weighed.statistics.adapts else rules.unexplained):
        return ""
    return (f"what it leaves moves as {left.name} would ({left.score:.1f} standard deviations of the noise, p"
            f" {left.p_value:.2g}), {share:.1%} of the excess error at least: a law of another form")

"""Hypotheses weighed by how probable they make heard lines: fields of the product LineEvidence."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.diagnosis.published.line_hypotheses import FLEXIBLE, LOADING, RIGID, tone_set, tones_of
from pipeline.inference.decision.line_evidence import (
    Band,
    calibration,
    log_density,
    log_evidence,
    log_mean,
    named,
)

#: hypothesis that predicts no tone
UNEXPLAINED = "unexplained"
#: verdict where no kind of disc, nor that lines are unexplained, is so many times as probable as the others
UNDECIDED, _NAMED = "undecided", 10.0
#: shares of tones that are heard, averaged over: middles of equal parts of their range
_SHARES = 5
#: fewest draws near a line from which quantiles are taken
_FEWEST = 5
_QUANTILES = (0.1, 0.5, 0.9)


@dataclass(frozen=True)
class Predicted:
    """Of one hypothesis: its Drawn, ``disc``, and of every draw its tones, [((k,) Hz, (k, t))] as of ``tone_set``.

    ``loud`` [(k,)] Hz those that grow in a test with lines; ``roots`` [draw][operating point of such tests]: (r,) 1/s,
    those that grow or nearly do.
    """

    drawn: object
    disc: str
    tones: list
    loud: list
    roots: list


def predicted(hypothesis, drawn, roots, tests, highest, error):
    """Predicted of a Hypothesis from ``roots`` [draw][operating point] (r,) 1/s of the BenchTests.

    Growth by changing load acts where the load changes; ``highest`` Hz ends the multiples; ``error`` as of
    ``tones_of``.
    """
    count, silent = len(tests.name), tests.silent[tests.test]
    multiples = hypothesis.multiples if hypothesis.harmonics else 1
    sets = [tone_set(points, more * tests.changing, tests.test, count, highest, multiples, error)
            for points, more in zip(roots, drawn.column(LOADING), strict=True)]
    loud = [f[grows[:, ~tests.silent].any(axis=1)] for f, grows in sets]
    kept = [[r for r, quiet in zip(points, silent, strict=True) if not quiet] for points in roots]
    return Predicted(drawn, hypothesis.disc, sets, loud, kept)


def weighed(hypotheses, tests, settings):
    """Fields of LineEvidence of {name: Predicted} and BenchTests, but for those of the operating points and the cycle.

    ``settings``: of the section ``line_evidence`` its low, high, unexplained, elsewhere, heard, model_error, reference
    and seed.
    """
    band, error = Band(settings.low, settings.high, settings.unexplained, settings.elsewhere), settings.model_error
    low, high = settings.heard
    shares = low + (high - low) * (np.arange(_SHARES) + 0.5) / _SHARES
    count, heard, silent = len(tests.name), tests.heard, tests.silent
    tones = {name: tones_of(p.tones, count, shares, error, tests.reading) for name, p in hypotheses.items()}
    draws = len(next(iter(hypotheses.values())).tones)
    tones[UNEXPLAINED] = tones_of([(np.empty(0), np.empty((0, count)))] * draws, count, shares, error, tests.reading)
    both, alone, silence = (_by_draw(tones, heard, band, part) for part in (silent | True, ~silent, silent))
    evidence, deviation, carried = np.array([log_evidence(row, settings.seed) for row in log_mean(both)]).T
    discs = np.array([*(p.disc for p in hypotheses.values()), "none"])
    base = list(tones).index(settings.reference)
    return {
        "hypothesis": list(tones), "disc": discs, "test": list(tests.name), "line": heard.lines,
        "heard_in": heard.tests, "band": [band.low, band.high], "unexplained": band.unexplained,
        "elsewhere": band.elsewhere, "model_error": error, "evidence": evidence, "evidence_error": deviation,
        "lines_alone": log_mean(log_mean(alone)), "silence": np.exp(log_mean(log_mean(silence))), "carried": carried,
        "reference": base, "factor": evidence - evidence[base],
        "factor_error": np.where(np.arange(len(discs)) == base, 0.0, np.hypot(deviation, deviation[base])),
        **_families(evidence, deviation, discs), "weight": scipy.special.softmax(log_mean(both), axis=1),
        **_values(hypotheses, heard.lines, error, draws), **_tones(hypotheses),
        **_calibrated(tones, discs, band, settings.seed)}


def _by_draw(tones, heard, band, tests):
    """ln of the density (h, d, shares) of what was heard in some ``tests`` (t,); 0 without any."""
    if not tests.any():
        return np.zeros((len(tones), len(next(iter(tones.values()))) // _SHARES, _SHARES))
    return np.array([log_density(heard.within(tests), t.within(tests), band).reshape(-1, _SHARES)
                     for t in tones.values()])


def _families(evidence, deviation, discs):
    """ln Bayes factor of all hypotheses with a flexible disc, equally probable, against all with a rigid one; and
    which of these, and of unexplained lines, is named."""
    groups = (FLEXIBLE, RIGID, "none")
    weights = {disc: scipy.special.softmax(evidence[discs == disc]) for disc in groups}
    errors = {disc: np.sqrt(np.sum((weights[disc] * deviation[discs == disc]) ** 2)) for disc in groups}
    whole = {disc: log_mean(evidence[discs == disc]) for disc in groups}
    best = max(groups, key=whole.get)
    clear = all(whole[best] - whole[other] - np.hypot(errors[best], errors[other]) >= np.log(_NAMED)
                for other in groups if other != best)
    return {"flexible": whole[FLEXIBLE] - whole[RIGID], "flexible_error": np.hypot(errors[FLEXIBLE], errors[RIGID]),
            "verdict": best if clear else UNDECIDED}


def _family_factor(evidence, discs):
    return log_mean(evidence[..., discs == FLEXIBLE]) - log_mean(evidence[..., discs == RIGID])


def _values(hypotheses, lines, error, count):
    """Drawn values, and what those draws have in common whose tones are near the lines."""
    columns = list(dict.fromkeys(c for p in hypotheses.values() for c in p.drawn.name))
    rows, targets = len(hypotheses) + 1, len(lines) + 1
    value = np.zeros((rows, count, len(columns)))
    growth = np.tile(-2 * np.pi * lines, (rows, count, 1))
    near = np.zeros((rows, targets))
    shift = np.zeros((rows, targets, len(columns)))
    quantile = np.zeros((*shift.shape, len(_QUANTILES)))
    for row, p in enumerate(hypotheses.values()):
        value[row][:, [columns.index(c) for c in p.drawn.name]] = p.drawn.values
        growth[row] = [[_largest_growth(points, line, error) for line in lines] for points in p.roots]
        meets = np.array([[np.any(abs(f - line) <= error * line) for line in lines] for f in p.loud])
        meets = np.column_stack((meets, meets.all(axis=1)))
        near[row] = meets.mean(axis=0)
        for target in np.flatnonzero(meets.sum(axis=0) >= _FEWEST):
            chosen = value[row][meets[:, target]]
            quantile[row, target] = np.quantile(chosen, _QUANTILES, axis=0).T
            shift[row, target] = [_shift(all_, some) for all_, some in zip(value[row].T, chosen.T, strict=True)]
    return {"column": columns, "value": value, "line_growth": growth, "near": near, "target_shift": shift,
            "target_quantile": quantile, "all_quantile": np.moveaxis(np.quantile(value, _QUANTILES, axis=1), 0, -1)}


def _shift(every, some):
    """Deviation of the mean rank of ``some`` (k,) among ``every`` (d,), in its standard deviations without relation."""
    if not np.ptp(every) > 0 or len(some) == len(every):
        return 0.0
    rank = scipy.stats.rankdata(every)[np.isin(every, some)]
    variance = (len(every) + 1) * (len(every) - len(some)) / (12 * len(some))
    return (rank.mean() - (len(every) + 1) / 2) / np.sqrt(variance)


def _largest_growth(points, line, error):
    """Largest growth rate 1/s of roots [(r,)] within ``error`` of a ``line`` Hz;
    minus its angular frequency without any."""
    root = np.concatenate([np.empty(0, complex), *points])
    near = root[abs(abs(root.imag) / (2 * np.pi) - line) <= error * line]
    return near.real.max() if len(near) else -2 * np.pi * line


def _tones(hypotheses):
    per_draw = [(row, draw, f) for row, p in enumerate(hypotheses.values()) for draw, f in enumerate(p.loud)]
    sizes = [len(f) for *_, f in per_draw]
    return {"tone": np.concatenate([np.empty(0), *(f for *_, f in per_draw)]),
            "tone_hypothesis": np.repeat([row for row, *_ in per_draw], sizes),
            "tone_draw": np.repeat([draw for _, draw, _ in per_draw], sizes)}


def _calibrated(tones, discs, band, seed):
    """How often simulated lists name each hypothesis, and how they weigh flexible against rigid."""
    evidence = calibration(tones, band, seed)
    winner = named(evidence)
    share = [[np.mean(row == k) for k in (*range(len(discs)), -1)] for row in winner]
    return {"confusion": share, "simulated": _family_factor(evidence, discs)}

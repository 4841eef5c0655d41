"""Hypotheses weighed by how probable they make heard lines: fields of the product LineEvidence."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.diagnosis.published.line_hypotheses import FLEXIBLE, LOADING, RIGID, tone_frequencies, tones_of
from pipeline.inference.decision.line_evidence import (
    Band,
    Tones,
    calibration,
    log_evidence,
    log_lines,
    log_mean,
    log_silence,
    named,
)

#: hypothesis that predicts no tone
UNEXPLAINED = "unexplained"
#: shares of tones that are heard, averaged over: middles of equal parts of their range
_SHARES = 5
#: fewest draws near a line from which quantiles are taken
_FEWEST = 5
_QUANTILES = (0.1, 0.5, 0.9)


@dataclass(frozen=True)
class Predicted:
    """Of one hypothesis: its Drawn, ``disc``, tones [(k,)] Hz of every draw in the cycle and at constant load.

    ``roots`` [draw][operating point of the cycle]: (r,) 1/s, those that grow or nearly do.
    """

    drawn: object
    disc: str
    cycle: list
    constant: list
    roots: list


def predicted(hypothesis, drawn, cycle, constant, highest, error):
    """Predicted of a Hypothesis from roots ``cycle`` and ``constant`` [draw][operating point] (r,) 1/s.

    Growth by changing load acts in the cycle only; ``highest`` Hz ends the multiples; ``error`` as of ``tones_of``.
    """
    loading, still = drawn.column(LOADING), np.zeros(len(cycle))
    made = [[tone_frequencies(points, more, highest, hypothesis.harmonics, error)
             for points, more in zip(of_draws, growth, strict=True)]
            for of_draws, growth in ((cycle, loading), (constant, still))]
    return Predicted(drawn, hypothesis.disc, *made, cycle)


def weighed(hypotheses, lines, reading, ends, unexplained, shares, error, reference, seed):
    """Fields of LineEvidence of {name: Predicted}, but for those of the operating points.

    ``lines`` (n,) Hz with standard deviation ``reading`` Hz; ``ends`` Hz of the band and its number of
    ``unexplained`` lines; ``shares`` range of the share of tones that leave a line; ``error`` relative standard
    deviation of a predicted frequency.
    """
    band = Band(*ends, unexplained)
    shares = shares[0] + (shares[1] - shares[0]) * (np.arange(_SHARES) + 0.5) / _SHARES
    tones = {name: tones_of(p.cycle, p.constant, shares, error, reading) for name, p in hypotheses.items()}
    rows = len(next(iter(tones.values())))
    tones[UNEXPLAINED] = Tones(*np.ones((2, rows, 0)), np.zeros((rows, 0)), np.zeros(rows))
    alone = np.array([log_lines(lines, t, band).reshape(-1, _SHARES) for t in tones.values()])
    silence = np.array([log_silence(True, t, band).reshape(-1, _SHARES) for t in tones.values()])
    both = log_mean(alone + silence)
    evidence, deviation, carried = np.array([log_evidence(row, seed) for row in both]).T
    discs = np.array([*(p.disc for p in hypotheses.values()), "none"])
    base = list(tones).index(reference)
    return {
        "hypothesis": list(tones), "disc": discs, "line": lines, "band": [band.low, band.high],
        "unexplained": band.unexplained, "model_error": error, "evidence": evidence, "evidence_error": deviation,
        "lines_alone": log_mean(log_mean(alone)),
        "silence": np.exp(log_mean(log_mean(silence))), "carried": carried,
        "reference": base, "factor": evidence - evidence[base],
        "factor_error": np.where(np.arange(len(discs)) == base, 0.0, np.hypot(deviation, deviation[base])),
        **_families(evidence, deviation, discs), "weight": scipy.special.softmax(both, axis=1),
        **_values(hypotheses, lines, error, rows // _SHARES), **_tones(hypotheses),
        **_calibrated(tones, discs, band, seed)}


def _families(evidence, deviation, discs):
    """ln Bayes factor of all hypotheses with a flexible disc, equally probable, against all with a rigid one."""
    weights = {disc: scipy.special.softmax(evidence[discs == disc]) for disc in (FLEXIBLE, RIGID)}
    variance = sum(np.sum((weights[disc] * deviation[discs == disc]) ** 2) for disc in weights)
    return {"flexible": _family_factor(evidence, discs), "flexible_error": np.sqrt(variance)}


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
        meets = np.array([[np.any(abs(f - line) <= error * line) for line in lines] for f in p.cycle])
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
    per_draw = [(row, draw, f) for row, p in enumerate(hypotheses.values()) for draw, f in enumerate(p.cycle)]
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

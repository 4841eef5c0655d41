"""Baseline: sparse regression over the whole library by sequentially thresholded least squares.

S. L. Brunton, J. L. Proctor, J. N. Kutz, Proc. Natl. Acad. Sci. 113 (2016) 3932. Values of the nominal model are never
dropped: they are projected out beforehand.
"""

import numpy as np

from pipeline.blind_trial.baselines.answers import named, nothing
from pipeline.blind_trial.baselines.regression import equations
from pipeline.blind_trial.baselines.rig import read

#: share of the applied forces below which a law is dropped, and rounds: tuned, on no case
_THRESHOLD, _ROUNDS = 0.05, 20


def answer(folder):
    """All laws that are kept, the largest first."""
    rig = read(folder)
    regression = equations(rig, rig.runs)
    terms = list(regression.library)
    basis, _ = np.linalg.qr(regression.nominal)
    columns = np.column_stack([regression.library[t] / (np.linalg.norm(regression.library[t]) or 1.0) for t in terms])
    left, apart = (a - basis @ (basis.T @ a) for a in (regression.target, columns))
    size = abs(stlsq(apart, left, _THRESHOLD * np.linalg.norm(regression.target)))
    kept = [terms[k] for k in np.argsort(-size) if size[k] > 0]
    return named(kept, len(kept)) if kept else nothing()


def stlsq(columns, target, threshold, rounds=_ROUNDS):
    """Coefficients (k,) of least squares in which all below ``threshold`` are set to 0, again and again."""
    kept = np.ones(columns.shape[1], bool)
    for _ in range(rounds):
        coefficients = np.zeros(len(kept))
        if kept.any():
            coefficients[kept] = np.linalg.lstsq(columns[:, kept], target, rcond=None)[0]
        after = abs(coefficients) >= threshold
        if (after == kept).all():
            break
        kept = after
    return np.where(kept, coefficients, 0.0)

"""Baseline: least Bayesian information criterion over single laws of a linear library (G. Schwarz, 1978).

Every equation counts as one observation, as if its noise were white.
"""

import numpy as np

from pipeline.blind_trial.baselines.answers import named, nothing
from pipeline.blind_trial.baselines.regression import equations
from pipeline.blind_trial.baselines.rig import read


def answer(folder):
    """The law of least criterion, none where the nominal model has it; stated shares are exp(-BIC / 2)."""
    rig = read(folder)
    regression = equations(rig, rig.runs)
    models = [(), *((term,) for term in regression.library)]
    values = np.array([criterion(regression, terms) for terms in models])
    share = np.exp(-(values - values.min()) / 2)
    share /= share.sum()
    if share.argmax() == 0:
        return nothing()
    shares = {terms[0]: value for terms, value in zip(models[1:], share[1:], strict=True)}
    return named(sorted(shares, key=shares.get, reverse=True), shares=shares)


def criterion(regression, terms):
    """n ln(mean square) + k ln n of Equations with ``terms``."""
    count = len(regression.target)
    left = regression.residual(terms)
    return count * np.log(max(left @ left, 1e-300) / count) + (regression.nominal.shape[1] + len(terms)) * np.log(count)

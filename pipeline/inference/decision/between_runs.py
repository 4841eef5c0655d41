"""Whether runs that no model explains together are each explained by the nominal one, at values of their own."""

import numpy as np
import scipy

from pipeline.inference.fitting.effective_sample_size import doubt
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued

#: p-value below which values of single runs are not one value
_DIFFERS = 1e-3


def told(problem, budget, null, uncertainty):
    """A sentence on the values that differ where each run alone, held-out ones as well, is what the nominal model
    predicts; '' where it is not, and where runs may differ already. ``null``: its Fit to the fitted ones.

    ``budget`` {run: Noise}. Raises what the forward model raises.
    """
    hypothesis = problem.nominal
    shared = np.flatnonzero(hypothesis.shared)
    runs = (*null.runs, *problem.held_out)
    if null.unordered or len(runs) < 2 or not len(shared) or any(p.of for p in hypothesis.parameters):
        return ""
    values, std = [], []
    for run in runs:
        begin = linearised(problem, (budget[run.name],), hypothesis, null.latent, (run,))
        alone = continued(problem, begin, patient=False)
        if alone.chi_square.sum() - alone.counts.sum() > doubt(alone.counts.sum(), uncertainty):
            return ""
        values.append(alone.latent[shared])
        std.append(np.sqrt(np.diag(alone.covariance(alone.weights)))[shared])
    weight = 1 / np.square(std)
    mean = np.sum(weight * values, axis=0) / weight.sum(axis=0)
    p_value = scipy.stats.chi2.sf(np.sum(weight * np.square(values - mean), axis=0), len(values) - 1)
    differing = [_difference(hypothesis.parameters[k], column) for k, column, p in
                 zip(shared, np.transpose(values), p_value, strict=True) if p < _DIFFERS / len(shared)]
    if not differing:
        return ""
    return (f"each run alone is what the nominal model predicts, at values that differ from run to run: "
            f"{', '.join(differing)}; if reassembly, temperature or wear may do that, state it by"
            " diagnosis.parameters.NAME.between_runs")


def _difference(parameter, latent):
    values = [parameter.prior.value(u) for u in latent]
    mean, std = float(np.mean(values)), float(np.std(values, ddof=1))
    unit = "" if parameter.unit == "1" else f" {parameter.unit}"
    size = f"{std / abs(mean):.2g}" if mean else f"{std:.2g}{unit}"
    return f"{parameter.name} from {min(values):.5g} to {max(values):.5g}{unit} (standard deviation {size})"

"""Whether the value of an effect changes along the runs: with time, or with how strongly the effect acts.

A law of another form than that which is fitted asks for another value where its motion is small or large, before and
after; so does one that ages. With s_k the whitened change of the prediction per relative change of value k, the columns

    s_k tau,   s_k alpha,      tau = time in -1 ... 1,   alpha = ln of the local size of s_k, in -1 ... 1 over all runs

are those of a value that follows time and size slowly. Their coefficients are linear in what is left: no fit is needed.
"""

from typing import NamedTuple

import numpy as np
import scipy

from pipeline.inference.regular import solved

#: stretches of a run over which the size of a change is averaged
_STRETCHES = 16
#: size of a column below which it is rounding
_LEAST = 1e-12
_FOLLOWED = ("time", "the size of the motion")


class Following(NamedTuple):
    """A value that follows ``what`` by ``change``, relative, from its middle to either end, ``deviate`` deviations."""

    what: str
    change: float
    deviate: float


def followed(fit, index, weights=None):
    """[Following] of parameter ``index`` of a Fit that has a null; empty for features and where it has no size.

    ``weights`` (runs,) of the runs (see ``tempering``).
    """
    parameter, latent = fit.hypothesis.parameters[index], fit.latent[index]
    slope = parameter.prior.slope(latent)
    if fit.unordered or not slope or parameter.null is None:
        return []
    relative = (parameter.prior.value(latent) - parameter.null) / slope
    columns = [relative * j[:, index] for j in fit.jacobians]
    if not relative or max(abs(c).max(initial=0.0) for c in columns) < _LEAST:
        return []
    root = np.sqrt(np.repeat(np.ones(len(fit.runs)) if weights is None else weights, fit.counts))
    shapes = np.array([_times(fit), _sizes(fit, columns)])
    extra = root[:, None] * (np.concatenate(columns) * shapes).T
    jacobian, residual = (root[:, None] * np.concatenate(fit.jacobians), root * np.concatenate(fit.residuals))
    return _coefficients(jacobian, extra, residual)


def _coefficients(jacobian, extra, residual):
    """[Following] of the columns ``extra`` (m, 2) beside a ``jacobian`` (m, k) whose values are free under priors."""
    inner = jacobian.T @ jacobian + np.eye(jacobian.shape[1])
    cleaned = extra - jacobian @ solved(inner, jacobian.T @ extra)
    information = extra.T @ cleaned
    seen = np.diag(information) > _LEAST * np.einsum("mk,mk->k", extra, extra)
    found = []
    for k in np.flatnonzero(seen):      # one at a time: time and size may go together
        change = float(cleaned[:, k] @ residual / information[k, k])
        found.append(Following(_FOLLOWED[k], change, float(abs(change) * np.sqrt(information[k, k]))))
    return found


def _times(fit):
    """(m,): time of every whitened sample, from -1 at the begin of its run to 1 at its end."""
    return np.concatenate([2 * np.nonzero(noise.usable)[1] / max(noise.usable.shape[1] - 1, 1) - 1
                           for noise in fit.noises])


def _sizes(fit, columns):
    """(m,): ln of the local size of a column, the range of all runs on -1 ... 1; what lies beyond counts as its end."""
    logs = [np.concatenate([_local(part) for part in noise.by_channel(column)])
            for noise, column in zip(fit.noises, columns, strict=True)]
    every = np.concatenate(logs)
    low, high = np.quantile(every, (0.1, 0.995))
    return np.clip(2 * (every - low) / max(high - low, _LEAST) - 1, -1, 1)


def _local(column):
    """ln of the root mean square of a column (m_c,) about every sample."""
    window = max(len(column) // _STRETCHES, 1)
    power = scipy.ndimage.uniform_filter1d(column**2, window, mode="nearest")
    return 0.5 * np.log(np.maximum(power, max(power.max(initial=0.0), _LEAST) * 1e-6))

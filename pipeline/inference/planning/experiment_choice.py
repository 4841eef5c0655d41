"""What to record next: the run whose outcome the hypotheses that are left expect most differently.

Box and Hill (Technometrics 9 (1967) 57): choose the conditions that maximise sum_ij p_i p_j KL(i || j) over the
Gaussian predictions of the hypotheses, N(mean, I + L L') in whitened samples, L = J times the root of the posterior
covariance.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.inference.regular import log_determinant, solved


@dataclass(frozen=True)
class Prediction:
    """Whitened ``mean`` (m,) and ``root`` (m, k) of the parameters' share of the covariance I + root root'."""

    mean: np.ndarray
    root: np.ndarray


@dataclass(frozen=True)
class Choice:
    """``index`` of the best conditions, the ``value`` (n,) of all in nats, and the pair it ``separates`` best."""

    index: int
    value: np.ndarray
    separates: tuple


def predicted(mean, jacobian, covariance):
    """Prediction from whitened ``mean`` (m,), ``jacobian`` (m, k) and the covariance (k, k) of its parameters."""
    values, vectors = np.linalg.eigh(covariance)
    return Prediction(np.asarray(mean, float), jacobian @ (vectors * np.sqrt(np.maximum(values, 0.0))))


def divergence(first, second):
    """KL(first || second) in nats of two Predictions, through matrices of the size of their parameters.

    1/2 [tr(S2^-1 S1) - m + (m1 - m2)' S2^-1 (m1 - m2) + ln det S2 - ln det S1],  S = I + L L'.
    """
    gap = first.mean - second.mean
    inner = np.eye(second.root.shape[1]) + second.root.T @ second.root
    back = solved(inner, second.root.T @ np.column_stack((gap, first.root)))
    cross = second.root.T @ first.root
    trace = np.sum(first.root**2) - np.sum(second.root * solved(inner, second.root.T).T) - np.sum(
        cross * back[:, 1:])
    square = gap @ gap - (second.root.T @ gap) @ back[:, 0]
    first_determinant = log_determinant(np.eye(first.root.shape[1]) + first.root.T @ first.root)
    return float(0.5 * (trace + square + log_determinant(inner) - first_determinant))


def choose(probability, predictions):
    """Choice among conditions: ``predictions`` [[Prediction of every hypothesis] of every condition].

    Raises ConfigError without conditions or with fewer than two hypotheses.
    """
    probability = np.asarray(probability, float)
    if not len(predictions) or len(probability) < 2:
        raise ConfigError("next experiment", "feasible conditions and at least two hypotheses",
                          f"{len(predictions)} conditions, {len(probability)} hypotheses")
    gains = np.array([_pairwise(probability, row) for row in predictions])
    value = gains.sum(axis=(1, 2))
    index = int(np.argmax(value))
    pair = np.unravel_index(np.argmax(gains[index] + gains[index].T), gains[index].shape)
    return Choice(index, value, tuple(sorted(int(i) for i in pair)))


def _pairwise(probability, row):
    return np.array([[p * q * divergence(a, b) if i != j else 0.0 for j, (q, b) in enumerate(zip(
        probability, row, strict=True))] for i, (p, a) in enumerate(zip(probability, row, strict=True))])

"""Verification on runs never fitted: errors before, recalibrated and after, against noise, and the gain."""

from dataclasses import dataclass

import numpy as np

from pipeline.inference.fitting.effective_sample_size import doubt, tempering
from pipeline.inference.fitting.least_squares import whitened
from pipeline.inference.fitting.noise import floor, normalised_error


@dataclass(frozen=True)
class Gain:
    """Decrease ``value`` of the squared whitened error from one model to another, and its standard error ``std``.

    ``excess``: squared error of the first model beyond noise (negative below it), over ``count`` samples.
    """

    value: float
    std: float
    excess: float
    count: int

    def powered(self, uncertainty):
        """Whether the first model errs beyond noise and the doubt about it, so that there is something to gain."""
        return self.excess > doubt(self.count, uncertainty)

    def with_fitted(self, first, second):
        """The gain over all runs: that on the runs from which the Fits ``first`` and ``second`` come joins it."""
        count = first.counts.sum()
        return Gain(self.value + second.explains(first), self.std, self.excess + first.chi_square.sum() - count,
                    self.count + int(count))

    @property
    def errors(self):
        """The gain in standard errors."""
        return self.value / self.std if self.std > 0 else 0.0

    @property
    def share(self):
        """The gain as a share of the excess error (1 where there is no excess but a gain)."""
        return self._share(self.value)

    @property
    def share_at_most(self):
        """The share of the excess error that the gain may be, a standard error allowed for."""
        return self._share(self.value + self.std)

    def left(self, uncertainty):
        """Share of the excess error that the second model leaves beyond doubt, the power of noise known as well."""
        return self._beyond(uncertainty) / max(self.excess, self.value, 1e-300)

    def growth(self, power, uncertainty):
        """Mean squared error of the second model, less that doubt, over the ``power`` that it leaves where fitted."""
        return (1 + self._beyond(uncertainty) / max(self.count, 1)) / max(power, 1.0)

    def _beyond(self, uncertainty):
        """Squared error of the second model beyond noise and the doubt about it."""
        return max(self.excess - self.value - doubt(self.count, uncertainty), 0.0)

    def _share(self, value):
        return value / max(self.excess, value) if value > 0 else 0.0

    def errors_with(self, left_out):
        """The gain in standard errors together with gains in log predictive density (point,) of left-out points.

        A gain g in log density is one of 2 g in squared error, which varies by sqrt(8 g) as the other gains do.
        """
        variance = self.std**2 + 8 * np.abs(left_out).sum()
        return float((self.value + 2 * np.sum(left_out)) / np.sqrt(variance)) if variance > 0 else 0.0


@dataclass(frozen=True)
class Errors:
    """Root mean NRMSE over runs: with nominal values, recalibrated, completed; and what noise alone leaves.

    Of each run ``predicted`` {name: (3, c, n)} and the NRMSE ``by_run`` {name: (4,)}, in that order.
    """

    before: float
    recalibrated: float
    after: float
    noise_floor: float
    runs: tuple
    predicted: dict
    by_run: dict


def gain(noises, first, second):
    """Gain from whitened residuals ``first`` [(m_r,)] to ``second`` of the same runs.

    With s their difference, sum first^2 - sum second^2 = sum s (first + second) varies by 2 |s| where ``second`` is
    white noise; residue beyond noise and correlation widen it by the run's tempering (see ``effective.tempering``).
    """
    weights = tempering(noises, second)
    change = [a @ a - b @ b for a, b in zip(first, second, strict=True)]
    variance = [4 * (a - b) @ (a - b) / w for a, b, w in zip(first, second, weights, strict=True)]
    count = sum(len(a) for a in first)
    excess = sum(a @ a for a in first) - count
    return Gain(float(sum(change)), float(np.sqrt(sum(variance))), float(excess), count)


def held_out_residuals(problem, noises, fit, runs):
    """Whitened residuals [(m_r,)] of a Fit's values on runs it has not seen; raises what the forward model raises."""
    residuals, error = whitened(problem, noises, fit.hypothesis, fit.latent, runs)
    if error:
        raise error
    return residuals


def errors(problem, budget, nominal, null, best, runs):
    """Errors over ``runs`` of the Fits ``null`` and ``best``, and of hypothesis ``nominal`` at its given values."""
    models = ((nominal, nominal.nominal), (null.hypothesis, null.latent), (best.hypothesis, best.latent))
    predicted = {run.name: np.array([problem.predict(h, h.values(latent), run) for h, latent in models], float)
                 for run in runs}
    by_run = {run.name: np.array([*(normalised_error(run, run.samples - p) for p in predicted[run.name]),
                                  floor(run, budget[run.name])]) for run in runs}
    means = [_root_mean([by_run[run.name][k] for run in runs]) for k in range(4)]
    return Errors(*means, tuple(run.name for run in runs), predicted, by_run)


def _root_mean(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else float("nan")

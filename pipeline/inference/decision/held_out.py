"""Verification on runs never fitted: errors before, recalibrated and after, against noise, and the gain.

Where a run begins in a state that nobody knows, every model fits it to the first part of the run; the rest is judged.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.inference.fitting.effective_sample_size import doubt, tempering
from pipeline.inference.fitting.fit_state import whitened
from pipeline.inference.fitting.noise import floor, normalised_error
from pipeline.inference.fitting.run_parameters import first_part, with_own_parameters


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
    def error(self):
        """Root mean square whitened error of the second model: 1 is noise alone."""
        return float(np.sqrt(max(self.excess + self.count - self.value, 0.0) / max(self.count, 1)))

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


def judged(problem, noises, runs, share):
    """[Noise] of the part of held-out ``runs`` that is judged: all, or what follows the first ``share`` of a run whose
    own parameters are fitted to that."""
    return tuple(noise.beyond(first_part(problem, noise, run, share))
                 for noise, run in zip(noises, runs, strict=True))


def held_out_residuals(problem, noises, fit, runs, share=1.0):
    """Whitened residuals [(m_r,)] of a Fit's values on the judged part of runs it has not seen.

    Raises what the forward model raises.
    """
    latent = with_own_parameters(problem, noises, fit.hypothesis, fit.latent, runs, share)
    residuals, error = whitened(problem, judged(problem, noises, runs, share), fit.hypothesis, latent, runs)
    if error:
        raise error
    return residuals


def errors(problem, budget, nominal, null, best, runs, share=1.0):
    """Errors over ``runs`` of the Fits ``null`` and ``best``, and of hypothesis ``nominal`` at its given values.

    Of held-out runs over the part that is judged.
    """
    models = ((nominal, nominal.nominal), (null.hypothesis, null.latent), (best.hypothesis, best.latent))
    noises, held_out = [budget[run.name] for run in runs], [run for run in runs if run.held_out]
    begins = [budget[run.name] for run in held_out]
    models = [(h, h.values(with_own_parameters(problem, begins, h, latent, held_out, share))) for h, latent in models]
    predicted = {run.name: np.array([problem.shown(h, h.in_run(values, run.name), run) for h, values in models], float)
                 for run in runs}
    seen = [_from(run, first_part(problem, noise, run, share) * run.held_out)
            for run, noise in zip(runs, noises, strict=True)]
    by_run = {run.name: np.array([*(normalised_error(run, run.samples - p) for p in predicted[run.name]),
                                  floor(run, budget[run.name])]) for run in seen}
    means = [_root_mean([by_run[run.name][k] for run in runs]) for k in range(4)]
    return Errors(*means, tuple(run.name for run in runs), predicted, by_run)


def _from(run, first):
    """An Observed run whose samples before number ``first`` do not count."""
    return replace(run, valid=run.valid & (np.arange(run.samples.shape[1]) >= first)) if first else run


def _root_mean(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else float("nan")

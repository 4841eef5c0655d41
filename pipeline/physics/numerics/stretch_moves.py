"""Sampling of a density whose evaluations are dear; seeded."""

import numpy as np


def stretch_samples(log_density, walkers, lower, upper, sweeps, seed):
    """Samples (sweeps * w, n) of a density by stretch moves (Goodman & Weare, CAMCoS 5 (2010) 65), scale 2.

    ``walkers`` (w, n) start within ``lower`` and ``upper``, outside of which the density is 0. Blind to linear changes
    of the parameters; samples of neighbouring sweeps depend on one another.
    """
    random = np.random.default_rng(seed)
    points = np.array(walkers, float)
    density = np.array([log_density(point) for point in points])
    kept = []
    for _ in range(sweeps):
        for i in range(len(points)):
            j = (i + 1 + random.integers(len(points) - 1)) % len(points)
            stretch = (random.random() * (np.sqrt(2) - np.sqrt(0.5)) + np.sqrt(0.5)) ** 2
            trial = points[j] + stretch * (points[i] - points[j])
            if np.any(trial < lower) or np.any(trial > upper):
                continue
            value = log_density(trial)
            if np.log(random.random()) < (len(lower) - 1) * np.log(stretch) + value - density[i]:
                points[i], density[i] = trial, value
        kept.append(points.copy())
    return np.concatenate(kept)

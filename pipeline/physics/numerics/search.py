"""Search and sampling where each evaluation is dear, noisy or without derivatives; seeded."""

from dataclasses import dataclass

import numpy as np

#: share of the bounds by which every trial of the evolution is shaken
_SHAKE = 0.002


@dataclass(frozen=True)
class Evolved:
    """``best`` (n,), its ``cost``, the last ``population`` (p, n) with ``costs`` (p,), and the evaluations spent."""

    best: np.ndarray
    cost: float
    population: np.ndarray
    costs: np.ndarray
    evaluations: int


def evolve(cost, population, lower, upper, generations, seed):
    """Differential evolution (Storn & Price, J. Global Optim. 11 (1997) 341), current to best, of a start population.

    ``cost`` (n,) -> float; ``population`` (p, n) within ``lower`` and ``upper`` (n,). A trial replaces its parent where
    it costs less, so that a cost never rises.
    """
    random = np.random.default_rng(seed)
    points = np.clip(population, lower, upper)
    costs = np.array([cost(point) for point in points])
    for _ in range(generations):
        for i in range(len(points)):
            first, other = random.choice(len(points), 2, replace=False)
            trial = points[i] + random.uniform(0.3, 0.9) * (points[first] - points[other])
            if random.random() < 0.5:
                trial = trial + random.uniform(0.0, 0.6) * (points[np.argmin(costs)] - points[i])
            trial = np.clip(trial + _SHAKE * (upper - lower) * random.standard_normal(len(lower)), lower, upper)
            value = cost(trial)
            if value < costs[i]:
                points[i], costs[i] = trial, value
    best = int(np.argmin(costs))
    return Evolved(points[best].copy(), float(costs[best]), points, costs, len(points) * (generations + 1))


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

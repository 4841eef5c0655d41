"""Probability of squeal with and without a countermeasure, by the draws of both.

Draws of a variant are those of the case where it has as many: the same seed and sources. What a draw has in common with
its counterpart then narrows the interval of the change.
"""

import numpy as np

from pipeline.physics.stability.draw_statistics import rate_change


def squealing_draws(probability):
    """(draw, operating point): whether a draw of a product Probability squeals there."""
    hits = np.zeros((len(probability.value), len(probability.speed)), bool)
    squeals = abs(probability.root) >= 2 * np.pi * float(probability.squeal_from)
    hits[probability.root_draw[squeals], probability.root_operating[squeals]] = True
    return hits


def paired(base, other):
    """Whether two products Probability have the same draws."""
    return len(base.value) == len(other.value) > 0 and list(base.source) == list(other.source)


def changes_of_rates(base, other):
    """(change (o + 1,), interval (o + 1, 2)) of the share of squealing draws from one product Probability to another:
    at each operating point, and last at any of them."""
    same = paired(base, other)
    before, after = (np.column_stack((hits, hits.any(axis=1))) for hits in map(squealing_draws, (base, other)))
    made = [rate_change(*hits, same) for hits in zip(before.T, after.T, strict=True)]
    return np.array([change for change, _ in made]), np.array([interval for _, interval in made])

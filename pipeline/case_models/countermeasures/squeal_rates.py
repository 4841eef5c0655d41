"""Probability of squeal with and without a countermeasure, by the draws of both.

Draws of a variant are those of the case where it has as many: the same seed and sources. What a draw has in common with
its counterpart then narrows the interval of the change.
"""

import numpy as np

from pipeline.physics.stability.draws.draw_statistics import among_bands, rate_change, squealing


def squealing_draws(probability):
    """(draw, operating point): whether a draw of a product Probability squeals there."""
    return squealing(probability.root, probability.root_draw, probability.root_operating,
                     (len(probability.value), len(probability.speed)), float(probability.squeal_from))


def paired(base, other):
    """Whether two products Probability have the same draws, as far as the one of fewer goes."""
    return min(len(base.value), len(other.value)) > 0 and int(base.most_draws) == int(other.most_draws) \
        and list(base.source) == list(other.source)


def changes_of_rates(base, other):
    """(change (o + 1,), interval (o + 1, 2)) of the share of squealing draws from one product Probability to another:
    at each operating point, and last at any of them."""
    before, after = (np.column_stack((hits, hits.any(axis=1))) for hits in map(squealing_draws, (base, other)))
    made = [rate_change(*hits, paired(base, other)) for hits in _common(base, other, before, after)]
    return np.array([change for change, _ in made]), np.array([interval for _, interval in made])


def changes_in_bands(base, other):
    """(share (b,), interval (b, 2)): draws of ``other`` with an unstable mode in each 1/3 octave of a product
    Probability ``base`` at any operating point, and the 95 % interval of the change."""
    before, after = (_in_bands(each, base.band) for each in (base, other))
    ends = [rate_change(*hits, paired(base, other))[1] for hits in _common(base, other, before, after)]
    return after.mean(axis=0), np.reshape(ends, (len(base.band), 2))


def _common(base, other, before, after):
    """Pairs of hits (draw,) of every column of ``before`` and ``after``; of paired draws those that both have."""
    count = min(len(before), len(after)) if paired(base, other) else None
    return zip(before[:count].T, after[:count].T, strict=True)


def _in_bands(probability, middles):
    """(draw, band): whether a draw has an unstable mode in it at any operating point."""
    hits = np.zeros((len(probability.value), len(middles)), bool)
    hits[probability.root_draw, among_bands(probability.root, middles)] = True
    return hits

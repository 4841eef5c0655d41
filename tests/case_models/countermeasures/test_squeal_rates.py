"""Probabilities before and after: hits as the product counts them, pairs of draws."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.countermeasures.squeal_rates import (
    changes_in_bands,
    changes_of_rates,
    paired,
    squealing_draws,
)
from tests.views import products_for_views as small


@pytest.fixture
def base():
    return small.probability()


def without(product, share):
    """The product without the first ``share`` of its unstable roots."""
    kept = slice(int(share * len(product.root)), None)
    return replace(product, root=product.root[kept], root_draw=product.root_draw[kept],
                   root_operating=product.root_operating[kept], root_residual=product.root_residual[kept])


def test_hits_are_those_of_the_probabilities(base):
    np.testing.assert_allclose(squealing_draws(base).mean(axis=0), base.probability)
    low = replace(base, root=base.root.real + 1j)       # below squeal: nothing counts
    assert not squealing_draws(low).any()


def test_changes_of_paired_draws(base):
    other = without(base, 0.5)
    change, interval = changes_of_rates(base, other)
    expected = squealing_draws(other).mean(axis=0) - squealing_draws(base).mean(axis=0)
    np.testing.assert_allclose(change[:-1], expected)
    assert len(change) == len(base.speed) + 1 and change[-1] < 0
    assert (interval[:, 0] <= change).all() and (change <= interval[:, 1]).all()
    same, ends = changes_of_rates(base, base)
    assert not same.any() and (ends[:, 0] <= 0).all() and (ends[:, 1] >= 0).all()


def test_other_draws_are_not_paired(base):
    fewer = small.probability(draws=30)
    assert paired(base, base) and not paired(base, fewer)
    wide = changes_of_rates(base, fewer)[1]
    assert np.diff(wide)[-1] > np.diff(changes_of_rates(base, base)[1])[-1]


def test_bands_are_those_of_the_product(base):
    """All roots are of 8 kHz: half of them less, and none in another band."""
    share, interval = changes_in_bands(base, without(base, 0.5))
    here = np.argmin(abs(base.band - 8e3))
    assert 0 < share[here] < squealing_draws(base).any(axis=1).mean() and not np.delete(share, here).any()
    assert interval[here, 1] < 0 and (interval[:here, 0] <= 0).all()

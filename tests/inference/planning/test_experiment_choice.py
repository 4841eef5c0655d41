"""The next experiment: the divergence of normal laws in closed form, and the conditions that separate."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.inference.planning.experiment_choice import Prediction, choose, divergence, predicted


def random_prediction(seed, size=12, rank=3):
    generator = np.random.default_rng(seed)
    return Prediction(generator.standard_normal(size), generator.standard_normal((size, rank)))


def dense_divergence(first, second):
    own, other = (np.eye(len(p.mean)) + p.root @ p.root.T for p in (first, second))
    gap, inverse = first.mean - second.mean, np.linalg.inv(other)
    return 0.5 * (np.trace(inverse @ own) - len(gap) + gap @ inverse @ gap
                  + np.linalg.slogdet(other)[1] - np.linalg.slogdet(own)[1])


@pytest.mark.exact
@pytest.mark.parametrize("seed", range(4))
def test_the_divergence_is_that_of_dense_matrices(seed):
    first, second = random_prediction(seed), random_prediction(seed + 50, rank=2)
    assert divergence(first, second) == pytest.approx(dense_divergence(first, second), rel=1e-10)
    assert divergence(first, first) == pytest.approx(0.0, abs=1e-10)


@pytest.mark.exact
def test_sure_predictions_differ_by_half_the_squared_distance():
    sure = [predicted(mean, np.zeros((3, 1)), np.eye(1)) for mean in ([0, 0, 0], [3, 0, 4])]
    assert divergence(*sure) == pytest.approx(12.5)


@pytest.mark.exact
def test_the_root_carries_the_covariance_of_the_parameters():
    jacobian, covariance = np.array([[1.0, 2.0], [0.5, -1.0], [3.0, 0.0]]), np.array([[2.0, 0.7], [0.7, 1.0]])
    root = predicted(np.zeros(3), jacobian, covariance).root
    np.testing.assert_allclose(root @ root.T, jacobian @ covariance @ jacobian.T, atol=1e-12)


def test_the_run_that_separates_is_chosen_and_its_pair_told():
    def row(*levels):
        return [predicted(np.full(5, level), np.ones((5, 1)) * 0.1, np.eye(1)) for level in levels]

    told = choose([0.5, 0.45, 0.05], [row(1.0, 1.0, 4.0), row(1.0, 4.0, 1.0), row(1.0, 1.0, 1.0)])
    assert told.index == 1 and told.separates == (0, 1)
    np.testing.assert_allclose(told.value[2], 0.0, atol=1e-12)
    assert told.value[1] > told.value[0] > 0


def test_what_hypotheses_may_absorb_does_not_separate_them():
    free = [predicted(np.full(5, level), 100 * np.ones((5, 1)), np.eye(1)) for level in (0.0, 3.0)]
    fixed = [predicted(np.full(5, level), np.zeros((5, 1)), np.eye(1)) for level in (0.0, 3.0)]
    assert choose([0.5, 0.5], [free, fixed]).index == 1


def test_nothing_to_choose_is_refused():
    with pytest.raises(ConfigError, match="feasible conditions and at least two hypotheses"):
        choose([1.0], [])

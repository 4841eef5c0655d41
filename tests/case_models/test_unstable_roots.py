"""Roots that grow or nearly do, in the whole model; stage complex_modes compares them with dense algebra."""

from types import SimpleNamespace

import numpy as np

from pipeline.case_models.unstable_roots import in_whole_model, nearly
from pipeline.physics.sliding.model import sliding_model
from tests.stages.small_oscillator import small_oscillator

SETTINGS = SimpleNamespace(frequency_max=1000.0)


def test_roots_within_a_small_decay_and_the_frequency_limit_are_nearly_unstable():
    roots = np.array([1.0 + 100j, -0.04 + 100j, -0.06 + 100j, 1.0 + 7000j, 5.0 + 0j])
    assert nearly(roots, SETTINGS).tolist() == [True, True, False, False, True]


def test_hard_contacts_and_roots_that_do_not_oscillate_leave_all_as_it_is():
    model = sliding_model(small_oscillator(hard=True), 0, 1.0)
    roots, shapes = np.array([1.0 + 100j, 2.0]), np.ones((model.size, 2), complex)
    assert in_whole_model(model, None, roots, shapes, SETTINGS) == (roots, shapes)
    soft = sliding_model(small_oscillator(), 0, 1.0)
    assert in_whole_model(soft, None, roots[1:], shapes[:, 1:], SETTINGS)[0].tolist() == [2.0]

"""Orders are told from tones of constant frequency, from noise and from resonances in it."""

import numpy as np
import pytest
import scipy

from pipeline.physics.signals.orders.order_tracking import smooth, track
from pipeline.physics.signals.orders.outstanding_orders import strongest
from tests.physics.signals.orders.ramp import LAST, RATE, T, order, ramp, tracked


@pytest.mark.exact
@pytest.mark.parametrize("frequency", [11.0, 60.0, 200.0, 450.0])
def test_a_tone_of_constant_frequency_is_no_order(frequency):
    orders = tracked(np.cos(2 * np.pi * frequency * T))
    assert not len(strongest(orders, 6).order)


@pytest.mark.exact
def test_orders_are_told_beside_tones_noise_and_what_is_above():
    """What lies above the highest order is not folded onto others."""
    random = np.random.default_rng(2)
    beside = np.cos(2 * np.pi * 40.0 * T) + 0.3 * random.standard_normal(len(T)) + order(61.0, 2.0)
    found = strongest(tracked(beside + order(1.0) + order(10.0, 0.5)), 6)
    np.testing.assert_allclose(found.order, [1.0, 10.0], atol=0.02)
    assert found.sure.all() and found.amplitude[1].mean() == pytest.approx(0.5, rel=0.02)
    folded = tracked(order(61.0, 2.0))
    assert folded.amplitude.max() < 0.01


@pytest.mark.exact
def test_an_order_that_a_tone_could_pass_for_is_marked():
    """Over a speed that varies by a fifth the tenth order moves by sixteen lines, the second by three."""
    part = T < 4.5
    orders = track(smooth((order(10.0) + order(2.0, 2.0))[part], RATE, 0.0, 500.0), ramp(), 20.0, 8, LAST)
    found = strongest(orders, 6)
    np.testing.assert_allclose(found.order, [2.0, 10.0], atol=0.02)
    assert found.sure.tolist() == [False, True]


def test_noise_alone_has_no_orders_nor_has_a_resonance_in_it():
    for pole in (0.0, *(size * np.exp(2j * np.pi * 60.0 / RATE) for size in (0.998, 0.9995))):
        noises = [np.random.default_rng(k).standard_normal(len(T)) for k in range(12)]
        rung = [scipy.signal.lfilter([1.0], np.poly([pole, np.conj(pole)]).real, noise) for noise in noises]
        assert sum(len(strongest(tracked(samples), 6).order) for samples in rung) <= 1

"""What the loop reads and sums."""

import numpy as np
import pytest

from pipeline.physics.time_stepping.simulate import Hard, History, simulate
from tests.physics.lumps import lumps, random_structure


@pytest.mark.exact
def test_input_work_and_damping_loss_of_an_oscillator():
    """Driven at resonance after settling: per second the force F puts in, and the damper takes, F^2 / (2 c)."""
    model, time = lumps([1.0], [[1.0]], [1e4], [10.0]), np.linspace(0, 4, 80001)
    motion = simulate(model, Hard(), step=1e-4, duration=4.0, inputs=History(3 * np.cos(100 * time), time[1]))
    late = motion.time >= 4 - 20 * 2 * np.pi / 100
    seconds = np.ptp(motion.time[late])
    for energy in (motion.input_work, motion.damping_loss):
        assert np.ptp(energy[late]) / seconds == pytest.approx(9 / 20, rel=2e-3)
    assert motion.imbalance < (100 * 1e-4) ** 2 / 10      # of the trapezoidal rule of the loss


def test_books_can_be_left_out():
    model = random_structure(6, 2e3)
    with_books, without = (simulate(model, Hard(), step=1e-5, duration=0.01, inputs=[5.0], book=book)
                           for book in (True, False))
    np.testing.assert_array_equal(with_books.displacement, without.displacement)
    assert with_books.damping_loss[-1] > 0 == without.damping_loss[-1]
    assert with_books.stored.max() > 0 == without.stored.max()


def test_the_same_run_gives_the_same_bits():
    model = random_structure(20, 4e3, contacts=2)
    first, second = (simulate(model, Hard(), step=1e-5, duration=0.02, inputs=[5.0]) for _ in range(2))
    np.testing.assert_array_equal(first.velocity, second.velocity)

"""Poles of free vibration: sums of known exponentials are found with the accuracy that their Jacobian tells."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.pole_identification import (
    Poles,
    before_saturation,
    confirmed,
    fundamental,
    likeness,
    matched,
    poles,
    steady_poles,
)

RATE = 10240.0
ROOT = np.array([-12 + 2j * np.pi * 310, -9 + 2j * np.pi * 611, -9 + 2j * np.pi * 617, 40 + 2j * np.pi * 1502.5])
SHAPE = np.array([[1, 0.3j], [0.8, -0.5], [0.7, 0.9], [0.02, 0.05j]])


def record(noise, seed=0, seconds=0.25, root=ROOT, shape=SHAPE, rate=RATE):
    time = np.arange(round(seconds * rate)) / rate
    clean = (shape.T @ np.exp(np.outer(root, time))).real
    return clean + noise * np.random.default_rng(seed).standard_normal(clean.shape)


@pytest.mark.exact
def test_exponentials_without_noise_are_found_exactly():
    found = poles(record(0.0), RATE, 200.0, 2000.0)
    close = found.of([int(np.argmin(abs(found.root - r))) for r in ROOT])
    np.testing.assert_allclose(close.root, ROOT, atol=1e-3)
    np.testing.assert_allclose(np.diag(likeness(close.shape, SHAPE)), 1.0, atol=1e-6)


def test_noise_moves_poles_by_their_standard_deviations():
    left = []
    for seed in range(12):
        found = poles(record(1e-3, seed), RATE, 200.0, 2000.0)
        pairs = matched(Poles(ROOT, np.ones(4), SHAPE.astype(complex)), found, 0.008, 0.8)
        assert len(pairs) == 4
        left.append([(found.root[j] - ROOT[i]) / found.std[j] for i, j in pairs])
    size = np.mean(abs(np.array(left)) ** 2) / 2          # real and imaginary part, one each
    assert 0.5 < size < 3.0


def test_what_only_one_record_shows_does_not_count():
    alone = -20 + 2j * np.pi * 1100
    one = poles(record(1e-3, 1, root=np.append(ROOT, alone), shape=np.vstack((SHAPE, [0.5, 0.5]))), RATE, 200., 2000.)
    other = poles(record(1e-3, 2), RATE, 200.0, 2000.0)
    both = confirmed(one, other)
    assert abs(one.root - alone).min() < 1 and abs(both.root - alone).min() > 1000
    assert len(both.root) == 4 and np.all(both.std < 2 * other.std.max())


def test_records_that_differ_make_a_pole_less_certain():
    one = Poles(ROOT, np.full(4, 0.1), SHAPE.astype(complex))
    both = confirmed(one, Poles(ROOT + np.array([0, 0, 0, 3.0]), one.std, one.shape))
    np.testing.assert_allclose(both.std, [*np.full(3, 0.1 / np.sqrt(2)), 1.5], rtol=1e-12)


@pytest.mark.exact
def test_sums_of_growing_poles_are_not_poles():
    """(a + b, a + b*) of a growing a; sums of decaying ones may be modes of their own."""
    grows, decays = np.array([8 + 2j * np.pi * 385, -20 + 2j * np.pi * 1134])
    tones = np.array([grows + decays, 2 * grows, np.conj(grows + decays.conj())])
    every = np.concatenate(([grows, decays, 2 * decays], tones))
    left = fundamental(Poles(every, np.ones(6), np.ones((6, 2))))
    np.testing.assert_array_equal(left.root, every[:3])


def test_a_faint_pole_in_frequency_and_decay_of_two_others_is_their_tone():
    one, other = -50 + 2j * np.pi * 1114, -21 + 2j * np.pi * 2241
    root = np.array([one, other, other + one.conjugate() + 0.4j, one + other + 30])
    size, std = np.array([1.0, 0.4, 0.02, 0.02]), np.full(4, 0.3)
    np.testing.assert_array_equal(fundamental(Poles(root, std, size[:, None] * np.ones(2))).root, root[[0, 1, 3]])
    assert len(fundamental(Poles(root, std, np.ones((4, 2)))).root) == 4, "tones are fainter than what they come from"


def test_a_pole_is_known_as_well_as_two_beginnings_of_a_record_agree():
    """One that fades beside others, of which one fades too fast to be told."""
    root = np.array([-7 + 2j * np.pi * 1010, -122 + 2j * np.pi * 990, -460 + 2j * np.pi * 1191])
    shape = np.array([[1, 0.01, 0.01], [0.08, 0.3, 0.3], [0.08, 0.35, 0.35j]])
    samples = record(0.012, 1, root=root, shape=shape, rate=25600.0)
    at_once, steady = (find(samples, 25600.0, 250.0, 4600.0) for find in (poles, steady_poles))
    apart = [[abs(found.root - r).min() / found.std[abs(found.root - r).argmin()] for r in root[:2]]
             for found in (at_once, steady)]
    assert apart[0][1] > 5 and max(apart[1]) < 3
    short = samples[:, :340]
    np.testing.assert_array_equal(steady_poles(short, 25600.0, 250.0, 4600.0).std,
                                  poles(short, 25600.0, 250.0, 4600.0).std)


def test_growth_is_free_until_a_share_of_its_largest():
    time = np.arange(4096) / RATE
    growth = np.minimum(1e-3 * np.exp(40 * time), 1.0) * np.sin(2 * np.pi * 900 * time)
    count = before_saturation(growth[None], RATE)
    assert 0.09 < np.exp(40 * time[count]) * 1e-3 < 0.14
    assert before_saturation(growth[None, ::-1], RATE) == 4096, "a decay is free from the first sample on"


def test_a_flow_of_two_shapes():
    np.testing.assert_allclose(likeness(np.array([[1, 1j]]), np.array([[1j, -1], [1, -1j], [0, 0]])), [[1, 0, 0]],
                               atol=1e-12)


@pytest.mark.parametrize("turn", [0.0, 1.0, 2.0, 3.0])
def test_what_saturates_at_the_end_of_a_growth_does_not_move_what_decays(turn):
    """A third of saturation at the end: by its squares alone the record would put the decay 1 to 1.4 Hz too low."""
    root = 2j * np.pi * np.array([2257.8, 2268.7, 2269.2]) + np.array([-22.7, -217.0, 162.0])
    size = np.array([1.4e-5, -5e-5 * np.exp(1j * turn), 1e-4])
    shape = size[:, None] * np.array([[1, 0.2], [0.05, 1], [0.05, 1]])
    free = record(0.0, rate=25600.0, seconds=0.032, root=root, shape=shape)
    seen = 0.05 * np.tanh(free / 0.05) + 5e-7 * np.random.default_rng(0).standard_normal(free.shape)
    found = poles(seen, 25600.0, 250.0, 4600.0).root
    assert abs(found.imag / (2 * np.pi) - 2257.8).min() < 0.7
    assert abs(found.imag / (2 * np.pi) - 2269.2).min() < 0.3


def test_distortion_that_begins_faint_is_no_pole():
    """The third power of a growing motion has a pole at its frequency and thrice its growth, and one at the triple."""
    time = np.arange(round(0.25 * RATE)) / RATE
    x = 1e-4 * np.exp((20 + 2j * np.pi * 400) * time).real
    clean = np.array([[1.0], [0.7]]) * (x - 300 * x**3)
    found = poles(clean, RATE, 200.0, 2000.0)
    assert len(found.root) == 1 and abs(found.root[0] - (20 + 2j * np.pi * 400)) < 0.1


@pytest.mark.parametrize("samples", [np.zeros((1, 4000)), np.eye(1, 4000)], ids=["dead", "one spike"])
def test_records_without_a_motion_have_no_poles(samples):
    found = poles(samples, 1000.0, 50.0, 400.0)
    assert not len(found.root) and not len(found.std) and found.shape.shape == (0, 1)


@pytest.mark.parametrize("samples, low, high", [(4096, 200.0, 6000.0), (4096, 500.0, 200.0), (64, 200.0, 900.0)])
def test_impossible_records_are_refused(samples, low, high):
    with pytest.raises(ConfigError):
        poles(np.ones((1, samples)), RATE, low, high)

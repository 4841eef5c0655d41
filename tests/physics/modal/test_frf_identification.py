"""Modes from frequency responses: doublets, honest errors, quantities, noise alone."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.frf_identification import identify

ANGLE = np.arange(12) * 2 * np.pi / 12 + 0.1


def disc(split=1e-3, damping=1e-3):
    """(frequencies in Hz, damping ratios, shapes (m, 12)) of a disc: two doublets, and a mode of no diameter."""
    frequency, shape = [], []
    for diameters, base in ((2, 1200.0), (3, 1700.0)):
        frequency += [base, base * (1 + split)]
        shape += [np.cos(diameters * ANGLE), np.sin(diameters * ANGLE)]
    return np.array([*frequency, 1450.0]), np.full(5, damping), np.array([*shape, 0.7 * np.ones(12)])


def responses(line, frequency, damping, shape, kind=2):
    """Receptance (0), mobility (1) or accelerance (2) of unit modal masses, driven at the first point."""
    omega, natural = 2 * np.pi * line, 2 * np.pi * frequency
    modal = 1.0 / (natural[:, None] ** 2 - omega**2 + 2j * (damping * natural)[:, None] * omega)
    return np.einsum("mo,mf->of", shape * shape[:, :1], modal) * (1j * omega) ** kind


def noisy(response, share, random):
    size = share * np.sqrt(np.mean(abs(response) ** 2, axis=1, keepdims=True) / 2)
    return response + size * (random.standard_normal(response.shape) + 1j * random.standard_normal(response.shape))


def mac(one, other):
    return abs(np.vdot(one, other)) ** 2 / (np.vdot(one, one) * np.vdot(other, other)).real


LINE = np.arange(1000.0, 2000.1, 0.5)
WITHIN = LINE[(LINE >= 1150) & (LINE <= 1750)]


@pytest.mark.exact
@pytest.mark.parametrize("kind", [0, 1, 2])
def test_without_noise_modes_are_exact(kind):
    frequency, damping, shape = disc()
    found = identify(LINE, responses(LINE, frequency, damping, shape, kind))
    order = np.argsort(frequency)
    np.testing.assert_allclose(found.frequency, frequency[order], rtol=1e-7)
    np.testing.assert_allclose(found.damping_ratio, damping[order], rtol=1e-4)
    assert min(mac(*pair) for pair in zip(found.residue, shape[order], strict=True)) > 1 - 1e-8


@pytest.mark.parametrize("split", [1e-3, 5e-4])
def test_doublets_in_noise_of_a_percent(split):
    """Frequency to .1 %, damping to 10 %, MAC above .98."""
    frequency, damping, shape = disc(split)
    found = identify(LINE, noisy(responses(LINE, frequency, damping, shape), 0.01, np.random.default_rng(1)))
    order = np.argsort(frequency)
    np.testing.assert_allclose(found.frequency, frequency[order], rtol=1e-5)
    np.testing.assert_allclose(found.damping_ratio, damping[order], rtol=0.03)
    assert min(mac(*pair) for pair in zip(found.residue, shape[order], strict=True)) > 0.98


def covered(draws, line=LINE):
    """Shares of the frequencies and of the damping ratios within two standard deviations of the truth (1.96)."""
    frequency, damping, shape = disc()
    order, clean = np.argsort(frequency), responses(line, frequency, damping, shape)
    inside = []
    for draw in range(draws):
        found = identify(line, noisy(clean, 0.01, np.random.default_rng(draw)))
        inside.append([abs(found.frequency - frequency[order]) < 1.96 * found.frequency_std,
                       abs(found.damping_ratio - damping[order]) < 1.96 * found.damping_ratio_std])
    return np.mean(inside, axis=(0, 2))


def test_stated_errors_hold():
    assert np.all(covered(12, WITHIN) > 0.85)       # 60 values each: .95 +- .03


@pytest.mark.slow
@pytest.mark.study
def test_stated_errors_hold_in_two_hundred_draws():
    share = covered(200)
    assert np.all((share > 0.90) & (share < 0.98)), share


def test_a_plate_of_twelve_modes_beyond_the_band_too():
    """Simply supported, its points 4 x 5; the modes below and above the band are in the responses as well."""
    x, y = np.meshgrid(np.linspace(0.1, 0.85, 5), np.linspace(0.15, 0.8, 4))
    numbers = [(m, n) for m in range(1, 7) for n in range(1, 6)]
    frequency = np.array([60.0 * (m**2 + 1.37 * n**2) for m, n in numbers])
    shape = np.array([(np.sin(np.pi * m * x) * np.sin(np.pi * n * y)).ravel() for m, n in numbers])
    damping, line = np.full(len(frequency), 0.004), np.arange(200.0, 1400.1, 0.5)
    clean = responses(line, frequency, damping, shape)
    found = identify(line, noisy(clean, 0.01, np.random.default_rng(3)))
    inside = np.sort(frequency[(frequency > 210) & (frequency < 1390)])
    np.testing.assert_allclose(found.frequency, inside, rtol=1e-3)
    np.testing.assert_allclose(found.damping_ratio, 0.004, rtol=0.1)
    assert len(found.stabilisation.pole) > 100 and set(found.stabilisation.chosen) >= set(range(len(inside)))


@pytest.mark.parametrize("seed", range(4))
def test_noise_alone_has_no_modes(seed):
    random = np.random.default_rng(seed)
    found = identify(LINE, random.standard_normal((6, len(LINE))) + 1j * random.standard_normal((6, len(LINE))))
    assert not len(found.frequency) and found.fitted.shape == (6, len(LINE))


@pytest.mark.parametrize("line, response, told", [
    (np.arange(10.0), np.ones((1, 10)), "32 or more lines at even distances, found 10 lines"),
    (np.arange(40.0) ** 2, np.ones((1, 40)), "at even distances"), (np.arange(40.0), np.zeros((1, 40)), "not all 0"),
    (np.arange(40.0), np.full((1, 40), np.nan), "finite values")])
def test_what_cannot_be_analysed_is_refused(line, response, told):
    with pytest.raises(ConfigError, match=told):
        identify(line, response)


def test_errors_of_shapes_hold_for_close_modes():
    """500 and 501 Hz at .2 % damping: the scatter of residues over draws is what is stated."""
    line, frequency, damping = np.arange(450.0, 550.1, 0.5), np.array([500.0, 501.0]), np.full(2, 2e-3)
    shape = np.array([np.cos(2 * ANGLE), np.sin(2 * ANGLE)])
    clean = responses(line, frequency, damping, shape)
    found = [identify(line, noisy(clean, 0.01, np.random.default_rng(k))) for k in range(30)]
    scatter = np.std([one.residue for one in found], axis=0)
    stated = np.mean([one.residue_std for one in found], axis=0)
    assert np.mean(scatter / stated) == pytest.approx(1, abs=0.2)

"""Refinement of poles: noise that grows with the response, errors that hold, poles that do not settle."""

import numpy as np
import pytest

from pipeline.physics.modal.frf_identification import identify
from pipeline.physics.modal.pole_refinement import noise_of, refined, unexplained
from tests.physics.modal.test_frf_identification import WITHIN, disc, noisy, responses

FREQUENCY, DAMPING, SHAPE = disc()
CLEAN = responses(WITHIN, FREQUENCY, DAMPING, SHAPE)
POLE = np.sort_complex(2j * np.pi * FREQUENCY * np.sqrt(1 - DAMPING**2) - 2 * np.pi * FREQUENCY * DAMPING)
POLE = POLE[np.argsort(POLE.imag)]


def proportional(response, share, random):
    """What few averages leave: noise of a ``share`` of the response at each line, and a little everywhere."""
    size = np.sqrt((share * abs(response)) ** 2 + (0.002 * np.median(abs(response))) ** 2)
    return response + size * (random.standard_normal(response.shape) + 1j * random.standard_normal(response.shape))


def test_noise_is_found_by_line_and_response():
    made = proportional(CLEAN, 0.01, np.random.default_rng(0))
    true = np.sqrt((0.01 * abs(CLEAN)) ** 2 + (0.002 * np.median(abs(CLEAN))) ** 2)
    found = noise_of(made, CLEAN)
    assert np.median(found / true) == pytest.approx(1.0, abs=0.05)
    assert np.all((found / true > 0.5) & (found / true < 2.0))
    even = noise_of(noisy(CLEAN, 0.01, np.random.default_rng(0)), CLEAN)
    assert np.all(np.std(even, axis=1) < 0.05 * even.mean(axis=1))


def test_a_mode_that_is_missing_is_no_noise_but_counts_as_unexplained():
    made = noisy(CLEAN, 0.01, np.random.default_rng(0))
    without = refined(WITHIN, made, np.delete(POLE, 2)).fitted
    near = abs(WITHIN - 1450) < 2
    noise, whole = noise_of(made, without), unexplained(made, without)
    assert np.median(whole[:, near] / noise[:, near]) > 10
    assert np.median(unexplained(made, CLEAN) / noise_of(made, CLEAN)) == 1.0


def test_poles_settle_where_they_began_and_say_so():
    for apart in (False, True):
        fit = refined(WITHIN, CLEAN, POLE, np.ones(CLEAN.shape), apart=apart)
        np.testing.assert_allclose(fit.pole, POLE, rtol=1e-9)
        assert np.all(fit.away < 0.01) and fit.noise.shape == fit.fitted.shape == CLEAN.shape


def test_errors_hold_where_noise_grows_with_the_response():
    """Doublets split by .1 %: all modes, and two thirds of 10 values in 6 draws within one standard deviation."""
    inside = []
    for draw in range(6):
        found = identify(WITHIN, proportional(CLEAN, 0.01, np.random.default_rng(draw)))
        assert len(found.pole) == len(POLE) and np.all(found.away < 0.3)
        far = np.column_stack([found.pole.real - POLE.real, found.pole.imag - POLE.imag]) / found.std
        inside.append(abs(far) < 1.0)
    assert 0.5 < np.mean(inside) < 0.85


def test_a_pole_that_stands_for_nothing_is_told_by_its_residue_and_stops_nothing():
    fit = refined(WITHIN, noisy(CLEAN, 0.01, np.random.default_rng(1)), np.append(POLE, 2j * np.pi * 1600 - 5.0))
    strength = np.sqrt(np.mean((abs(fit.residue) / fit.residue_std) ** 2, axis=1))
    spurious = int(np.argmin(strength))
    assert strength[spurious] < 4.0 < np.delete(strength, spurious).min()
    assert np.all(np.delete(fit.away, spurious) < 0.3)


@pytest.mark.parametrize("split, damping, lines, kind, share", [
    (1.5e-3, 1e-3, 0.25, 0, 0.02), (2e-3, 5e-4, 0.5, 1, 0.005), (1e-3, 1e-3, 1.0, 2, 0.01)])
def test_discs_of_other_makes_settle(split, damping, lines, kind, share):
    """Receptances, mobilities and accelerances, in steps of a quarter to one hertz: every mode of a close pair."""
    frequency, ratio, shape = disc(split, damping)
    line = np.arange(1150.0, 1750.1, lines)
    made = proportional(responses(line, frequency, ratio, shape, kind), share, np.random.default_rng(3))
    found = identify(line, made)
    assert len(found.pole) == len(frequency) and np.all(found.away < 0.3)
    true = np.sort(2 * np.pi * frequency * np.sqrt(1 - ratio**2))
    assert np.all(abs(found.pole.imag - true) < 5 * found.std[:, 1])

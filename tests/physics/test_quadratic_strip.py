"""Roots in a strip: against closed forms and against the published matrices of an industrial brake."""

import os
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.io import loadmat

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.quadratic_modes import quadratic_roots
from pipeline.physics.quadratic_strip import strip_modes

BRAKE = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "brake_matrices" / "5koref1"
#: unstable roots below 3.2 kHz by speed in rad/s: Hz, growth rate 1/s as printed
PUBLISHED = {
    2 * np.pi: [("783.10", "2.08"), ("2773.92", "69.47")],
    4 * np.pi: [("784.99", "5.474"), ("2769.23", "74.83")],
    8 * np.pi: [("560.80", "0.505"), ("788.70", "7.14"), ("1602.66", "8.49"), ("2761.48", "78.86")],
}


def oscillators(frequency, ratio):
    """Uncoupled oscillators hidden by a sparse congruence; roots known in closed form."""
    n = len(frequency)
    mix = sp.eye(n) + sp.diags(np.full(n - 1, 0.4), 1)
    damping, stiffness = sp.diags(2 * ratio * frequency), sp.diags(frequency**2)
    roots = -ratio * frequency + 1j * frequency * np.sqrt(1 - ratio**2)
    return [(mix.T @ a @ mix).tocsr() for a in (sp.eye(n), damping, stiffness)], roots


@pytest.mark.exact
def test_finds_every_root_of_the_strip_and_none_outside():
    frequency = np.linspace(1.0, 60.0, 80)
    ratio = np.where(np.arange(80) % 5 == 0, 0.3, 1e-3)
    matrices, roots = oscillators(frequency, ratio)
    found = strip_modes(*matrices, 30.0, 1.0, "superlu", count=12)
    expected = roots[(roots.imag <= 30.0) & (abs(roots.real) <= 1.0)]
    assert len(found.shift) > 2
    np.testing.assert_allclose(found.value, expected[np.argsort(expected.imag)], rtol=1e-9)


@pytest.mark.exact
def test_double_roots_are_found_twice():
    frequency = np.repeat(np.linspace(1.0, 40.0, 30), 2)
    matrices, roots = oscillators(frequency, np.full(60, 1e-3))
    found = strip_modes(*matrices, 25.0, 2.0, "superlu", count=14)
    np.testing.assert_allclose(found.value, roots[roots.imag <= 25.0], rtol=1e-8)


@pytest.mark.exact
def test_agrees_with_the_dense_solution_of_an_unsymmetric_gyroscopic_system():
    random = np.random.default_rng(4)
    matrices, _ = oscillators(np.linspace(1.0, 50.0, 60), np.full(60, 0.01))
    twist = sp.csr_matrix(np.triu(random.standard_normal((60, 60)), 58) * 20)
    mass, damping, stiffness = matrices[0], matrices[1] + twist - twist.T, matrices[2] + 5 * twist
    dense = quadratic_roots(*(a.toarray() for a in (mass, damping, stiffness)))
    expected = dense[(dense.imag >= 0) & (dense.imag <= 30.0) & (abs(dense.real) <= 1.5)]
    np.testing.assert_allclose(strip_modes(mass, damping, stiffness, 30.0, 1.5, "superlu", count=16).value, expected,
                               rtol=1e-8)


def test_refuses_to_return_an_uncovered_strip():
    matrices, _ = oscillators(np.linspace(1.0, 60.0, 80), np.full(80, 1e-3))
    with pytest.raises(ConvergenceError, match="gap"):
        strip_modes(*matrices, 30.0, 0.5, "superlu", count=6, most_shifts=3)
    with pytest.raises(ConvergenceError, match="radius"):
        strip_modes(*matrices, 30.0, 20.0, "superlu", count=6)
    with pytest.raises(ConfigError, match="count"):
        strip_modes(*matrices, 30.0, 0.5, "superlu", count=200)


def test_same_bits_twice():
    matrices, _ = oscillators(np.linspace(1.0, 60.0, 80), np.full(80, 1e-3))
    first, second = (strip_modes(*matrices, 30.0, 1.0, "superlu", count=12) for _ in range(2))
    assert np.array_equal(first.value, second.value)


def brake_matrices(speed):
    """M, C, K of the published model at a speed in rad/s (reference: 1 rad/s, 1600 Hz)."""
    read = {name: loadmat(BRAKE / f"{name}LL.mat")[f"{name}LL"].tocsr().astype(float)
            for name in ("BM", "BD", "BY", "BDIW", "BH", "BK", "BKQ", "BW")}
    damping = read["BD"] + read["BY"] * speed + read["BDIW"] * (1 / speed - 1) + read["BH"] / (2 * np.pi * 1600)
    return read["BM"], damping, read["BK"] + read["BKQ"] + read["BW"] * (speed**2 - 1)


@pytest.mark.measured
@pytest.mark.golden
@pytest.mark.skipif(not BRAKE.is_dir(), reason=f"no brake matrices at {BRAKE}; set BRAKECHAIN_DATA")
@pytest.mark.parametrize("speed", PUBLISHED)
def test_unstable_roots_of_an_industrial_brake(speed):
    modes = strip_modes(*brake_matrices(speed), 2 * np.pi * 3200, 2000.0, "superlu", count=36)
    unstable = modes.value[modes.value.real > 1e-6 * abs(modes.value)]
    assert len(unstable) == len(PUBLISHED[speed])
    for root, (frequency, growth) in zip(unstable, PUBLISHED[speed], strict=True):
        listed = complex(float(growth), 2 * np.pi * float(frequency))
        assert abs(root - listed) < 1e-4 * abs(listed)
        assert f"{root.real:.{len(growth.split('.')[1])}f}" == growth

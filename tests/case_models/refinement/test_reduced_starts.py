"""Modes of a reduced model that grow or nearly do, beside all its modes."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.case_models.refinement.reduced_starts import _near, nearly_growing, reduced_starts
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_pairs
from stages.complex_modes import Settings, complex_modes
from tests.stages.small_brake import small_brake, small_map

LINEAR = Settings(speeds=("10 rad/s",), friction_steps=2, frequency_max="20 kHz", residual_tolerance=None)


@pytest.mark.exact
def test_starts_are_the_modes_of_the_reduced_model_that_grow():
    brake, friction = small_brake(), small_map()
    modes = complex_modes(brake, friction, settings=LINEAR)
    made = reduced_starts(brake, friction, modes.operating_root[1], 1, 10.0, LINEAR)
    unstable = modes.unstable_root[modes.unstable_operating == 1]
    assert len(unstable) and all(abs(made.root - root).min() < 1e-6 * abs(root) for root in unstable)
    assert nearly_growing(made.root).all() and (np.diff(made.root.imag) > 0).all()
    assert made.motion.shape == (3, 6, len(made.root)) and (made.closure > 0).any()
    lossy = replace(brake, joint_loss_factor=np.full(len(brake.joint_name), 0.01))
    assert (reduced_starts(lossy, friction, modes.operating_root[1], 1, 10.0, LINEAR).root.real.max(initial=-50)
            < made.root.real.max())


@pytest.mark.exact
def test_two_modes_of_nearly_one_frequency_are_both_there():
    rng = np.random.default_rng(2)
    turn = scipy.linalg.qr(rng.standard_normal((12, 12)))[0]
    square = np.r_[(1 + 1e-5) * 1e8, 1e8, np.linspace(3, 9, 10) * 1e8]
    matrices = np.eye(12), 3.0 * np.eye(12), turn @ np.diag(square) @ turn.T
    every = quadratic_pairs(*matrices)[0]
    root, shape = _near(matrices, every, 1.5e4)
    near = every[(every.imag > 0) & (abs(every) < 1.5e4)]
    assert len(root) == 2
    np.testing.assert_allclose(np.sort(root.imag), np.sort(near.imag), rtol=1e-10)
    assert np.linalg.matrix_rank(shape, tol=1e-3) == 2


def test_what_decays_too_fast_cannot_grow_in_a_finer_model():
    roots = np.array([-30 + 2e4j, -51 + 2e5j, -40 + 1e3j, 5 + 1e3j, 5 - 1e3j])
    assert list(nearly_growing(roots)) == [True, False, False, True, False]

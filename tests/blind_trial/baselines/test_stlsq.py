"""Sequentially thresholded least squares: against a closed form, against pysindy's, and on a case."""

import numpy as np
import pytest

from pipeline.blind_trial.baselines.stlsq import answer, stlsq

COLUMNS = np.random.default_rng(0).standard_normal((200, 6))
TARGET = COLUMNS @ [3.0, 0, -0.5, 0, 0.02, 0] + 0.01 * np.random.default_rng(1).standard_normal(200)


def test_it_names_what_is_large_and_nothing_where_little_is_left(hidden, control):
    assert [(e["name"], e["place"]) for e in answer(hidden)["effects"]] == [("cubic_stiffness", "link_0")]
    assert answer(control)["verdict"] == "parameters"


@pytest.mark.exact
def test_of_orthonormal_columns_it_is_a_hard_threshold():
    basis = np.linalg.qr(COLUMNS)[0]
    found = stlsq(basis, basis @ [3.0, 0.2, -0.5, 0, 0, 0], 0.3)
    np.testing.assert_allclose(found, [3.0, 0, -0.5, 0, 0, 0], atol=1e-12)


def test_it_is_that_of_pysindy():
    import pysindy  # here, since it takes seconds and every worker reads this file

    other = pysindy.STLSQ(threshold=0.1, alpha=0).fit(COLUMNS, TARGET).coef_.ravel()
    np.testing.assert_allclose(stlsq(COLUMNS, TARGET, 0.1), other, atol=1e-8)

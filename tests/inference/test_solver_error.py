"""Solver error as a nuisance parameter."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.inference.diagnose import diagnose
from pipeline.inference.evidence import evidence
from pipeline.inference.least_squares import fit
from pipeline.inference.noise import budget
from pipeline.inference.solver_error import NAME, allow
from tests.inference import linear
from tests.inference.oscillator import CATALOGUE, bench, predict, predict_with_lag
from tests.inference.test_evidence import log_density


@pytest.mark.exact
def test_it_is_marginalised_like_a_parameter_of_unit_prior():
    whole, noise, _, tables = linear.problem((2,))
    change = {name: np.sin(np.arange(60.0))[None] for name in tables}
    wider = pickle.loads(pickle.dumps(allow(whole, change)))
    found = fit(wider, tuple(noise[r.name] for r in wider.runs), wider.nominal, np.zeros(3), wider.runs)
    data, design = linear.dense(whole, whole.nominal, tables)
    column = np.concatenate([change[r.name][0] for r in whole.runs])[:, None] / linear.STD
    assert evidence(found).log_evidence == pytest.approx(log_density(data, np.hstack((design, column))), abs=1e-5)


def test_a_solver_that_lags_makes_nothing_be_named():
    problem = replace(bench(5, 0.1), predict=predict_with_lag)
    values = problem.nominal.values(problem.nominal.nominal)
    change = {run.name: predict(problem.nominal, values, run) - predict_with_lag(problem.nominal, values, run)
              for run in problem.runs}
    careless = diagnose(problem, budget(problem), CATALOGUE)
    told = diagnose(allow(problem, change), budget(problem), CATALOGUE)
    assert careless.decision.verdict == "unknown" and told.decision.verdict in ("consistent", "parameters")
    assert told.null.values[NAME] == pytest.approx(1.0, abs=0.1)


def test_a_run_without_its_change_is_refused():
    whole, _, _, tables = linear.problem((2,))
    with pytest.raises(ConfigError, match=r"solver error of run run_1: expected an array of shape \(1, 60\)"):
        allow(whole, {"run_0": np.zeros((1, 60))})

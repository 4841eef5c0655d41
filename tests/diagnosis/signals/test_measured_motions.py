"""Predictions along measured motions: exact where the motion is, linear in large coefficients."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.signals.measured_motions import AlongMotions, measured, shapes
from pipeline.inference.fitting.fit_state import linearised
from tests.studies import several


@pytest.fixture(scope="module")
def cubic():
    """(DiagnosisProblem of a cubic spring whose law is exact, Fit of the nominal model)."""
    whole = several.problem(several.Truth({"cubic_stiffness": 8.0}, {}), 1)
    runs = whole.problem.training
    null = linearised(whole.problem, [whole.budget[r.name] for r in runs], whole.problem.nominal,
                      whole.problem.nominal.nominal, runs)
    return whole, null


def test_the_true_law_leaves_little_at_a_large_coefficient_and_the_prediction_is_linear(cubic):
    """The simulated nominal model is 20 and more times its noise away; at the true values the rest is the motion's."""
    whole, null = cubic
    along, runs = whole.motions.along(null), whole.problem.training
    law = next(c for c in whole.candidates if c.name.startswith("cubic"))
    hypothesis = along.nominal.joined(law)
    size = 8.0 / several.SIZE**3
    names = [p.name for p in hypothesis.parameters]
    true = dict(zip(names, (several.STIFFNESS, several.DAMPING, size), strict=True))

    def shown(factor):
        return along.predict(hypothesis, {**true, names[-1]: factor * size}, runs[1])

    noise = whole.budget[runs[1].name].std[0]
    assert np.sqrt(np.mean((shown(1.0) - runs[1].samples) ** 2)) < 1.5 * noise
    assert np.sqrt(np.mean(null.residuals[1] ** 2)) > 20
    np.testing.assert_allclose(shown(3.0) - shown(0.0), 3 * (shown(1.0) - shown(0.0)), rtol=1e-6, atol=1e-12)


def test_along_its_own_motion_the_nominal_model_predicts_itself(cubic):
    """Null test: without effects only the discretisation of the motion differs."""
    whole, null = cubic
    forward, run = whole.problem.predict, whole.problem.training[0]
    values = null.values
    simulated = forward(null.hypothesis, values, run)
    at_rest = AlongMotions(forward.bench, forward.runs, {run.name: simulated})
    np.testing.assert_allclose(at_rest(null.hypothesis, values, run), simulated, atol=1e-9)


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
def test_the_motion_is_that_of_the_truth_within_a_fraction_of_its_noise(cubic, quantity):
    whole, null = cubic
    run = whole.problem.training[1]
    exact, _ = several.motion(several.Truth({"cubic_stiffness": 8.0}, {}), several.LEVELS[1], 1)
    found = whole.motions.along(null).predict.motions[run.name][0]
    noise = whole.budget[run.name].std[0]
    if quantity == "displacement":
        assert np.sqrt(np.mean((found - exact) ** 2)) < 0.5 * noise
    else:
        speed, seen, true = (np.gradient(x, 1 / several.RATE) for x in (found, run.samples[0], exact))
        assert (speed - true).std() < 0.25 * (seen - true).std(), "less than samples differentiated as they are"


def test_shapes_are_those_of_neighbouring_laws():
    """The logarithm of a power law's size is its derivative by the exponent."""
    time = np.linspace(0, 10, 2001)
    x = np.sin(time)
    power, other = np.sign(x) * abs(x) ** 3, np.sign(x) * abs(x) ** 3.03
    rows = np.array([s[0] for s in shapes(power[None], x[None])])
    assert len(rows) == 6 and rows.shape[1] == len(x)
    assert np.abs((other - power) - 0.01 * rows[0]).max() < 1e-4


def test_motions_of_all_coordinates_must_be_measured(cubic):
    bench = cubic[0].problem.predict.bench
    assert measured(bench, ("x",)) and not measured(bench, ())


def test_an_effect_with_coordinates_of_its_own_is_refused(cubic):
    whole, null = cubic
    along = whole.motions.along(null).predict
    grown = replace(along, bench=whole.problem.predict.bench)
    two = np.eye(2)
    model = replace(grown.bench.model, mass=two, damping=two, stiffness=two)
    with pytest.raises(ConfigError, match="an effect within the 1 measured coordinates, found 2"):
        grown._forces(replace(grown.bench, model=model), whole.problem.training[0])

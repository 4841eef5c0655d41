"""Starts of coordinates that an effect adds: a hidden mass that moves already, against SciPy's two-mass solution."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.diagnosis.signals.added_starts import with_added_starts
from pipeline.diagnosis.signals.forward_model import candidates
from pipeline.diagnosis.signals.start_states import started
from pipeline.effects import named
from pipeline.inference.fitting.calibration import recalibrate
from pipeline.inference.rules import DEFAULTS
from tests.diagnosis.decays import DAMPING, MASS, RATE, STIFFNESS, problem
from tests.diagnosis.signals.test_start_states import rig

HIDDEN, FREQUENCY, RATIO = 0.04, 4.1, 0.002
ABSORBER = ("tuned_absorber", "block")


def decay(start, duration=3.0):
    """(displacement, velocity, acceleration) (n,) of the block with a hidden mass, from (x, u, v, u')."""
    spring, loss = HIDDEN * (2 * np.pi * FREQUENCY) ** 2, 2 * RATIO * HIDDEN * 2 * np.pi * FREQUENCY

    def slope(_, state):
        x, u, v, w = state
        force = spring * (u - x) + loss * (w - v)
        return [v, w, (force - STIFFNESS * x - DAMPING * v) / MASS, -force / HIDDEN]

    time = np.arange(round(duration * RATE) + 1) / RATE
    whole = solve_ivp(slope, (0, time[-1]), start, t_eval=time, rtol=1e-10, atol=1e-13)
    return whole.y[0], whole.y[2], np.array([slope(0, state)[2] for state in whole.y.T])


def asked(motions):
    """(Problem, its candidate of the absorber, noise) of decays."""
    whole = problem(motions, noise=1e-3, weighed=["tuned_absorber"], step="0.5 ms")
    candidate, = (c for c in whole.candidates if c.effects == (ABSORBER,))
    return whole, candidate


def test_candidates_have_starts_of_what_they_add_in_every_run():
    motions = {"a": decay((0.02, -0.03, 0.0, 0.5)), "last": decay((-0.03, 0.02, 0.1, -0.2))}
    _, candidate = asked(motions)
    own = [p for p in candidate.parameters if p.run]
    assert [(p.run, p.unit) for p in own] == [("a", "m"), ("a", "m/s"), ("last", "m"), ("last", "m/s")]
    assert all("absorber at block" in p.name for p in own)


def test_effects_that_add_nothing_have_none():
    bench, runs, section = rig({"a": decay((0.02, 0.02, 0.0, 0.0))}, "displacement")
    given = started(bench, runs, section)
    plain = candidates(bench, [given["a"].run], [named("cubic_stiffness")])
    assert with_added_starts(bench, plain, given) == plain


@pytest.mark.exact
def test_a_hidden_mass_that_moves_already_is_fitted_to_the_noise():
    motions = {"a": decay((0.02, -0.03, 0.0, 0.5)), "last": decay((-0.03, 0.02, 0.1, -0.2))}
    whole, candidate = asked(motions)
    given = whole.problem.given(candidate)
    fit = recalibrate(given, whole.budget, DEFAULTS.calibration).null
    assert fit.chi_square.sum() < 1.5 * fit.counts.sum()
    assert fit.values["tuned_absorber@block.frequency"] == pytest.approx(FREQUENCY, rel=0.01)
    start = next(v for n, v in fit.values.items() if "velocity of absorber" in n and "@a." in n)
    assert start == pytest.approx(0.5, rel=0.2)


@pytest.mark.exact
def test_a_base_that_hardly_yields_hardly_moves_whatever_its_start():
    motions = {"a": decay((0.02, 0.02, 0.0, 0.0)), "last": decay((-0.03, -0.03, 0.1, 0.1))}
    whole = problem(motions, noise=1e-3, weighed=["moving_base"], step="0.5 ms")
    candidate, = (c for c in whole.candidates if c.effects == (("moving_base", "mount"),))
    hypothesis, run = whole.problem.nominal.joined(candidate), whole.problem.runs[0]
    values = hypothesis.values(hypothesis.nominal) | {"moving_base@mount.compliance": 1e-9}
    still = whole.problem.predict(hypothesis, values, run)
    moved = values | {p.name: p.prior.std for p in candidate.parameters if p.run}
    assert abs(whole.problem.predict(hypothesis, moved, run) - still).max() < 1e-4 * abs(still).max()
    moved["moving_base@mount.compliance"] = 1e-3
    assert abs(whole.problem.predict(hypothesis, moved, run) - still).max() > 0.1 * abs(still).max()

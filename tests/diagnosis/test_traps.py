"""Traps of real recordings, made small: where plausible ways of naming physics go wrong, and this one does not."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pipeline.benches import bench as benches
from pipeline.benches.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced import question
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.simulation import completed, shown
from pipeline.inference import diagnose as course
from pipeline.inference.calibrate import calibrate, fit, whitened
from pipeline.inference.problem import Problem
from tests.diagnosis.small_rig import HIDDEN, NOISE, RATE, laid_out, model, recording
from tests.inference import linear

VALUES = {"joints.mount.stiffness": {"spread": 0.2}, "joints.mount.damping": {"spread": 0.5}}
FRICTION = {"coulomb": {"mount": {"force": "0.6 N"}}}


def asked(hidden, *effects, step="2.5 ms", **more):
    """Question about the small rig with a hidden effect, of a few candidates; three runs to fit, one held out."""
    settings = {"parameters": VALUES, "held_out": ["level_4"], "noise": {"std": {"x": f"{NOISE} m"}},
                "effects": list(effects), **more}
    laid = laid_out(step=step)
    return question(benches.built(model(), laid), recorded(recording(hidden), laid_out()),
                    fill(Settings, settings, "diagnosis"))


def diagnosed(whole, **settings):
    return course.diagnose(whole.problem, whole.budget, whole.candidates, course.Settings(draws=2000, **settings))


def told(found):
    return found.decision.verdict, [c.name for c in found.decision.named]


def residuals(whole, found, runs):
    noises = [whole.budget[run.name] for run in runs]
    return np.concatenate(whitened(whole.problem, noises, found.hypothesis, found.latent, runs)[0])


# A hardening spring: "linear + Coulomb" beats linear with friction that pushes


@cache
def hardening():
    return asked(HIDDEN, "coulomb", "cubic_stiffness")


def test_on_a_hardening_spring_a_friction_of_either_sign_beats_the_linear_model_with_a_negative_force():
    """Regression of the force on acceleration, speed, place and direction, as an output without noise gives it."""
    rows, forces = [], []
    for one in recorded(recording(HIDDEN, noise=0.0), laid_out()).values():
        place = one.samples[0]
        speed = np.gradient(place, 1 / RATE)
        rows.append(np.array([np.gradient(speed, 1 / RATE), speed, place, np.sign(speed)]).T)
        forces.append(one.run.inputs["shaker"])
    rows, force = np.concatenate(rows), np.concatenate(forces)
    left = {}
    for name, columns in (("linear", [0, 1, 2]), ("with friction", [0, 1, 2, 3])):
        values, square, *_ = np.linalg.lstsq(rows[:, columns], force, rcond=None)
        left[name] = len(force) * np.log(square[0] / len(force)) + len(columns) * np.log(len(force))
    assert left["linear"] - left["with friction"] > 10, "BIC prefers friction"
    assert values[3] < 0, "which pushes"


def test_on_a_hardening_spring_the_spring_is_named_and_friction_that_pushes_is_beyond_its_prior():
    whole = hardening()
    coulomb = next(c for c in whole.candidates if c.effects[0][0] == "coulomb")
    assert coulomb.parameters[0].prior.support[0] == 0.0
    assert told(diagnosed(whole)) == ("missing", ["cubic_stiffness at mount"])


# Dry friction: what viscous damping absorbs, and the direction that it does not have


@cache
def rubbing():
    whole = asked(FRICTION, "coulomb", "asymmetric_friction", "quadratic_damping")
    return whole, diagnosed(whole)


def test_an_output_error_refit_lets_viscous_damping_absorb_most_of_the_friction_and_breaks_elsewhere():
    whole, found = rubbing()
    first, runs = found.base.null if found.base else found.null, whole.problem.training
    before = residuals(whole, replace(first, latent=whole.problem.nominal.nominal), runs)
    after = residuals(whole, first, runs)
    assert first.values["joints.mount.damping"] > 2 * 1.2, "far above the true 1.2 N s/m"
    assert after @ after < 0.5 * before @ before, "the refit hides most of it"
    assert found.drift.p_value < 0.001, "but asks for another damping at every level"


def test_friction_is_named_and_its_direction_is_not():
    whole, found = rubbing()
    assert told(found) == ("missing", ["coulomb at mount"])


def test_a_direction_improves_training_and_worsens_what_was_held_out():
    whole, found = rubbing()
    (symmetric,) = [w.fit for w in found.weighed if w.candidate.name == "coulomb at mount"]
    directed = next(c for c in whole.candidates if c.effects[0][0] == "asymmetric_friction")
    problem = whole.problem.given(next(c for c in whole.candidates if c.effects[0][0] == "coulomb"))
    both = fit(problem, symmetric.noises, problem.nominal.joined(directed),
               np.append(symmetric.latent, 0.0), symmetric.runs)
    assert both.chi_square.sum() < symmetric.chi_square.sum(), "one more parameter always helps here"
    held = whole.problem.held_out
    with_it, without = residuals(whole, both, held), residuals(whole, symmetric, held)
    assert with_it @ with_it > without @ without, "and harms there"


# A solver that is late


class Late:
    """Prediction of a solver whose forces come half a step late; ``refinement`` 1 halves the step, 2 has none."""

    def __init__(self, bench, runs, step):
        self.bench, self.runs, self.step = bench, runs, step

    def __call__(self, hypothesis, values, run):
        late = 0.5 * self.step * (1 - 0.5 * values.get("time_step@solver.refinement", 0.0))
        own = self.runs[run.name]
        force = np.interp(own.time - late, own.time, own.inputs["shaker"])
        return shown(completed(self.bench, hypothesis, values), replace(own, inputs={"shaker": force}), run.channels)


def test_a_solver_half_a_step_late_is_told_as_numerics_and_not_as_physics():
    whole = asked(None, "coulomb", "cubic_stiffness", "attached_mass")
    runs = {one.run.name: one.run for one in recorded(recording(), laid_out()).values()}
    problem = Problem(whole.problem.runs, Late(whole.problem.predict.bench, runs, 0.02), whole.problem.nominal)
    late = replace(whole, problem=problem)
    blind = replace(late, candidates=tuple(c for c in late.candidates if c.kind != "numerics"))
    noises = [late.budget[run.name] for run in problem.training]
    null = calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training)
    best = max(diagnosed(blind).weighed, key=lambda w: w.evidence.log_evidence)
    assert null.chi_square.sum() - best.fit.chi_square.sum() > np.log(null.counts.sum()), "BIC would name an effect"
    assert told(diagnosed(late)) == ("numerics", ["time_step at solver"])


# The best held-out model, without a null


def test_the_best_held_out_model_names_something_in_most_controls_and_the_rules_nothing():
    controls, chosen, named = 10, 0, 0
    for seed in range(controls):
        problem, budget, catalogue, _ = linear.problem((2, *[1] * 12), runs=4, seed=seed, held_out=1, truth={
            "nominal_0": 1.0, "nominal_1": -0.5})
        noises = [budget[run.name] for run in problem.training]
        held = [budget[run.name] for run in problem.held_out]
        left = []
        for hypothesis in [problem.nominal, *(problem.nominal.joined(c) for c in catalogue)]:
            found = fit(problem, noises, hypothesis, hypothesis.nominal, problem.training)
            own = np.concatenate(whitened(problem, held, hypothesis, found.latent, problem.held_out)[0])
            left.append(own @ own)
        chosen += int(np.argmin(left) > 0)
        named += bool(course.diagnose(problem, budget, catalogue).decision.named)
    assert chosen >= 0.9 * controls and named == 0


# Compliance of a contact and of the arm that holds what rubs


@pytest.mark.parametrize("loads, alone", [((10.0,), False)])
def test_compliance_of_a_contact_and_of_its_arm_are_tied_at_one_load(loads, alone):
    pytest.skip("written below")

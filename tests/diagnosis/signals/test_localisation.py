"""Stage, place, run and band of a mismatch: found where it is, and nowhere where there is none."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals import localisation
from pipeline.diagnosis.signals.localisation import band_axis, place_axis, places, run_axis, stage_axis, stage_of
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from tests.diagnosis import two_masses
from tests.diagnosis.small_rig import laid_out, model

LEAST = {"draws": 500}


def noisy(powers, tone=0.0, samples=4096, rate=100.0):
    """(Observed runs, {run: Noise}, {run: whitened residual}) of unit noise times root ``powers``, and a tone."""
    random, time = np.random.default_rng(3), np.arange(samples) / rate
    white = [np.sqrt(p) * random.standard_normal((1, samples)) + tone * np.sin(2 * np.pi * 10 * time) for p in powers]
    runs = tuple(Observed(f"run_{k}", {}, ("x",), w, rate, noise_std=np.ones(1)) for k, w in enumerate(white))
    noise = budget(Problem(runs, None, Hypothesis("nominal", (), (Parameter("a", "1", 1.0, LogNormal(1.0, 0.1)),))))
    return runs, noise, {r.name: noise[r.name].whiten(r.samples) for r in runs}


def test_the_run_with_the_largest_residual_is_the_set():
    _, noise, whites = noisy((1.0, 1.5, 1.0))
    found = run_axis(whites, noise, **LEAST)
    assert found.significant() == ("run_1",) and found.members.tolist() == [False, True, False]
    _, noise, whites = noisy((1.0, 1.0, 1.0))
    assert not run_axis(whites, noise, **LEAST).significant(0.01)


def test_a_tone_is_in_its_octave():
    runs, noise, whites = noisy((1.0, 1.0), tone=0.6)
    found, unit, edges = band_axis(runs, whites, noise, **LEAST)
    row, = np.flatnonzero(found.members)
    assert unit == "Hz" and edges[row, 0] < 10 < edges[row, 1] and found.p_value[row] < 0.01
    runs, noise, whites = noisy((1.0, 1.0))
    assert not band_axis(runs, whites, noise, **LEAST)[0].significant(0.01)


def test_features_have_no_bands():
    assert band_axis((Observed("f", {}, ("x",), np.ones((1, 3)), noise_std=np.ones(1)),), {}, {}) is None


@pytest.mark.parametrize("hidden, place", [("mount", "mount = left"), ("coupling", "coupling")])
def test_a_hidden_spring_is_found_at_its_joint(hidden, place):
    bench, runs, fit = two_masses.fitted({"cubic_stiffness": {hidden: {"coefficient": "3e5 N/m^3"}}})
    found = place_axis(bench, runs, fit, None, **LEAST)
    best = int(np.argmax(found.score))
    assert found.items[best] == place and found.p_value[best] < 0.01 and found.members.tolist().count(True) == 1


def test_no_place_stands_out_of_noise():
    assert not place_axis(*two_masses.fitted({}), None, **LEAST).significant(0.01)


def test_places_of_one_row_are_one():
    rows = places(benches.built(model(), laid_out()))
    assert list(rows) == ["mount = block"] and rows["mount = block"].tolist() == [[1.0]]


def test_the_stage_is_that_of_the_leading_hypotheses():
    effects = [(("coulomb", "a"),), (("cubic_stiffness", "a"),), (("time_step", "solver"),)]
    assert [stage_of(e) for e in effects] == ["friction", "structure", "numerics"] and stage_of(()) == ""
    assert stage_of((("third_body_film", "asperities"),)) == "micro_friction"
    assert stage_of((("third_body_film", "contact"),)) == "friction"
    assert stage_of((("interpolation", "friction_map"),)) == "friction_map"
    tried = [SimpleNamespace(name=str(k), effects=e) for k, e in enumerate(effects)]
    weighed = SimpleNamespace(candidate=tried[1], statistics=SimpleNamespace(posterior=0.97))
    screen = SimpleNamespace(candidates=tried, score=np.array([4.0, 9.0, 1.0]), p_value=np.array([0.02, 0.001, 0.9]))
    found = stage_axis(SimpleNamespace(base=None, screen=screen, weighed=(weighed,)))
    assert found.items == ("structure", "friction", "numerics") and found.members.tolist() == [True, False, False]
    assert found.significant(0.01) == ("structure",)


def test_a_model_that_a_push_drives_beyond_what_it_holds_for_is_pushed_less(monkeypatch):
    bench, runs, null = two_masses.fitted({"cubic_stiffness": {"mount": {"coefficient": "3e5 N/m^3"}}})
    rows, basis, tried = np.array([[1.0, 0.0]]), localisation._basis, []
    whole = basis(bench, runs, null, rows, 0.1)

    def weak(bench, runs, null, rows, size):
        tried.append(size)
        if size > 0.005:
            raise ConfigError("time stepping at t = 1.15 s", "a step that resolves the element", "none")
        return basis(bench, runs, null, rows, size)

    monkeypatch.setattr(localisation, "_basis", weak)
    np.testing.assert_allclose(localisation._pushed(bench, runs, null, rows, 0.1), whole, rtol=1e-6, atol=1e-6)
    assert tried == pytest.approx([0.1, 0.01, 0.001])
    monkeypatch.setattr(localisation, "_basis", lambda *_: weak(bench, runs, null, rows, 1.0))
    with pytest.raises(ConfigError, match="time stepping at t = 1.15 s"):
        localisation.place_axis(bench, runs, null, null.weights, 100)


def test_a_place_that_cannot_be_computed_costs_no_other_axis(monkeypatch):
    asked, found = forced()
    monkeypatch.setattr(localisation, "_basis", lambda *_: 1 / 0)
    axes = asked.locator.located(found)
    assert set(axes) == {"stage", "run", "band"} and asked.latent.described(found, axes) is None
    assert axes.failures[0].startswith("the place of the mismatch could not be computed: internal error ZeroDivision")


def test_forced_runs_are_located_on_all_axes():
    asked, found = forced()
    axes = asked.locator.located(found)
    assert set(axes) == {"stage", "run", "place", "band"}
    told = asked.latent.described(found, axes)
    assert told.location == "mount = left" and set(told.regimes) == {"amplitude", "velocity", "time"}


def forced():
    """(DiagnosisProblem of two masses, Diagnosis of it as far as locators look)."""
    laid, whole = two_masses.LAID, two_masses.built()
    asked = forced_problem(whole, recorded(two_masses.recording({"cubic_stiffness": {"mount": {
        "coefficient": "3e5 N/m^3"}}}), laid), fill(Settings, two_masses.ASKED, "diagnosis"))
    training = asked.problem.training
    null = linearised(asked.problem, [asked.budget[r.name] for r in training], asked.problem.nominal,
                      asked.problem.nominal.nominal, training)
    screen = SimpleNamespace(candidates=asked.candidates, score=np.ones(len(asked.candidates)),
                             p_value=np.ones(len(asked.candidates)))
    return asked, SimpleNamespace(base=None, null=null, recalibrated=null, screen=screen, weighed=(), weights=None)

"""What values cannot explain: d against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.detectability import Explained, Refitted, Values, of_rig, whitened
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Recorder
from pipeline.blind_trial.generators.spring_mass.linear_motion import linear
from pipeline.blind_trial.generators.spring_mass.rig import drawn

NOISE = np.array([1e-3, 2e-3])


def explained(spread=0.25):
    random = np.random.default_rng(1)
    forces = tuple(random.standard_normal((2, 150)))
    rig = drawn(random, 2)
    recorder = Recorder(forces, 100.0, np.ones(2), 2.5e-3, 40.0)
    return of_rig(recorder, Values(rig, spread, 0.005), 2), rig, recorder


@pytest.mark.exact
def test_a_change_that_nothing_explains_keeps_its_size():
    own, _, _ = explained()
    change = np.ones((2, 2, 150)) * NOISE[:, None]
    assert Explained(0 * own.directions).left(change, NOISE) == pytest.approx(np.sqrt(600))


@pytest.mark.exact
def test_a_change_by_one_value_is_left_as_far_as_its_prior_holds_it():
    """r = J u alone: d^2 = |r|^2 / (1 + |J|^2)."""
    own, _, _ = explained()
    own = Explained(own.directions[:1])
    whole = np.sum(whitened(own.directions, NOISE, 0.0) ** 2)
    assert own.left(2 * own.directions[0], NOISE) == pytest.approx(np.sqrt(4 * whole / (1 + whole)))


def test_another_stiffness_is_explained_and_another_motion_is_not():
    own, _, _ = explained()
    stiffer = own.directions[2] * 0.1
    assert own.left(stiffer, NOISE) < 0.11
    odd = np.random.default_rng(3).standard_normal(stiffer.shape) * np.sqrt(np.mean(stiffer**2))
    assert own.left(odd, NOISE) > 0.9 * np.sqrt(np.sum((odd / NOISE[:, None]) ** 2))


def test_a_rig_of_quite_other_values_is_explained_once_it_is_refitted():
    """What is left is how odd the other value is: ln 1.4 over its spread of 0.25."""
    own, rig, recorder = explained()
    links = (replace(rig.links[0], stiffness=1.4 * rig.links[0].stiffness), *rig.links[1:])
    other = np.array(recorder.seen([linear(replace(rig, links=links), f, 0.01, 40.0) for f in recorder.runs]))
    noise = 0.01 * np.sqrt(np.mean(other**2, axis=(0, 2)))
    assert own.left(other - own.at_rest, noise) == pytest.approx(np.log(1.4) / 0.25, rel=0.01)
    assert Explained(own.directions).left(other - own.at_rest, noise) > 20


def test_a_value_that_is_known_explains_nothing():
    own, rig, recorder = explained()
    known = of_rig(recorder, Values(rig, 0.25, 0.005, ("stiffness_0",)), 2)
    stiffer = own.directions[2] * 0.1
    assert known.size == own.size - 1 and known.left(stiffer, NOISE) > 3 * own.left(stiffer, NOISE)


@pytest.mark.parametrize("linearly", [True, False])
def test_what_takes_part_beside_the_values_is_taken_off(linearly):
    own, _, _ = explained()
    own = Explained(own.directions) if linearly else own
    odd = np.random.default_rng(3).standard_normal((2, 2, 150)) * NOISE[:, None]
    assert own.left(0.7 * odd, NOISE, beside=[odd]) == pytest.approx(0.7, rel=0.01)
    assert own.left(0.7 * odd, NOISE) > 15


@pytest.mark.exact
def test_coloured_noise_is_white_after_whitening():
    colour, random = 0.6, np.random.default_rng(0)
    samples = [random.standard_normal()]
    for _ in range(20000):
        samples.append(colour * samples[-1] + np.sqrt(1 - colour**2) * random.standard_normal())
    white = whitened(np.array([samples]), [1.0], colour)[0]
    assert white.std() == pytest.approx(1, abs=0.02) and abs(white[1:] @ white[:-1] / (white @ white)) < 0.02


def test_slopes_that_are_updated_end_where_new_ones_do_with_fewer_motions():
    own, rig, recorder = explained()
    links = (replace(rig.links[0], stiffness=1.4 * rig.links[0].stiffness), *rig.links[1:])
    other = np.array(recorder.seen([linear(replace(rig, links=links), f, 0.01, 40.0) for f in recorder.runs]))
    noise, counts, lefts = 0.01 * np.sqrt(np.mean(other**2, axis=(0, 2))), [], []
    for costly in (False, True):
        asked = []
        refit = Refitted(lambda u, asked=asked: asked.append(u) or own.model(u), own.size, costly)
        lefts.append(refit.left(other - own.at_rest, noise))
        counts.append(len(asked))
    assert lefts[1] == pytest.approx(lefts[0], rel=0.01) and counts[1] < counts[0]


@pytest.mark.parametrize("lost, left", [(lambda u: u[0] != 0, 3.0), (lambda u: True, np.inf)])
def test_a_value_towards_which_the_model_cannot_stays_as_it_is(lost, left):
    """The first of two values would explain all; the second explains nothing."""
    def model(u):
        return np.full((1, 1, 9), np.nan) if lost(u) else np.full((1, 1, 9), 100 * u[0])

    found = Refitted(model, 2, costly=True)
    assert found.left(np.ones((1, 1, 9)), [1.0]) == left


def test_a_fit_goes_on_along_a_valley_that_bends():
    """d^2 = K^2 (v - u^2)^2 + u^2 + v^2 from (1.5, 1.5^2): every share of a straight step leaves the parabola."""
    steep = 3e4
    fit = Refitted(lambda u: np.array([[[steep * (u[1] - u[0] ** 2)]]]), 2)
    asked = np.zeros((1, 1, 1)), np.ones(1), 0.0, np.zeros((0, 1))
    u = np.array([1.5, 1.5**2])
    r, shown = fit._residual(u, *asked)
    rows, before = fit._rows(fit._slopes(u, shown), *asked[1:3]), r @ r + u @ u
    step = fit._step(rows, r, u)
    assert fit._nearer(u, step, before, *asked) is None
    moved, r, _ = fit._corrected(rows, u, r, step, before, *asked)
    assert r @ r + moved @ moved < before and moved[1] == pytest.approx(moved[0] ** 2, abs=0.01)

"""Hypotheses on a squeal: their draws, their tones, and the brake on a disc that is held."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import FrictionErrors, Source, family
from pipeline.contract import ConfigError
from pipeline.diagnosis.published.line_hypotheses import (
    FALLING,
    LOADING,
    Hypothesis,
    check_hypotheses,
    drawn,
    on_rigid_disc,
    same_solution,
    tone_set,
    tones_of,
)
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure

SOURCES = (Source(kind="joint_stiffness", variation=0.3), Source(kind="damping_speed", range=(0.3, 3)))


@pytest.fixture(scope="module")
def model():
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


def draws(model, count=400, seed=3, **given):
    return drawn(Hypothesis(**{"disc": "flexible", **given}), SOURCES, FrictionErrors(), model, count, seed)


def test_equal_seeds_give_shared_sources_the_same_values(model):
    plain, other = draws(model), draws(model, falling=(0.02, 0.1), load_rate="0.5 Hz")
    np.testing.assert_array_equal(plain.values[:, :2], other.values[:, :2])
    drop = other.column(FALLING)
    assert 0.02 <= drop.min() < 0.03 and 0.09 < drop.max() <= 0.1 and not plain.column(FALLING).any()
    np.testing.assert_allclose([f.speed_slope for f in other.factors], -drop)
    assert 0.9 * np.pi < other.column(LOADING).max() <= np.pi


def test_sources_of_a_hypothesis_replace_those_of_the_case(model):
    narrow = draws(model, sources=({"kind": "damping_speed", "range": (5, 6), "distribution": "uniform"},))
    assert narrow.name[:2] == ("joint_stiffness", "damping_speed")
    assert narrow.column("damping_speed").min() >= 5 and narrow.column("damping_speed").max() <= 6


def test_of_joint_factors_the_longest_part_counts(model):
    names = [str(n) for n in model.joint_name]
    made = draws(model, joint_factors={"abutment": 0.5, "abutment_outer": 2.0})
    ratio = made.factors[7].joint_stiffness / draws(model).factors[7].joint_stiffness
    expected = [2.0 if "abutment_outer" in n else 0.5 if "abutment" in n else 1.0 for n in names]
    np.testing.assert_allclose(ratio, expected)
    assert len(set(expected)) == 3
    with pytest.raises(ConfigError, match="abutmnt"):
        draws(model, joint_factors={"abutmnt": 2.0})


@pytest.mark.parametrize(("given", "where"), [
    ({"falling": (0.1, 0.0)}, "falling"), ({"falling": (-0.1, 0.1)}, "falling"),
    ({"joint_factors": {"abutment": 0.0}}, "joint_factors"),
    ({"sources": ({"kind": "joint_loss"},)}, "sources.0")])
def test_hypotheses_that_cannot_be_drawn_are_refused(given, where):
    with pytest.raises(ConfigError, match=f"hypotheses.odd.{where}"):
        check_hypotheses({"odd": Hypothesis(disc="rigid", **given)}, SOURCES, "line_evidence")


def test_only_what_changes_modes_makes_a_solution_of_its_own():
    plain, load = Hypothesis(disc="flexible"), Hypothesis(disc="flexible", load_rate="1 Hz", harmonics=True)
    assert same_solution(plain) == same_solution(load) != same_solution(Hypothesis(disc="rigid"))
    assert same_solution(plain) != same_solution(Hypothesis(disc="flexible", falling=(0, 0.1)))


def roots(*pairs):
    """(growth rate 1/s, frequency Hz) as roots."""
    return np.array([growth + 2j * np.pi * frequency for growth, frequency in pairs])


@pytest.mark.exact
def test_tones_are_unstable_modes_those_of_several_points_counted_once():
    cycle = [roots((5, 3000), (-2, 8000)), roots((1, 3020), (7, 12000))]
    test = np.array([0, 1])

    def tones(points, growth, multiples=1):
        return tone_set(points, np.full(2, growth), test, 2, 20e3, multiples, 0.01)

    frequency, grows = tones(cycle, 0.0)
    np.testing.assert_allclose(frequency, [3010, 12000])
    np.testing.assert_array_equal(grows, [[1, 1], [0, 1]])
    np.testing.assert_allclose(tones(cycle, 3.0)[0], [3010, 8000, 12000])
    frequency, grows = tones([roots(), roots((-50, 900))], 3.0, 9)
    assert not len(frequency) and grows.shape == (0, 2)


@pytest.mark.exact
def test_multiples_reach_the_end_of_the_band_and_grow_with_their_fundamental():
    points = [roots((5, 3000)), roots((5, 8000))]
    few, _ = tone_set(points, np.zeros(2), np.array([0, 1]), 2, 16e3, 2, 0.01)
    np.testing.assert_allclose(few, [3000, 6000, 8000, 16000])
    frequency, grows = tone_set(points, np.zeros(2), np.array([0, 1]), 2, 16e3, 24, 0.01)
    np.testing.assert_allclose(frequency, [3000, 6000, 8000, 9000, 12000, 15000, 16000])
    np.testing.assert_array_equal(grows[:, 1], np.isin(frequency.round(), [8000, 16000]))


@pytest.mark.exact
def test_a_tone_is_unheard_with_the_stated_probability():
    sets = [(np.array([3e3]), np.array([[True, False]])), (np.array([2e3, 4e3]), np.array([[False, True]] * 2))]
    made = tones_of(sets, 2, np.array([0.4, 0.9]), 0.01, 50.0)
    np.testing.assert_allclose(np.exp(-made.mean), [[0.6, 1.0], [0.1, 1.0], [0.6, 0.6], [0.1, 0.1]])
    np.testing.assert_allclose(np.exp(-made.within([False, True]).mean).prod(axis=1), [1.0, 1.0, 0.36, 0.01])
    np.testing.assert_allclose(made.std[0, 0], np.hypot(30, 50))


def test_a_disc_without_another_body_cannot_be_held(model):
    modes = complex_modes(model, small_friction_map(0.6), settings=Modes(friction_steps=2, speeds=("8 rad/s",)))
    whole = family(model, 1, small_friction_map(0.6), StabilitySettings.of(modes))
    with pytest.raises(ConfigError, match=r"line_evidence.disc: expected not every body"):
        on_rigid_disc(whole, [str(name) for name in model.body_name])


def test_on_a_rigid_disc_the_roots_are_those_of_the_model_with_its_disc_held(model):
    law = small_friction_map(0.6)
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("8 rad/s",), frequency_max="8 kHz"))
    points = StabilitySettings.of(modes)
    rigid = on_rigid_disc(family(model, 1, law, points), ["disc"])
    found = sampled(rigid, [8.0], points.frequency_max, smallest=1e-6).roots(NOMINAL, 8.0)
    contact = sampled(rigid, [8.0], points.frequency_max).sliding.slide(NOMINAL, 8.0)
    held = rigid.model.at_speed(8.0)
    held = replace(held, contacts=replace(held.contacts, preload=contact.force, stiffness=contact.stiffness,
                                          damping=contact.force / rigid.damping_speed))
    every = quadratic_roots(*held.linearised(contact.friction))
    assert len(found) and held.size == model.mass.shape[0] - np.sum(model.coordinate_body == 0)
    for root in found:
        assert abs(every - root).min() < 1e-5 * abs(root)

"""First values of a model by least squares: those of a simulated rig come back; a reversed force is seen."""

import numpy as np
import pytest

from pipeline.recordings.survey.first_values import channel_noise, first_values

RATE = 500.0
TIME = np.arange(5000) / RATE


def driven(mass=2.0, damping=5.0, stiffness=300.0):
    motion = 0.01 * (np.sin(2 * np.pi * 1.3 * TIME) + 0.5 * np.sin(2 * np.pi * 3.1 * TIME + 1))
    speed, inertia = np.gradient(motion, 1 / RATE), np.gradient(np.gradient(motion, 1 / RATE), 1 / RATE)
    return motion[None], (mass * inertia + damping * speed + stiffness * motion)[None]


@pytest.mark.exact
def test_mass_damping_and_stiffness_come_back():
    motion, force = driven()
    found = first_values([motion], [force], RATE, 0)
    assert (found.mass[0, 0], found.damping[0], found.stiffness[0, 0]) == pytest.approx((2, 5, 300), rel=0.02)
    assert found.left[0] < 0.02 and not found.reversed[0]


@pytest.mark.exact
def test_nine_samples_a_period_give_the_mass_and_are_told_to_be_coarse():
    """Of m x'' + k x = f in closed form; tones up to a quarter of the rate."""
    tones = [(2 * np.pi * RATE / samples, 0.01) for samples in (60.0, 9.0, 4.0)]
    motion = sum(size * np.sin(w * TIME + w) for w, size in tones)
    force = sum(size * (300.0 - 2.0 * w**2) * np.sin(w * TIME + w) for w, size in tones)
    found = first_values([motion[None]], [force[None]], RATE, 0)
    assert found.coarse and found.mass[0, 0] == pytest.approx(2.0, rel=0.005)
    assert not first_values([driven()[0]], [driven()[1]], RATE, 0).coarse


def test_a_reversed_force_is_turned_and_told():
    motion, force = driven()
    found = first_values([motion], [-force], RATE, 0)
    assert found.reversed[0] and found.mass[0, 0] == pytest.approx(2, rel=0.02)


def test_a_free_decay_tells_its_frequency():
    motion = 0.01 * np.exp(-0.5 * TIME) * np.cos(2 * np.pi * 3 * TIME)
    found = first_values([motion[None]], None, RATE, 0)
    assert found.fastest == pytest.approx(2 * np.pi * 3, rel=0.01) and found.damping[0] == pytest.approx(1.0, rel=0.05)


def test_what_falls_has_a_weight_and_no_spring():
    found = first_values([(40 - 9.81 / 2 * TIME[:1000]**2)[None]], None, RATE, 0)
    assert not found.stiffness.any() and found.constant[0] == pytest.approx(9.81, rel=0.05)


def test_noise_is_that_of_second_differences_or_of_rounding():
    values = np.sin(TIME) + 1e-3 * np.random.default_rng(0).standard_normal(len(TIME))
    assert channel_noise(values) == pytest.approx(1e-3, rel=0.1)
    assert channel_noise(np.round(np.sin(TIME), 1)) == pytest.approx(0.1 / np.sqrt(12), rel=0.3)


def test_loops_without_a_time_are_as_steep_as_behind_a_reversal_and_have_no_mass():
    strain = np.concatenate([np.linspace(0, 3, 30), np.linspace(3, -3, 60), np.linspace(-3, 3, 60)])
    strain, stress, slip = np.repeat(strain, 2), [], 0.0       # every point twice, as some programs write
    for e in strain:
        slip = np.clip(slip, e - 1, e + 1)
        stress.append(200 * (e - slip))
    found = first_values([strain[None]], [np.array(stress)[None]], 1.0, 0, quasi_static=True)
    assert found.stiffness[0, 0] == pytest.approx(200, rel=0.05) and not found.mass.any()

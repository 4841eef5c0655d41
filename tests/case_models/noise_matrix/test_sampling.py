"""Draws of brakes and stops, bands of unstable roots, friction of a warm disc."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.noise_matrix.sampling import Bands, Draws, Group, at_temperature, families, pad_speeds
from pipeline.case_models.noise_matrix.schedule import Condition
from pipeline.case_models.scatter import FrictionErrors, Source, family
from pipeline.contract import ConfigError
from pipeline.physics.stability.draws.draw_statistics import third_octaves
from pipeline.products import FrictionOverTemperature
from tests.stages.small_oscillator import small_oscillator
from tests.stages.small_structure import small_friction_map

BANDS = Bands(third_octaves(2e3, 16e3), 2e3, 16e3, 5.0, 1e-6)
SETTINGS = SimpleNamespace(repeats=3, varying=("friction",), pressure_factor=0.4, wheel_radius=0.3,
                           sources=(Source(kind="damping_speed", variation=0.3),
                                    Source(kind="friction", variation=0.1)))


def roots(*pairs):
    return np.array([growth + 2j * np.pi * frequency for growth, frequency in pairs])


def test_unstable_modes_within_the_limits_count_in_their_band():
    held = BANDS.noisy(roots((20, 2.1e3), (20, 1.9e3), (4, 5e3), (-3, 8e3), (9, 15.9e3), (9, 16.1e3)))
    assert [f"{f:.0f}" for f in BANDS.middle[held]] == ["1995", "15849"]
    assert not BANDS.noisy(roots()).any()


def test_stops_of_a_brake_share_what_belongs_to_the_brake():
    made = Draws.of(SETTINGS, FrictionErrors(), small_oscillator(), 50, 1)
    brake, stop = made.values.reshape(50, 3, 2).transpose(2, 0, 1)
    assert (np.ptp(brake, axis=1) == 0).all() and len(np.unique(brake)) == 50
    assert len(np.unique(stop)) == 150 and len(made.factors) == 150
    assert made.factors[4].damping_speed == brake[1, 0] and made.factors[4].friction == stop[1, 1]


def test_speeds_of_the_disc_and_pressure_on_the_pads():
    group, speed = pad_speeds(Condition("stop", 2e6, -12.0, 0.0), 3, SETTINGS)
    assert group == Group(8e5, 0.0, -1)
    np.testing.assert_allclose(speed, [-10 / 0.3, -6 / 0.3, -2 / 0.3])


@pytest.mark.exact
def test_friction_of_a_warm_disc_lies_between_those_of_the_map():
    plain = small_friction_map(0.5)
    warm = replace(plain, over_temperature={"bodies": FrictionOverTemperature(
        temperature=[100.0, 200.0], friction=np.array([0.4, 0.35])[:, None, None, None] * np.ones((1, 2, 2, 2)))})
    for rise, friction in ((-20, 0.5), (0, 0.5), (50, 0.45), (100, 0.4), (150, 0.375), (300, 0.35)):
        np.testing.assert_allclose(at_temperature(warm, rise).friction, friction)


def test_a_model_without_a_normal_law_needs_a_preload_at_the_pressure():
    points = SimpleNamespace(speeds=(1.0,), sliding_distance=0.0, friction=0.3, friction_at_rest=None, decay_speed=0.01,
                             damping_speed=1.0, friction_slopes=True, friction_damping=False, gyroscopic=True,
                             centrifugal=True)
    directions = []

    def of(model, state, friction_map, direction):
        directions.append(direction)
        return family(model, state, friction_map, points)

    made, = families([Group(1.0, 0.0, -1)], small_oscillator(on_belt=True), None, of, 293.0)
    assert made.model.size == 1 and directions == [-1]
    with pytest.raises(ConfigError, match="1 Pa.*2 Pa on the pads"):
        families([Group(2.0, 0.0, 1)], small_oscillator(on_belt=True), None, of, 293.0)

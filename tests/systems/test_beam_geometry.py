"""The objective of the geometry search: bands, missing and foreign coalescences, a geometry known to be good."""

import numpy as np
import pytest

from pipeline.systems.beam_geometry import LOWER, MOTION, NAMES, UPPER, described, linear, motion_cost
from pipeline.systems.beam_on_beam import build

#: rigid supports: the linear facts are met within the tolerances of the comparison
RIGID = np.array([100.54, 5.69, 0.648, 377.4, 19.28, 0.34])


@pytest.mark.golden
def test_a_geometry_with_rigid_supports_meets_the_linear_facts_roughly():
    found = linear(RIGID)
    np.testing.assert_allclose(found.found.onset_frequency, [395, 2810, 7530], rtol=0.01)
    np.testing.assert_allclose(found.found.onset_friction, [0.121, 0.150, 0.225], atol=0.005)
    assert found.unstable == 2 and found.cost < 4


def test_leaning_the_other_way_loses_the_coalescences():
    assert linear(RIGID, tilt=np.radians(5.0)).cost > 120


def test_a_geometry_that_cannot_be_built_costs_more_than_any():
    short = RIGID.copy()
    short[3] = 70.0
    assert linear(short).cost > linear(RIGID, tilt=np.radians(5.0)).cost


@pytest.mark.exact
def test_motion_inside_all_bands_costs_nothing():
    inside = {"fundamental": 2700.0, "peak_force": 40.0, "peak_slip": 50e-3, "share_open": 0.3, "share_stick": 0.4,
              "share_slip": 0.3, "second_height": 20.0, "third_height": 10.0, "low_level": -20.0,
              "vibrating_share": 0.5}
    assert set(inside) == set(MOTION) and motion_cost(inside) == 0.0
    assert motion_cost({**inside, "peak_force": 27.0}) == pytest.approx(4.0)
    assert motion_cost({**inside, "fundamental": 2800.0, "share_open": 0.1}) == pytest.approx(2.0)
    assert motion_cost({**inside, "fundamental": 500.0}) == 60.0, "one line far off must not drown the rest"


def test_vector_becomes_parameters_in_si():
    vector = (LOWER + UPPER) / 2
    told = described(vector)
    assert len(vector) == len(NAMES)
    assert told.slider.length == pytest.approx(0.09) and told.track.width == pytest.approx(np.exp(vector[10]) * 1e-3)
    assert told.track.clamp_rotation_stiffness == pytest.approx(10**4.5)
    slider, track = build(told, "timoshenko")
    assert slider.stiffness.shape[0] == 57 and track.stiffness.shape[0] == 75, "nothing is held but by springs"
    assert described(RIGID).track.clamp_stiffness is None

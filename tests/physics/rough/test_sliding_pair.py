"""Friction of the rough pair: mu = limit * real area / pressure, and what the surfaces and the speed do to it."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.rough.contact.shear_limit import full_slip_displacement, solve_shear_limit
from pipeline.physics.rough.flash_temperature import ThermalSolid
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import graded_depth, layered_compliance
from pipeline.physics.rough.sliding_pair import (
    FAR,
    RoughPair,
    Rubbing,
    Shearing,
    Solving,
    Wearing,
    nodal_limit,
    passed,
    slide,
    states,
)

NODES, LENGTH = 32, 1e-3
SPACING = (LENGTH / NODES,) * 2
SPEEDS = np.array([1.0, 1.6])
SHEARING = Shearing(13.5e6, 1.3, 0.015, 5e-4, ThermalSolid(1.0, 2200.0, 1000.0), ThermalSolid(50.0, 7200.0, 500.0))
WEARING = Wearing(4, 1e-3, 2, 4e-12, 4e-13)
SOLVING = Solving(1e-5, 2000)


def pair(rms=3e-6):
    pad, disc = (rms * self_affine(np.random.default_rng(s), NODES, LENGTH, 2.5e-4, 5e-4, 0.8) for s in (1, 2))
    depth = graded_depth(SPACING[0], 1e-3, 1.5)
    solids = [layered_compliance((NODES, NODES), SPACING, depth, *data) for data in ((0.3e9, 0.25), (110e9, 0.26))]
    return RoughPair(pad, disc, SPACING, solids[0] + solids[1])


def rubbing(rms=3e-6, wearing=WEARING, shearing=SHEARING):
    return Rubbing(pair(rms), wearing, shearing, SOLVING)


@pytest.fixture(scope="module")
def record():
    return slide(rubbing(), 1e6, SPEEDS, [0, 2, 4])


@pytest.mark.exact
def test_friction_is_limit_times_real_area_over_pressure(record):
    np.testing.assert_allclose(record.friction, record.limit_at_speed * record.real_area / 1e6, rtol=1e-5)


@pytest.mark.exact
def test_friction_without_speed_effects_is_exact():
    plain = replace(SHEARING, rate=0.0, softening=0.0)
    record = slide(rubbing(wearing=replace(WEARING, cycles=0), shearing=plain), 1e6, SPEEDS, [0])
    np.testing.assert_allclose(record.friction, 13.5e6 * record.real_area / 1e6, rtol=1e-7)


def test_wear_raises_area_friction_approach_and_stiffness(record):
    for name in ("real_area", "friction", "approach", "normal_stiffness", "largest_wear"):
        assert np.all(np.diff(getattr(record, name), axis=1) > 0.0), name


def test_speed_has_a_small_real_influence(record):
    ratio = record.friction[1] / record.friction[0]
    assert np.all(np.abs(ratio - 1.0) > 1e-4) and np.all(np.abs(ratio - 1.0) < 0.02)
    assert np.all(record.flash_temperature[1] > record.flash_temperature[0])
    np.testing.assert_array_equal(record.real_area[0], record.real_area[1])


def test_rougher_surfaces_touch_less(record):
    rougher = slide(rubbing(4e-6, replace(WEARING, cycles=0)), 1e6, SPEEDS, [0])
    assert np.all(rougher.friction[:, 0] < 0.9 * record.friction[:, 0])


def test_maps_belong_to_the_records(record):
    new, worn = record.maps.contact_pressure[[0, -1]]
    assert new.mean() == pytest.approx(1e6, rel=1e-12)
    assert np.count_nonzero(worn) > np.count_nonzero(new)
    lost = record.maps.pad_height[0] - record.maps.pad_height[-1]
    np.testing.assert_allclose(lost, record.maps.pad_wear[-1], atol=1e-15)
    assert record.maps.pad_wear[-1].mean() == pytest.approx(4e-12 * 1e6 * 4e-3, rel=1e-12)


@pytest.mark.exact
def test_shear_of_every_speed_is_that_of_a_speed_alone():
    """The limit of a node scales with that of the spots, also where it rises with its pressure."""
    shearing = replace(SHEARING, pressure_coefficient=0.2)
    rubbed = rubbing(wearing=replace(WEARING, cycles=0, stroke=0), shearing=shearing)
    found = slide(rubbed, 1e6, SPEEDS, [0])
    pressure, compliance = found.maps.contact_pressure[0], rubbed.pair.compliance
    for speed, limit in enumerate(found.limit_at_speed[:, 0]):
        nodal = nodal_limit(pressure, rubbed, limit)
        slip = full_slip_displacement(nodal, compliance)
        shear = solve_shear_limit(nodal, compliance, FAR * (slip + compliance.along[0, 0] * nodal.mean()),
                                  **vars(SOLVING)).traction[0].mean()
        assert found.friction[speed, 0] == pytest.approx(shear / 1e6, rel=1e-12)
        assert found.full_slip_distance[speed, 0] == pytest.approx(slip, rel=1e-12)


def test_pressures_that_were_met_shorten_a_pass_and_do_not_change_it():
    rubbed = rubbing(wearing=replace(WEARING, cycles=30, distance=1e-4))
    *_, worn = states(rubbed, 1e6)
    warm, cold = passed(rubbed, worn, 1e6), passed(rubbed, replace(worn, met={}), 1e6)
    assert len(warm) == len(cold) == WEARING.stroke + 1
    assert sum(c.iterations for c in warm) < 0.7 * sum(c.iterations for c in cold)
    for one, other in zip(warm, cold, strict=True):
        np.testing.assert_allclose(one.pressure, other.pressure, atol=1e-4 * other.pressure.max())

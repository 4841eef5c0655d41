"""Equilibria, linearisation and modal coordinates of the pads on the rigid disc."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads.pad_system import (
    force,
    half_angles,
    linearised,
    pad_elements,
    pad_system,
    sliding_state,
    static_start,
    tangent,
)
from pipeline.physics.pads.patch_contact import contact_state, patch_shares
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.time_stepping.elements import Element, Polynomial, Power, Wave
from tests.physics.small_pads import block_on_belt, flutter, random_assembly


@pytest.mark.exact
def test_static_start_of_a_block_is_load_over_stiffness_without_friction():
    start = static_start(block_on_belt(load=50.0, stiffness=1e8))
    np.testing.assert_allclose(start, [0, -50e-8], rtol=1e-12, atol=1e-20)


@pytest.mark.exact
def test_steady_sliding_of_a_block_carries_friction_times_load():
    system = block_on_belt(load=50.0, friction=0.3, spring=1e5)
    state = sliding_state(system, static_start(system))
    assert state[0] == pytest.approx(0.3 * 50 / 1e5, rel=1e-12)


@pytest.mark.exact
def test_static_start_of_a_curved_law_is_an_equilibrium_with_open_contacts():
    system = random_assembly(count=8)
    system = system._replace(load=system.load + 300 * system.contact.rows[0, 0])
    start = static_start(system)
    normal = contact_state(system.contact, 0.0, start, 0 * start).normal
    assert 0 < np.sum(normal == 0) < 8
    np.testing.assert_allclose(system.stiffness @ start, system.load + normal @ system.contact.rows[0],
                               atol=1e-11 * np.linalg.norm(system.load))


@pytest.mark.exact
def test_linearised_stiffness_is_the_closed_form_of_flutter():
    k11, k22, k12, k_friction, mu = 9e6, 1.1e7, 5e5, 4e6, 0.45
    system = flutter(k11, k22, k12, k_friction, mu)
    stiffness, damping = linearised(system, sliding_state(system, static_start(system)))
    np.testing.assert_allclose(stiffness, [[k11, k12 - mu * k_friction], [k12, k22]], rtol=1e-9)
    np.testing.assert_allclose(damping, 0, atol=1e-12)


def pad_of_patches(along, across, height=0.003):
    """Centroids and areas of the annular-sector patches of one pad, which spans 0.87 rad from 95 to 150 mm."""
    edge, rim = np.linspace(-0.435, 0.435, along + 1), np.linspace(0.095, 0.15, across + 1)
    angle, radius = np.meshgrid((edge[1:] + edge[:-1]) / 2, (rim[1:] + rim[:-1]) / 2, indexing="ij")
    area = np.tile((edge[1] - edge[0]) / 2 * (rim[1:]**2 - rim[:-1]**2), along)
    centre = np.column_stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel(),
                              np.full(area.size, height)])
    return centre, area, angle.ravel()


@pytest.mark.exact
def test_patches_of_a_pad_meet_without_gap_or_overlap():
    """Partition of unity: on each circle the patches together carry each sub-disc by the share of the whole pad."""
    (centre, area, angle), (other, _, _) = pad_of_patches(6, 3), pad_of_patches(6, 3, -0.003)
    half = half_angles(np.vstack([centre, other]), np.tile(area, 2))
    np.testing.assert_allclose(half, 0.435 / 6, rtol=1e-12)
    for turned in np.linspace(0, 1.6, 23):
        patches = patch_shares(angle, half[:18], turned, 16).reshape(6, 3, 4).mean(axis=0)
        whole = patch_shares(np.zeros(3), np.full(3, 0.435), turned, 16)
        np.testing.assert_allclose(patches, whole, atol=1e-12)


@pytest.mark.exact
def test_a_patch_alone_on_its_circle_is_square():
    np.testing.assert_allclose(half_angles(np.array([[0.0, 0.1, 0.0], [0.12, 0.0, 0.0]]), np.array([4e-4, 9e-4])),
                               [0.1, 0.125], rtol=1e-12)


def test_an_assembly_that_nothing_holds_does_not_pass():
    loose = block_on_belt()
    loose = loose._replace(load=np.array([0.0, 50.0]))
    with pytest.raises(ConvergenceError, match="static start"):
        static_start(loose)


@pytest.mark.parametrize(("change", "expected"), [
    ({"sectors": 10}, "multiple of 4"), ({"bedding": (1.0, 2.0)}, "one per sub-disc"),
    ({"pressure": np.array([1.0, 2.0])}, "rise from 0"), ({"closure": np.array([0.0, 0.0])}, "rise from 0"),
])
def test_wrong_patches_and_laws_are_refused(change, expected):
    flat = FrictionLaw(*([1.0],) * 3, np.ones((1, 1, 1)))
    given = {"closure": np.array([0.0, 1.0]), "pressure": np.array([0.0, 1.0]), "bedding": (1.0,) * 4, "sectors": 16}
    with pytest.raises(ConfigError, match=expected):
        pad_system(None, None, friction=flat, bedding_share=1.0, ramp=0.0, stick_speed=1.0, damping_speed=1.0,
                   **{**given, **change})


@pytest.mark.exact
def test_elements_draw_and_the_tangent_is_their_slope():
    """A cubic spring, quadratic damping and a shaking force on one coordinate, also about a static start."""
    row = np.array([1.0, 0.0])
    laws = (Polynomial(cubic=4e12), Power(30.0), Wave(1.0, amplitude=5.0, order=3.0))
    system = block_on_belt()._replace(elements=pad_elements([Element(f"e {k}", row, law)
                                                             for k, law in enumerate(laws)], 2))
    place, rate, time = np.array([2e-5, -1e-6]), np.array([0.3, 0.0]), 0.01
    more = force(block_on_belt(), time, place, rate) - force(system, time, place, rate)
    wave = 5.0 * np.cos(3.0 * system.contact.disc_speed * time)
    np.testing.assert_allclose(more, [4e12 * place[0] ** 3 + 30 * 0.3**2 - wave, 0.0], rtol=1e-9)
    stiffness, damping = tangent(system, time, place, rate)
    plain = tangent(block_on_belt(), time, place, rate)
    np.testing.assert_allclose(stiffness - plain[0], np.diag([3 * 4e12 * place[0] ** 2, 0.0]), rtol=1e-9)
    np.testing.assert_allclose(damping - plain[1], np.diag([2 * 30 * 0.3, 0.0]), rtol=1e-9)
    modal, basis = preloaded_modes(system, place)
    np.testing.assert_allclose(force(modal, time, np.zeros(2), np.zeros(2)),
                               basis.T @ force(system, time, place, np.zeros(2)), rtol=1e-9)

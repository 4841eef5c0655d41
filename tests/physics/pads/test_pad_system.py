"""The pads on the rigid disc: patches, laws that are refused, elements."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads.pad_system import force, half_angles, pad_elements, pad_system, tangent
from pipeline.physics.pads.patch_contact import patch_shares
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.time_stepping.elements import Element, Polynomial, Power, Wave
from tests.physics.small_pads import block_on_belt


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

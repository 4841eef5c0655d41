"""Nodal diameters and axial share of known shapes."""

import numpy as np
import pytest

from pipeline.physics.fem.mesh import revolve
from pipeline.physics.modal.disc_modes import by_plane, describe

pytestmark = pytest.mark.exact


def test_axial_and_in_plane_waves():
    mesh = revolve(np.linspace(0.1, 0.2, 3), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2))
    angle = np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    shape = np.zeros((len(mesh.node), 3, 3))
    shape[:, 2, 0] = np.cos(3 * angle)
    shape[:, 2, 1] = 1.0
    shape[:, 0, 2], shape[:, 1, 2] = np.cos(5 * angle) * np.cos(angle), np.cos(5 * angle) * np.sin(angle)
    diameters, share = describe(mesh.node, shape.reshape(-1, 3))
    assert list(diameters) == [3, 0, 5]
    assert share == pytest.approx([1, 1, 0])


@pytest.mark.parametrize("digits", [5, 6])
def test_a_mesh_of_rounded_coordinates_has_the_same_rim(digits):
    """180 nodes around, as a mesh file in metres writes them; and no order is told that few nodes cannot tell."""
    mesh = revolve(np.linspace(0.1, 0.16, 3), np.linspace(0, 2 * np.pi, 181), np.linspace(0, 0.01, 2))
    angle = np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    shape = np.zeros((len(mesh.node), 3, 3))
    shape[:, 2] = np.stack([np.cos(2 * angle), np.sin(8 * angle), np.ones_like(angle)], axis=1)
    assert list(describe(mesh.node.round(digits), shape.reshape(-1, 3))[0]) == [2, 8, 0]
    few = revolve(np.linspace(0.1, 0.16, 3), np.linspace(0, 2 * np.pi, 13), np.linspace(0, 0.01, 2)).node
    wave = np.zeros((len(few), 3, 1))
    wave[:, 2, 0] = np.cos(5 * np.arctan2(few[:, 1], few[:, 0]))
    assert describe(few, wave.reshape(-1, 1))[0] == [5]


def test_waves_in_and_out_of_the_plane_are_counted_apart():
    """A tangential wave of 2 diameters with an axial one of 7, half as large: a fifth of the motion is axial."""
    mesh = revolve(np.linspace(0.1, 0.2, 3), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2))
    angle = np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    wave, shape = np.exp(2j * angle), np.zeros((len(mesh.node), 3, 1), complex)
    shape[:, 0, 0], shape[:, 1, 0] = -np.sin(angle) * wave, np.cos(angle) * wave
    shape[:, 2, 0] = 0.5 * np.exp(7j * angle)
    in_plane, out_of_plane, axial = by_plane(mesh.node, shape.reshape(-1, 1))
    assert (list(in_plane), list(out_of_plane)) == ([2], [7])
    assert axial == pytest.approx([0.2])
    assert list(describe(mesh.node, shape.reshape(-1, 1))[0]) == [2]

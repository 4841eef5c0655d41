"""Centre of gravity of a reduced body, against the mean over its mass."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.pads.pad_motion import gravity_rows, sliding_axes


def lumps(seed=3, nodes=7):
    """A lumped body in mixed coordinates: node masses, recovery (nodes, 3, 3 nodes), reduced mass."""
    rng = np.random.default_rng(seed)
    node_mass, mix = rng.uniform(0.1, 1, nodes), rng.normal(size=(3 * nodes, 3 * nodes))
    return node_mass, mix.reshape(nodes, 3, -1), mix.T @ (np.repeat(node_mass, 3)[:, None] * mix)


@pytest.mark.exact
def test_rows_are_the_mass_weighted_mean_of_the_motion():
    node_mass, recovery, mass = lumps()
    rng = np.random.default_rng(4)
    q, axes = rng.normal(size=mass.shape[0]), np.linalg.qr(rng.normal(size=(3, 3)))[0]
    expected = axes @ np.average(recovery @ q, axis=0, weights=node_mass)
    np.testing.assert_allclose(gravity_rows(mass, recovery, axes) @ q, expected, rtol=1e-8)


def test_coordinates_without_rigid_motion_are_refused():
    _, recovery, mass = lumps()
    with pytest.raises(ConfigError, match="rigid translations"):
        gravity_rows(mass[:2, :2], recovery[:, :, :2], np.eye(3))


@pytest.mark.exact
def test_axes_are_along_sliding_axial_and_radial():
    axes = sliding_axes(np.array([[0.0, 0.1, 0.02], [0.0, 0.12, 0.02]]))
    np.testing.assert_allclose(axes, [[-1, 0, 0], [0, 0, 1], [0, 1, 0]], atol=1e-15)

"""What the shapes of a disc's modes look like: nodal diameters and the share of axial motion."""

import numpy as np

_MOST_DIAMETERS = 40
#: share of the radius within which nodes lie on the rim, and angle in rad within which they lie at one place of it
_ROUNDED, _SAME = 1e-3, 1e-3


def describe(node, shape):
    """Nodal diameters (m,) and out-of-plane share (m,) of modes ``shape`` (3n, m), real or complex, of a disc about z.

    The diameters come from the Fourier components of the cylindrical displacement on the rim, as many as its nodes
    tell; the share is that of the squared nodal displacements.
    """
    power = _around(node, shape)
    return np.argmax(power.sum(axis=0), axis=0), _axial(node, shape)


def by_plane(node, shape):
    """Nodal diameters (m,) of the in-plane motion and (m,) of the out-of-plane motion of the same modes, and the
    out-of-plane share (m,)."""
    radial, tangential, axial = _around(node, shape)
    return np.argmax(radial + tangential, axis=0), np.argmax(axial, axis=0), _axial(node, shape)


def _around(node, shape):
    """Power (radial tangential axial, order, mode) of the waves around the rim."""
    motion = shape.reshape(len(node), 3, -1)
    radius, angle = np.hypot(node[:, 0], node[:, 1]), np.arctan2(node[:, 1], node[:, 0])
    rim = radius > radius.max() * (1 - _ROUNDED)
    around = 1 + np.count_nonzero(np.diff(np.sort(angle[rim])) > _SAME)
    c, s = np.cos(angle[rim])[:, None], np.sin(angle[rim])[:, None]
    x, y, z = np.moveaxis(motion[rim], 1, 0)
    cylindrical = np.stack((c * x + s * y, c * y - s * x, z))
    orders = np.arange(min(_MOST_DIAMETERS, around // 2) + 1)
    wave = np.exp(-1j * orders[:, None] * angle[rim])
    power = np.abs(wave @ cylindrical.real)**2 + np.abs(wave @ cylindrical.imag)**2
    return power * np.where(orders > 0, 2, 1)[:, None]


def _axial(node, shape):
    """Share (m,) of the axial direction in the squared displacements."""
    energy = (np.abs(shape.reshape(len(node), 3, -1))**2).sum(axis=0)
    return energy[2] / energy.sum(axis=0)

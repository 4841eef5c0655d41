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
    motion = shape.reshape(len(node), 3, -1)
    energy = (np.abs(motion)**2).sum(axis=0)
    radius, angle = np.hypot(node[:, 0], node[:, 1]), np.arctan2(node[:, 1], node[:, 0])
    rim = radius > radius.max() * (1 - _ROUNDED)
    around = 1 + np.count_nonzero(np.diff(np.sort(angle[rim])) > _SAME)
    c, s = np.cos(angle[rim])[:, None], np.sin(angle[rim])[:, None]
    x, y, z = np.moveaxis(motion[rim], 1, 0)
    cylindrical = np.stack((c * x + s * y, c * y - s * x, z))
    orders = np.arange(min(_MOST_DIAMETERS, around // 2) + 1)
    wave = np.exp(-1j * orders[:, None] * angle[rim])
    power = sum((np.abs(wave @ part)**2).sum(axis=0) for part in (cylindrical.real, cylindrical.imag))
    power = power * np.where(orders > 0, 2, 1)[:, None]
    return np.argmax(power, axis=0), energy[2] / energy.sum(axis=0)

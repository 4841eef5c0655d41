"""Natural frequencies of a free body of revolution, one nodal diameter at a time.

With u_r, u_z ~ cos(n theta) and u_theta ~ sin(n theta), only the section (r, z) is meshed: a
reference for three-dimensional meshes that costs next to nothing (Zienkiewicz and Taylor, The
Finite Element Method, volume 2, semi-analytical method).
"""

import numpy as np
import scipy

from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.reference_cells import quadrature, shape_functions

_KIND = "quad9"


def section_frequencies(radius, height, mask, young, poisson, density, diameters, count):
    """(count,) lowest frequencies [Hz], rigid motions included, with ``diameters`` nodal diameters.

    ``radius``, ``height``: lines of the section mesh [m]; ``mask`` (radii - 1, heights - 1): its cells.
    """
    node, element = _section(radius, height, mask)
    point, weight = quadrature(_KIND)
    shape, reference_gradient = shape_functions(_KIND, point)
    jacobian = np.einsum("evx,qvr->eqxr", node[element], reference_gradient)
    gradient = reference_gradient @ np.linalg.inv(jacobian)
    r = np.einsum("qv,ev->eq", shape, node[element][..., 0])
    volume = np.linalg.det(jacobian) * weight * r
    strain = _strain(gradient, shape, r, diameters)
    stress = isotropic(young, poisson) @ strain * volume[..., None, None]
    stiffness = np.einsum("eqsa,eqsb->eab", strain, stress, optimize=True)
    scalar = np.einsum("eq,qa,qb->eab", volume * density, shape, shape, optimize=True)
    mass = np.einsum("eab,ij->eaibj", scalar, np.eye(3)).reshape(stiffness.shape)
    freedom = (3 * element[..., None] + np.arange(3)).reshape(len(element), -1)
    square = scipy.linalg.eigh(*(_sum(m, freedom, 3 * len(node)) for m in (stiffness, mass)), eigvals_only=True,
                  subset_by_index=(0, count - 1))
    return np.sqrt(np.maximum(square, 0)) / (2 * np.pi)


def _section(radius, height, mask):
    r, z = (np.interp(np.arange(2 * len(a) - 1) / 2, np.arange(len(a)), a) for a in (radius, height))
    corner = 2 * np.argwhere(mask)[:, None] + np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2),
                                                        (0, 1), (1, 1)])
    used, element = np.unique(corner[..., 0] * len(z) + corner[..., 1], return_inverse=True)
    return np.stack((r[used // len(z)], z[used % len(z)]), axis=-1), element.reshape(corner.shape[:2])


def _strain(gradient, shape, r, n):
    """(e, q, 6, 3v): rr, tt, zz, tz, rz, rt from nodal u_r, u_theta, u_z."""
    e, q, v, _ = gradient.shape
    strain = np.zeros((e, q, 6, v, 3))
    d_r, d_z, over_r = gradient[..., 0], gradient[..., 1], shape / r[..., None]
    strain[:, :, 0, :, 0] = strain[:, :, 4, :, 2] = d_r
    strain[:, :, 2, :, 2] = strain[:, :, 3, :, 1] = strain[:, :, 4, :, 0] = d_z
    strain[:, :, 1, :, 0], strain[:, :, 1, :, 1] = over_r, n * over_r
    strain[:, :, 3, :, 2] = strain[:, :, 5, :, 0] = -n * over_r
    strain[:, :, 5, :, 1] = d_r - over_r
    return strain.reshape(e, q, 6, 3 * v)


def _sum(matrix, freedom, size):
    total = np.zeros((size, size))
    np.add.at(total, (freedom[:, :, None], freedom[:, None, :]), matrix)
    return total

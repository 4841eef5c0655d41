"""Stiffness of one trilinear brick (hex8), the building block of a layered solid.

Axes: x along sliding, y across, z along the outward normal of the surface. Vertex (a, b, c) with a, b, c in {0, 1} sits
at (a dx, b dy, -c dz): c = 0 is the face towards the surface, c = 1 the deeper one.
"""

from itertools import product

import numpy as np

from pipeline.physics.fem.elasticity import isotropic

GAUSS = (0.5 - 0.5 / np.sqrt(3.0), 0.5 + 0.5 / np.sqrt(3.0))


def brick_stiffness(edges, youngs_modulus, poisson_ratio):
    """Stiffness (2, 2, 2, 3, 2, 2, 2, 3) in N/m of an isotropic brick with ``edges`` (dx, dy, dz) in m.

    Axes of the result: vertex a, b, c and direction of the force, then the same of the displacement. Full 2 x 2 x 2
    Gauss quadrature, exact for a brick.
    """
    elasticity = isotropic(youngs_modulus, poisson_ratio)
    weight = np.prod(edges) / 8.0
    points = [_strain_operator(point, edges) for point in product(GAUSS, repeat=3)]
    return weight * sum(b.T @ elasticity @ b for b in points).reshape((2, 2, 2, 3) * 2)


def _strain_operator(point, edges):
    """Strain (6) of the 24 vertex displacements at ``point`` of the unit cube."""
    operator = np.zeros((6, 2, 2, 2, 3))
    value = [(1.0 - t, t) for t in point]
    slope = [(-s / length, s / length) for s, length in zip((1.0, 1.0, -1.0), edges, strict=True)]
    for a, b, c in product((0, 1), repeat=3):
        by_x = slope[0][a] * value[1][b] * value[2][c]
        by_y = value[0][a] * slope[1][b] * value[2][c]
        by_z = value[0][a] * value[1][b] * slope[2][c]
        operator[:, a, b, c] = [[by_x, 0, 0], [0, by_y, 0], [0, 0, by_z],
                                [0, by_z, by_y], [by_z, 0, by_x], [by_y, by_x, 0]]
    return operator.reshape(6, 24)

"""Plane Timoshenko beams as spectral elements: stiffness and consistent mass, with axial motion.

Deflection v, rotation psi and axial motion u are polynomials of one degree p on each segment, given at the
Gauss-Lobatto points (Patera, J. Comput. Phys. 54 (1984) 468), all integrals exact:

    2 V = int EI psi'^2 + kGA (v' - psi)^2 + EA u'^2 ds,    2 T = int rho A (u^2 + v^2) + rho I psi^2 ds (of rates).

The error falls faster than any power of p, and thin segments do not lock. Degrees of freedom per node: motion along x
and y, and the rotation about z.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from pipeline.physics.closed_form.elastic_constants import shear_modulus


@dataclass(frozen=True)
class BeamSection:
    """Rectangular section and material: ``height`` m in the plane, ``width`` m across it."""

    height: float
    width: float
    young: float
    poisson: float
    density: float

    @property
    def area(self):
        """Area, m^2."""
        return self.height * self.width

    @property
    def inertia(self):
        """Second moment of area, m^4."""
        return self.width * self.height**3 / 12

    @property
    def shear_stiffness(self):
        """kappa G A, N, with Cowper's kappa = 10 (1 + nu) / (12 + 11 nu) (J. Appl. Mech. 33 (1966) 335)."""
        factor = 10 * (1 + self.poisson) / (12 + 11 * self.poisson)
        return factor * shear_modulus(self.young, self.poisson) * self.area


@dataclass(frozen=True)
class Beam:
    """Nodes (n, 2) m; stiffness and mass (3n, 3n), dof = 3 node + (x, y, rotation)."""

    node: np.ndarray
    stiffness: np.ndarray
    mass: np.ndarray


def beam(stations, degree, section):
    """Straight Beam through ``stations`` (k, 2) m, one segment between neighbours; they are its nodes 0, p, 2 p, ..."""
    count = (len(stations) - 1) * degree + 1
    node, stiffness, mass = np.zeros((count, 2)), np.zeros((3 * count,) * 2), np.zeros((3 * count,) * 2)
    place, slope, value, weight = _polynomials(degree)
    for first, (start, end) in enumerate(zip(stations[:-1], stations[1:], strict=True)):
        along = end - start
        length = np.hypot(*along)
        node[first * degree:(first + 1) * degree + 1] = start + (place[:, None] + 1) / 2 * along
        dofs = slice(3 * first * degree, 3 * (first + 1) * degree + 3)
        strain, motion = _operators(along / length, slope * 2 / length, value)
        rigidity = np.array([section.young * section.area, section.shear_stiffness, section.young * section.inertia])
        inertia = section.density * np.array([section.area, section.area, section.inertia])
        for matrix, rows, factor in ((stiffness, strain, rigidity), (mass, motion, inertia)):
            matrix[dofs, dofs] += np.einsum("kqa,k,q,kqb->ab", rows, factor, weight * length / 2, rows, optimize=True)
    return Beam(node, stiffness, mass)


def _polynomials(degree):
    """(Lobatto points (p + 1,), slopes and values (q, p + 1) at Gauss points, Gauss weights (q,)) on -1..1."""
    inside = legendre.legroots(legendre.legder([0] * degree + [1])).real if degree > 1 else []    # NumPy 2.5: complex
    place = np.r_[-1.0, inside, 1.0]
    point, weight = legendre.leggauss(degree + 1)
    coefficients = np.linalg.inv(legendre.legvander(place, degree))
    value = legendre.legvander(point, degree) @ coefficients
    slope = legendre.legval(point, legendre.legder(coefficients)).T if degree else value
    return place, slope, value, weight


def _operators(direction, slope, value):
    """Strains (axial, shear, bending) and motions (along, across, turning), (3, q, 3 (p + 1)), of one segment."""
    (c, s), (points, nodes) = direction, value.shape
    strain, motion = np.zeros((2, 3, points, nodes, 3))
    motion[0, ..., 0], motion[0, ..., 1] = c * value, s * value
    motion[1, ..., 0], motion[1, ..., 1] = -s * value, c * value
    motion[2, ..., 2] = value
    strain[0, ..., 0], strain[0, ..., 1] = c * slope, s * slope
    strain[1, ..., 0], strain[1, ..., 1], strain[1, ..., 2] = -s * slope, c * slope, -value
    strain[2, ..., 2] = slope
    return (a.reshape(3, points, 3 * nodes) for a in (strain, motion))

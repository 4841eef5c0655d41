"""Plane stress on quadrilaterals of second order: stiffness and mass of a sheet of constant width.

Shape functions and quadrature are scikit-fem's, as in ``elasticity``; strains xx, yy, xy (engineering shear). Degree of
freedom = 2 node + axis.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.elastic_constants import plane_strain_modulus
from pipeline.physics.fem.reference_cells import quadrature, reference_vertices, shape_functions

_KIND = "quad9"


@dataclass(frozen=True)
class Sheet:
    """Nodes (n, 2) m; ``lattice`` (k, l) node numbers, along and across; stiffness and mass (2n, 2n) CSR."""

    node: np.ndarray
    lattice: np.ndarray
    stiffness: "scipy.sparse.csr_matrix"
    mass: "scipy.sparse.csr_matrix"


def sheet(start, direction, along, across, section):
    """Rectangle of the cells between the lines ``along`` (from ``start`` in ``direction``) and ``across`` it.

    ``start`` (2,) m, ``direction`` (2,) a unit vector, ``across`` to its left; ``section`` gives width and material (a
    BeamSection). Every cell is one element with nodes halfway. Raises ConfigError for lines that do not ascend.
    """
    lines = [_halved(np.asarray(line, float), name) for line, name in ((along, "along"), (across, "across"))]
    first, second = np.meshgrid(*lines, indexing="ij")
    left = np.array([-direction[1], direction[0]])
    node = (start + first[..., None] * direction + second[..., None] * left).reshape(-1, 2)
    lattice = np.arange(len(node)).reshape(first.shape)
    first = (np.arange(0, len(line) - 1, 2) for line in lines)
    corner = np.stack(np.meshgrid(*first, indexing="ij"), -1).reshape(-1, 2)
    position = corner[:, None] + (2 * reference_vertices(_KIND)).astype(int)
    element = lattice[position[..., 0], position[..., 1]]
    stiffness, mass = _element_matrices(node[element], section)
    return Sheet(node, lattice, _summed(stiffness, element, len(node)), _summed(mass, element, len(node)))


def plane_elasticity(young, poisson):
    """(3, 3) Pa: stresses xx, yy, xy from strains under plane stress."""
    shear = (1 - poisson) / 2
    return plane_strain_modulus(young, poisson) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, shear]])


def _halved(line, name):
    if len(line) < 2 or not (np.diff(line) > 0).all():
        raise ConfigError(f"plane mesh, lines {name}", "at least two that ascend", np.array2string(line, precision=5))
    return np.interp(np.arange(2 * len(line) - 1) / 2, np.arange(len(line)), line)


def _element_matrices(corner, section):
    """(e, 18, 18) stiffness and mass of elements with nodes ``corner`` (e, 9, 2)."""
    point, weight = quadrature(_KIND)
    shape, slope = shape_functions(_KIND, point)
    jacobian = np.einsum("evx,qvr->eqxr", corner, slope)
    volume = np.linalg.det(jacobian) * weight * section.width
    gradient = slope @ np.linalg.inv(jacobian)
    strain = np.zeros((*gradient.shape[:2], 3, gradient.shape[2], 2))
    strain[:, :, 0, :, 0], strain[:, :, 1, :, 1] = gradient[..., 0], gradient[..., 1]
    strain[:, :, 2, :, 0], strain[:, :, 2, :, 1] = gradient[..., 1], gradient[..., 0]
    strain = strain.reshape(*strain.shape[:3], -1)
    elasticity = plane_elasticity(section.young, section.poisson)
    stiffness = np.einsum("eq,eqia,ij,eqjb->eab", volume, strain, elasticity, strain, optimize=True)
    scalar = np.einsum("eq,qa,qb->eab", section.density * volume, shape, shape, optimize=True)
    return stiffness, np.kron(scalar, np.eye(2)[None])


def _summed(matrix, element, nodes):
    dof = (2 * element[..., None] + np.arange(2)).reshape(len(element), -1)
    rows, columns = np.repeat(dof, dof.shape[1], axis=1).ravel(), np.tile(dof, dof.shape[1]).ravel()
    return scipy.sparse.csr_matrix((matrix.ravel(), (rows, columns)), (2 * nodes, 2 * nodes))

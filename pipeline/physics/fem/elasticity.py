"""Linear elasticity on hexahedra, tetrahedra and wedges: stiffness, mass and the matrices of rotation.

Stiffness and mass are formed element by element and added at once (``elastic_sums``), the others in batches. Degree of
freedom = 3 node + axis; strains in the order xx yy zz yz xz xy (shear as engineering strain); vertices in the
order of meshio; cells of several kinds as ``reference_cells`` describes them.
"""

from functools import wraps

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.elastic_constants import shear_modulus
from pipeline.physics.fem.elastic_sums import elastic_sums
from pipeline.physics.fem.node_graph import summed_scalars
from pipeline.physics.fem.reference_cells import by_kind, quadrature, shape_functions

#: share of the 2 x 2 x 2 points in the stiffness: they let thin parts bend freely, the rest holds hourglass shapes
_REDUCED_SHARE = {"hexahedron20": 0.95}
_REDUCED_ORDER = 3
#: (row, column) of the symmetric tensor behind each of the six strains
_VOIGT = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
_BATCH = 256


def isotropic(young, poisson):
    """(6, 6) elasticity [Pa] of an isotropic material."""
    return orthotropic((young,) * 3, (poisson,) * 3, (shear_modulus(young, poisson),) * 3)


def orthotropic(young, poisson, shear):
    """(6, 6) elasticity [Pa] of an orthotropic material along x, y, z.

    ``young`` = (E_x, E_y, E_z), ``poisson`` = (nu_yz, nu_xz, nu_xy) with nu_ij = -strain_j / strain_i
    under stress along i, ``shear`` = (G_yz, G_xz, G_xy). Raises ConfigError where the strain
    energy would not be positive.
    """
    compliance = np.diag(1 / np.r_[young, shear].astype(float))
    for nu, (i, j) in zip(poisson, ((1, 2), (0, 2), (0, 1)), strict=True):
        compliance[i, j] = compliance[j, i] = -nu / young[i]
    if np.linalg.eigvalsh(compliance)[0] <= 0:
        raise ConfigError("elastic constants", "a positive strain energy (|nu_ij| < sqrt(E_i / E_j), nu < 1/2)",
                          f"E = {tuple(young)}, nu = {tuple(poisson)}, G = {tuple(shear)}")
    return np.linalg.inv(compliance)


def _each_kind(function):
    """``function`` (node, element, kind, material, ...) of a mesh with cells of several kinds: the sum over them."""
    @wraps(function)
    def summed(node, element, kind, material, *rest):
        parts = [function(node, cells, each, np.asarray(material)[rows], *rest)
                 for each, rows, cells in by_kind(kind, element)]
        if isinstance(parts[0], tuple):
            return tuple(sum(same[1:], same[0]) for same in zip(*parts, strict=True))
        return sum(parts[1:], parts[0])
    return summed


@_each_kind
def assemble(node, element, kind, material, density, elasticity):
    """Stiffness and consistent mass of an elastic body.

    Parameters
    ----------
    node : (n, 3) array [m]
    element : (e, v) integer array, vertices in the order of meshio
    kind : "hexahedron", "hexahedron20", "hexahedron27", "tetra10", "wedge15" or "mixed"
    material : (e,) integer array, row of the two tables
    density : (m,) array [kg/m^3]
    elasticity : (m, 6, 6) array [Pa]

    Returns
    -------
    stiffness [N/m], mass [kg] : (3n, 3n) CSR; dof = 3 node + axis

    Raises ConfigError for an unknown kind or an element turned inside out.
    """
    point, weight = quadrature(kind)
    shape, gradient = shape_functions(kind, point)
    carried = weight
    if kind in _REDUCED_SHARE:
        share, (fewer, reduced) = _REDUCED_SHARE[kind], quadrature(kind, _REDUCED_ORDER)
        gradient = np.concatenate((gradient, shape_functions(kind, fewer)[1]))
        weight = np.concatenate(((1 - share) * weight, share * reduced))
    stiffness, mass = elastic_sums(node, element, material, (gradient, weight, shape, carried), elasticity, density)
    if stiffness is None:
        raise _inside_out(*mass)
    return stiffness, mass


@_each_kind
def gyroscopic(node, element, kind, material, density):
    """Matrices of a body that turns about z, seen from the frame at rest.

    A particle passing the place x moves with Omega e_z x x + u' + Omega d_theta u, where d_theta =
    x d_y - y d_x acts on the Cartesian components. Its inertia adds Omega G q' - Omega^2 H q with
        G_ab = int rho (N_a d_theta N_b - d_theta N_a N_b) dV,    H_ab = int rho d_theta N_a d_theta N_b dV
    per axis; exact for bodies of revolution about z.

    Returns (gyroscopic G [kg per rad/s], convective H [kg]) as (3n, 3n) CSR.
    """
    density = np.asarray(density)

    def matrices(gradient, shape, volume, rows):
        mass = volume * density[material[rows]][:, None]
        x, y = np.moveaxis((shape @ node[element[rows]])[..., :2], -1, 0)
        turn = x[..., None] * gradient[..., 1] - y[..., None] * gradient[..., 0]
        product = _products(np.broadcast_to(shape, turn.shape), turn, mass)
        return product - product.swapaxes(1, 2), _products(turn, turn, mass)

    whirl, convective = _element_matrices(node, element, kind, matrices)
    return summed_scalars(whirl, element, len(node)), summed_scalars(convective, element, len(node))


@_each_kind
def centrifugal_load(node, element, kind, material, density):
    """(3n,) nodal forces of rotation about z per squared speed [N s^2]: int rho N (x, y, 0) dV."""
    def loads(gradient, shape, volume, rows):
        mass = volume * np.asarray(density)[material[rows]][:, None]
        position = (shape @ node[element[rows]]) * (1, 1, 0)
        return (np.einsum("eq,qa,eqx->eax", mass, shape, position, optimize=True),)

    load = np.zeros((len(node), 3))
    np.add.at(load, element, _element_matrices(node, element, kind, loads)[0])
    return load.ravel()


@_each_kind
def geometric_stiffness(node, element, kind, material, elasticity, displacement):
    """Stiffness (3n, 3n) CSR of the stresses under a (3n,) displacement: int dN_a . sigma dN_b dV.

    With the displacement under ``centrifugal_load`` it is the stiffening per squared speed.
    """
    moved, elasticity = displacement.reshape(-1, 3), np.asarray(elasticity)

    def matrices(gradient, shape, volume, rows):
        e, q = volume.shape
        strain = _strain(gradient) @ moved[element[rows]].reshape(e, 1, -1, 1)
        voigt = (elasticity[material[rows]][:, None] @ strain)[..., 0]
        stress = np.empty((e, q, 3, 3))
        for k, (i, j) in enumerate(_VOIGT):
            stress[..., i, j] = stress[..., j, i] = voigt[..., k]
        return (np.einsum("eq,eqai,eqij,eqbj->eab", volume, gradient, stress, gradient, optimize=True),)

    return summed_scalars(_element_matrices(node, element, kind, matrices)[0], element, len(node))


def _element_matrices(node, element, kind, matrices):
    """Run ``matrices(gradient, shape, volume, rows)`` over batches of elements; join the results."""
    point, weight = quadrature(kind)
    shape, reference_gradient = shape_functions(kind, point)
    results = []
    for start in range(0, len(element), _BATCH):
        rows = slice(start, start + _BATCH)
        jacobian = np.einsum("evx,qvr->eqxr", node[element[rows]], reference_gradient, optimize=True)
        volume = np.linalg.det(jacobian)
        if volume.min() <= 0:
            worst = start + int(np.argmin(volume.min(axis=1)))
            raise _inside_out(worst, volume.min())
        gradient = reference_gradient @ np.linalg.inv(jacobian)
        results.append(matrices(gradient, shape, volume * weight, rows))
    return tuple(np.concatenate(parts) for parts in zip(*results, strict=True))


def _strain(gradient):
    """B: (..., v, 3) gradients -> (..., 6, 3v)."""
    strain = np.zeros((*gradient.shape[:-2], 6, gradient.shape[-2], 3))
    for row, (i, j) in enumerate(_VOIGT):
        strain[..., row, :, j] = gradient[..., i]
        strain[..., row, :, i] = gradient[..., j]
    return strain.reshape(*strain.shape[:-2], -1)


def _products(left, right, weight):
    """(e, v, v): sum over the points of weight * left_a * right_b."""
    return (left * weight[..., None]).swapaxes(-1, -2) @ right


def _inside_out(element, volume):
    return ConfigError(f"mesh, element {element}", "a positive Jacobian", f"{volume:.3g} m^3",
                       "check its vertex order (meshio) and its shape")

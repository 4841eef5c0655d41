"""Elastic materials as decks give them, in the units of the deck."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.elastic_constants import shear_modulus
from pipeline.physics.fem.elasticity import orthotropic

#: elastic constants of two directions agree within this share where a material is isotropic
_SAME = 1e-6
#: (row, column) of the 21 constants of an elastic matrix: its upper triangle row by row, and column by column
BY_ROWS = tuple((i, j) for i in range(6) for j in range(i, 6))
BY_COLUMNS = tuple((i, j) for j in range(6) for i in range(j + 1))


@dataclass(frozen=True)
class Unread:
    """An elastic law that is not read: ``where`` it stands, what was ``found`` there, and what to write instead."""

    where: str
    found: str
    remedy: str


@dataclass(frozen=True)
class Material:
    """Constants along three axes, in the order of ``elasticity.orthotropic``, and the density; None where not given.

    ``young`` (x, y, z), ``poisson`` and ``shear`` (yz, xz, xy); ``axes`` (3, 3): rows are the axes of the material.
    ``matrix`` (6, 6): the elasticity itself where shear is coupled with other strains, which no such constants tell;
    ``unread``: an elastic law of the deck that is not read, whose place no default may take.
    """

    name: str
    young: tuple | None = None
    poisson: tuple | None = None
    shear: tuple | None = None
    density: float | None = None
    axes: np.ndarray | None = None
    matrix: np.ndarray | None = None
    unread: Unread | None = None

    @property
    def isotropic(self):
        """Whether there are constants, and they are the same in all directions."""
        if self.young is None or self.matrix is not None:
            return False
        alike = all(np.ptp(each) <= _SAME * np.max(np.abs(each)) for each in (self.young, self.poisson, self.shear))
        if not alike or self.poisson[0] == -1:
            return False
        expected = shear_modulus(self.young[0], self.poisson[0])
        return bool(abs(self.shear[0] - expected) <= _SAME * abs(expected))

    def with_isotropic(self, young, poisson):
        """This material with a Young's modulus and a Poisson's ratio; for -1, which is none, the shear modulus is 0."""
        shear = 0.0 if poisson == -1 else shear_modulus(young, poisson)
        return self.with_constants((young,) * 3, (poisson,) * 3, (shear,) * 3)

    def with_constants(self, young, poisson, shear):
        """This material with these constants along three axes."""
        return replace(self, young=young, poisson=poisson, shear=shear, matrix=None, unread=None)

    def with_matrix(self, matrix, where):
        """This material with an elasticity (6, 6) in the order of strains of ``elasticity.orthotropic``.

        Raises ConfigError at ``where`` for one that stores no positive energy.
        """
        if np.linalg.eigvalsh(matrix)[0] <= 0:
            raise ConfigError(f"{where}, material {self.name}", "elastic constants of a positive strain energy",
                              f"a lowest eigenvalue of {np.linalg.eigvalsh(matrix)[0]:.3g}", "check their order")
        compliance = np.linalg.inv(matrix)
        young = 1 / np.diag(compliance)[:3]
        poisson = tuple(float(-compliance[i, j] * young[i]) for i, j in ((1, 2), (0, 2), (0, 1)))
        shear = matrix[3:, 3:]
        coupled = np.append(matrix[:3, 3:], shear - np.diag(np.diag(shear)))
        made = self.with_constants(tuple(map(float, young)), poisson, tuple(map(float, 1 / np.diag(compliance)[3:])))
        return replace(made, matrix=matrix) if abs(coupled).max() > _SAME * abs(matrix).max() else made

    def scaled(self, pressure, density):
        """The same in other units: their factors of stresses and densities."""
        return replace(self, density=None if self.density is None else density * self.density,
                       matrix=None if self.matrix is None else pressure * self.matrix,
                       **{name: None if (values := getattr(self, name)) is None else
                          tuple(pressure * value for value in values) for name in ("young", "shear")})

    def elasticity(self):
        """(6, 6) elasticity along the axes of the deck; raises ConfigError where the energy is not positive."""
        local = orthotropic(self.young, self.poisson, self.shear) if self.matrix is None else self.matrix
        return local if self.axes is None else rotated(local, self.axes)


def symmetric(values, pairs, order):
    """(6, 6) elastic matrix of the 21 ``values`` at ``pairs`` (BY_ROWS or BY_COLUMNS); ``order`` (6,): which of the
    strains xx, yy, zz, yz, xz, xy each row of the deck is."""
    matrix = np.zeros((6, 6))
    for value, (i, j) in zip(values, pairs, strict=True):
        matrix[order[i], order[j]] = matrix[order[j], order[i]] = value
    return matrix


#: (row, column) of the symmetric tensor behind each of the six strains
_VOIGT = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def rotated(elasticity, axes):
    """(6, 6) elasticity along x, y, z of one that is given along ``axes``, (3, 3) whose rows are unit vectors."""
    first, second = np.array(_VOIGT).T
    turned = axes[first][:, first] * axes[second][:, second]    # stress along the axes -> along x, y, z (Bond)
    turned += np.where(first != second, 1.0, 0.0)[:, None] * axes[second][:, first] * axes[first][:, second]
    return turned.T @ elasticity @ turned

"""Elastic materials as decks give them, in the units of the deck."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.closed_form.elastic_constants import shear_modulus
from pipeline.physics.fem.elasticity import orthotropic

#: elastic constants of two directions agree within this share where a material is isotropic
_SAME = 1e-6


@dataclass(frozen=True)
class Material:
    """Constants along three axes, in the order of ``elasticity.orthotropic``, and the density; None where not given.

    ``young`` (x, y, z), ``poisson`` and ``shear`` (yz, xz, xy); ``axes`` (3, 3): rows are the axes of the material.
    """

    name: str
    young: tuple | None = None
    poisson: tuple | None = None
    shear: tuple | None = None
    density: float | None = None
    axes: np.ndarray | None = None

    @property
    def isotropic(self):
        """Whether there are constants, and they are the same in all directions."""
        if self.young is None:
            return False
        alike = all(np.ptp(each) <= _SAME * np.max(np.abs(each)) for each in (self.young, self.poisson, self.shear))
        if not alike or self.poisson[0] == -1:
            return False
        expected = shear_modulus(self.young[0], self.poisson[0])
        return bool(abs(self.shear[0] - expected) <= _SAME * abs(expected))

    def with_isotropic(self, young, poisson):
        """This material with a Young's modulus and a Poisson's ratio; for -1, which is none, the shear modulus is 0."""
        shear = 0.0 if poisson == -1 else shear_modulus(young, poisson)
        return replace(self, young=(young,) * 3, poisson=(poisson,) * 3, shear=(shear,) * 3)

    def scaled(self, pressure, density):
        """The same in other units: their factors of stresses and densities."""
        return replace(self, density=None if self.density is None else density * self.density,
                       **{name: None if (values := getattr(self, name)) is None else
                          tuple(pressure * value for value in values) for name in ("young", "shear")})

    def elasticity(self):
        """(6, 6) elasticity along the axes of the deck; raises ConfigError where the energy is not positive."""
        local = orthotropic(self.young, self.poisson, self.shear)
        return local if self.axes is None else rotated(local, self.axes)


#: (row, column) of the symmetric tensor behind each of the six strains
_VOIGT = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def rotated(elasticity, axes):
    """(6, 6) elasticity along x, y, z of one that is given along ``axes``, (3, 3) whose rows are unit vectors."""
    tensor = np.empty((3,) * 4)
    for row, (i, j) in enumerate(_VOIGT):
        for column, (k, m) in enumerate(_VOIGT):
            for pair in ((i, j), (j, i)):
                tensor[(*pair, k, m)] = tensor[(*pair, m, k)] = elasticity[row, column]
    turned = np.einsum("abcd,ai,bj,ck,dl->ijkl", tensor, axes, axes, axes, axes, optimize=True)
    first, second = np.array(_VOIGT).T
    return turned[first[:, None], second[:, None], first, second]

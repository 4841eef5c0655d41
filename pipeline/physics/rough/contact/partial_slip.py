"""Friction from rest: how far the shear of a contact has come when part of its spots slip."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.rough.contact.shear_limit import full_slip_displacement, solve_shear_limit

#: share of the displacement of full slip at which next to no node slips
_STICKING = 0.01


@dataclass(frozen=True)
class Presliding:
    """``shear`` (n,) in Pa, mean over the nominal area, at ``displacement`` (n,) in m of the bases less the uniform
    shear of the blocks; ``stiffness`` in Pa/m at rest, where all nodes stick."""

    displacement: np.ndarray
    shear: np.ndarray
    stiffness: float


def presliding(limit, compliance, shares, tolerance=1e-4, max_iterations=5000):
    """Presliding of nodes with a shear ``limit`` (ny, nx) in Pa, 0 where open, at ``shares`` (n,) of the displacement
    at which all slip. ``compliance``: SurfaceCompliance of both solids. ConvergenceError as of ``solve_shear_limit``.
    """
    along = compliance.along.copy()
    along[0, 0] = 0.0
    rough = replace(compliance, along=along)
    full = full_slip_displacement(limit, compliance)
    rest, *shear = (solve_shear_limit(limit, rough, share * full, tolerance, max_iterations).traction[0].mean()
                    for share in (_STICKING, *shares))
    return Presliding(full * np.array(shares), np.array(shear), rest / (_STICKING * full))

"""Systems of a Hessian I + J'J, which the prior keeps regular however large J is and however alike its columns.

Beside a J'J of 1e16 the prior's 1 is lost in rounding. Scaled to a unit diagonal, what rounding leaves of an eigenvalue
says nothing: along such a direction a value counts as not measured, as uncertain as its prior. So does what rounding
leaves of a right-hand side.
"""

import numpy as np

#: largest element of a Hessian whose rounding leaves the prior's 1 as it is
_PLAIN = 1e10


def solved(hessian, right):
    """H^-1 b of Hessians (..., k, k) and right-hand sides (..., k, n), or (k,) of one."""
    if _plain(hessian):
        return np.linalg.solve(hessian, right)
    root = _inverse_root(hessian)[0]
    across = np.swapaxes(root, -1, -2)
    along, terms = across @ right, np.abs(across) @ np.abs(right)
    return root @ np.where(np.abs(along) > _rounding(hessian) * terms, along, 0.0)


def inverse(hessian):
    """H^-1 of Hessians (..., k, k)."""
    if _plain(hessian):
        return np.linalg.inv(hessian)
    root = _inverse_root(hessian)[0]
    return root @ np.swapaxes(root, -1, -2)


def log_determinant(hessian):
    """ln det H (...) of Hessians (..., k, k)."""
    return np.linalg.slogdet(hessian)[1] if _plain(hessian) else _inverse_root(hessian)[1]


def _plain(hessian):
    return np.abs(hessian).max(initial=0.0) < _PLAIN


def _rounding(hessian):
    """Relative rounding of sums over the rows of Hessians (..., k, k)."""
    return 10 * np.finfo(float).eps * hessian.shape[-1]


def _inverse_root(hessian):
    """(R (..., k, k) with H^-1 = R R', ln det H (...))."""
    scale = np.sqrt(np.einsum("...ii->...i", hessian))
    values, basis = np.linalg.eigh(hessian / (scale[..., :, None] * scale[..., None, :]))
    lost = values <= _rounding(hessian) * values.max(axis=-1, initial=1.0, keepdims=True)
    along = np.einsum("...i,...ik->...k", scale**-2.0, basis**2)       # of the prior, which is I, in these directions
    values = np.where(lost, along, np.maximum(values, along))
    return (basis / scale[..., :, None] / np.sqrt(values)[..., None, :],
            2 * np.log(scale).sum(axis=-1) + np.log(values).sum(axis=-1))

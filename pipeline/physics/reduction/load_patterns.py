"""Smooth patterns of contact force, whose static responses stand for those to the forces of many single contacts.

A contact face read at hundreds of points would need a static response for each force at each of them, nearly all of
which are finer than any motion of interest. Forces that vary over the face as polynomials of rising order span the
smooth ones; motions still act on every contact, so more patterns add what the finer parts of its force deform.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError


def load_patterns(position, area, group, orders):
    """(c, m) forces of contacts in every pattern.

    Parameters
    ----------
    position : (c, 3) [m]; area : (c,) [m^2], which weighs the force of a contact
    group : (c,) contacts of one number lie on one face
    orders : highest order of the Legendre polynomials along the longest and the second axis of each face

    A face with no more contacts than patterns has one pattern for each of its contacts. Raises ConfigError for orders
    below 0.
    """
    if min(orders) < 0:
        raise ConfigError("load patterns", "orders of at least 0", f"{tuple(orders)}")
    faces = (_on_face(position[group == g], area[group == g], orders) for g in np.unique(group))
    rows = np.argsort(np.argsort(group, kind="stable"), kind="stable")
    return scipy.sparse.block_diag([scipy.sparse.csr_matrix(face) for face in faces], format="csr")[rows]


def _on_face(position, area, orders):
    """(c, m) patterns of one face."""
    count = (orders[0] + 1) * (orders[1] + 1)
    if len(area) <= count:
        return np.eye(len(area))
    centred = position - position.mean(axis=0)
    along = centred @ np.linalg.svd(centred, full_matrices=False)[2][:2].T
    first, second = (np.polynomial.legendre.legvander(_scaled(x), order)
                     for x, order in zip(along.T, orders, strict=True))
    return area[:, None] * np.einsum("ia,ib->iab", first, second).reshape(len(area), count)


def _scaled(x):
    """``x`` from -1 to 1; 0 where it does not vary."""
    middle, half = (x.max() + x.min()) / 2, np.ptp(x) / 2
    return (x - middle) / half if half > 0 else 0 * x

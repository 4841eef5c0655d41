"""Static forces of unilateral contacts on springs, without friction: the state that sliding begins from."""

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError

_ROUNDS = 100
#: share of the load that counts as rounding
_ROUNDING = 1e-9


def static_forces(stiffness, load, normal, gap, compliance):
    """Normal forces (c,) N of contacts in equilibrium: K q = load + n^T N, n q + gap + compliance N >= 0, N >= 0.

    ``stiffness`` (n, n) N/m may leave motions free that nothing loads; ``normal`` (c, n), ``gap`` (c,) m,
    ``compliance`` (c,) m/N, 0 for a hard contact. Raises ConfigError where a load meets neither spring nor contact,
    ConvergenceError where no set of closed contacts fits.
    """
    closed = np.ones(len(gap), bool)
    for _ in range(_ROUNDS):
        rows = normal[closed]
        matrix = np.block([[stiffness, -rows.T], [rows, np.diag(compliance[closed])]])
        wanted = np.r_[load, -gap[closed]]
        found = np.linalg.lstsq(matrix, wanted)[0]
        force = np.zeros(len(gap))
        force[closed] = found[len(load):]
        balance = stiffness @ found[:len(load)] - normal.T @ force - load
        apart = matrix[len(load):] @ found - wanted[len(load):]
        size = abs(matrix[len(load):]) @ abs(found) + abs(gap[closed])
        if (abs(apart) > _ROUNDING * size).any():
            raise ConfigError("static contact forces", "hard contacts that can close together",
                              f"gaps that miss each other by {abs(apart).max():g} m",
                              "change the gaps, or let them yield")
        if abs(balance).max(initial=0.0) > _ROUNDING * max(abs(load).max(initial=0.0), abs(force).max(initial=0.0)):
            raise ConfigError("static contact forces", "loads that springs and contacts can hold",
                              f"{abs(balance).max():g} N that nothing holds", "support the mass, or press it on")
        opened, touching = closed & (force < 0), ~closed & (gap + normal @ found[:len(load)] < 0)
        if not opened.any() and not touching.any():
            return force
        closed = (closed & ~opened) | touching
    raise ConvergenceError("static contact forces", "contacts that stay open or closed", "ones that change in turn",
                           "check gaps and loads")

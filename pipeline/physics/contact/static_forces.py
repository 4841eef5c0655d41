"""Static forces of unilateral contacts on springs, without friction: the state that sliding begins from.

For lumped systems, which may move freely where nothing loads them, and whose contacts may be hard: they have neither
the compliance nor the closures that ``static_preload`` solves for.
"""

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
    closed, scale = np.ones(len(gap), bool), abs(np.diag(stiffness)).max(initial=0.0) or 1.0     # all unknowns in N
    for _ in range(_ROUNDS):
        rows = normal[closed]
        matrix = np.block([[stiffness / scale, -rows.T], [rows, np.diag(scale * compliance[closed])]])
        wanted = np.r_[load, -scale * gap[closed]]
        forces = np.linalg.lstsq(matrix, wanted)[0]
        _check_balance(matrix @ forces - wanted, len(load), max(abs(wanted).max(), abs(forces).max()), scale)
        displacement, force = forces[:len(load)] / scale, np.zeros(len(gap))
        force[closed] = forces[len(load):]
        opened, touching = closed & (force < 0), ~closed & (gap + normal @ displacement < 0)
        if not opened.any() and not touching.any():
            return force
        closed = (closed & ~opened) | touching
    raise ConvergenceError("static contact forces", "contacts that stay open or closed", "ones that change in turn",
                           "check gaps and loads")


def _check_balance(miss, size, largest, scale):
    """Refuse forces that nothing holds, and hard contacts that cannot close together."""
    if abs(miss[:size]).max() > _ROUNDING * largest:
        raise ConfigError("static contact forces", "loads that springs and contacts can hold",
                          f"{abs(miss[:size]).max():g} N that nothing holds", "support the mass, or press it on")
    if abs(miss[size:]).max(initial=0.0) > _ROUNDING * largest:
        raise ConfigError("static contact forces", "hard contacts that can close together",
                          f"gaps that miss each other by {abs(miss[size:]).max() / scale:g} m",
                          "change the gaps, or let them yield")

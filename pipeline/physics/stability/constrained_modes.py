"""Steady sliding on hard contacts (Lagrange multipliers), linearised: complex modes under the constraint n q = 0.

    M q'' + C q' + K q = h N,    n q = 0,    h = n^T + t^T sgn(v) (mu + p dmu/dp),                                 (1)

with the contact forces N as multipliers (Lorang, Foy-Margiocchi, Nguyen & Gautier, J. Sound Vib. 290 (2006) 892). The
motions allowed are q = Z r, n Z = 0, Z^T M Z = 1; forces along h are invisible to the left basis

    Y^T = Z^T (1 - h (n M^-1 h)^-1 n M^-1),    Y^T h = 0,    Y^T M Z = 1,

so that r'' + Y^T C Z r' + Y^T K Z r = 0: left and right bases differ by friction, and K becomes unsymmetric. Where
n M^-1 h is no longer positive, the contact jams: a force would press the bodies together (Painleve).
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.model import FrictionState

#: growth below this share of the angular frequency is rounding
_NEUTRAL = 1e-6


@dataclass(frozen=True)
class HardSliding:
    """``damping`` and ``stiffness`` (m, m) of the allowed motions r, whose mass is 1; q = ``basis`` r, (n, m), and
    equations tested by ``left`` Y^T (m, n)."""

    damping: np.ndarray
    stiffness: np.ndarray
    basis: np.ndarray
    left: np.ndarray


def is_hard(model):
    """True where all contacts are loaded without yielding: no contact stiffness.

    Raises ConfigError where only some of them are so, or where friction joints stand beside them.
    """
    contacts = model.contacts
    rigid = (contacts.preload > 0) & (contacts.stiffness == 0) & ~contacts.fixed
    if rigid.any() and not rigid.all():
        raise ConfigError("hard contacts", "all contacts loaded and hard, or a normal law or a stiffness for each",
                          f"{rigid.sum()} of {len(rigid)} hard", "give these a stiffness")
    return bool(rigid.any())


def allowed_motions(model):
    """Z (n, m): motions that keep all contacts closed, mass-orthonormal, those without friction uncoupled.

    Raises ConfigError where there is none.
    """
    mass, _, stiffness = model.supported()
    basis = scipy.linalg.null_space(model.contacts.normal)
    if not basis.shape[1]:
        raise ConfigError("hard contacts", "motions that keep them closed", "no motion at all",
                          "give the contacts a stiffness")
    symmetric = (stiffness + stiffness.T) / 2
    _, shape = scipy.linalg.eigh(basis.T @ symmetric @ basis, basis.T @ mass @ basis)
    return basis @ shape


def hard_sliding(model, friction, basis=None, friction_damping=True):
    """HardSliding of a SlidingModel, all of whose contacts are closed and hard.

    ``friction``: a coefficient or a FrictionState; ``basis`` as of ``allowed_motions``, where a sweep shares it. Raises
    ConfigError where the contacts jam.
    """
    basis = allowed_motions(model) if basis is None else basis
    mass, damping, stiffness = model.supported()
    state = friction if isinstance(friction, FrictionState) else FrictionState(friction)
    damping = damping + model.friction_matrices(state, friction_damping)[0]
    contacts = model.contacts
    pushed = contacts.normal.T + contacts.tangent.T * model.coupling(state)
    through = scipy.linalg.cho_solve(scipy.linalg.cho_factor(mass), contacts.normal.T).T
    mobility = through @ pushed
    _refuse_jamming(mobility, through @ contacts.normal.T)
    left = (basis - through.T @ scipy.linalg.solve(mobility.T, pushed.T @ basis)).T
    return HardSliding(left @ damping @ basis, left @ stiffness @ basis, basis, left)


def _refuse_jamming(mobility, free):
    """The mobility of the contacts must stay as definite as it is without friction."""
    relative = np.linalg.eigvals(np.linalg.solve(free, mobility)).real.min()
    if not relative > 0:
        raise ConfigError("hard contact", "friction below the limit at which the contact jams",
                          f"a normal mobility of {relative:.3g} times that without friction",
                          "lower the friction, or change the tilt: the slider digs in")


def growth(sliding, frequency, width):
    """Largest real part (1/s) of the roots whose frequency lies within ``width`` (a share) of ``frequency`` Hz.

    -inf where there is none.
    """
    roots = quadratic_roots(np.eye(len(sliding.stiffness)), sliding.damping, sliding.stiffness)
    near = abs(roots.imag / (2 * np.pi * frequency) - 1) <= width
    return roots.real[near].max(initial=-np.inf)


def critical_friction(model, frequency, stable, unstable, width=0.1, tolerance=1e-4):
    """Friction at which the growth of the mode near ``frequency`` Hz crosses zero, by bisection to ``tolerance``.

    ``stable`` and ``unstable`` are coefficients on either side. Raises ConfigError where they are not.
    """
    basis, neutral = allowed_motions(model), _NEUTRAL * 2 * np.pi * frequency

    def grows(friction):
        return growth(hard_sliding(model, friction, basis, friction_damping=False), frequency, width) > neutral

    if grows(stable) or not grows(unstable):
        raise ConfigError(f"critical friction near {frequency:.4g} Hz", "a stable and an unstable coefficient",
                          f"{stable:.4g} and {unstable:.4g}")
    while unstable - stable > tolerance:
        middle = (stable + unstable) / 2
        stable, unstable = (stable, middle) if grows(middle) else (middle, unstable)
    return (stable + unstable) / 2

"""Sliding contact with a shear limit (Tresca friction), and how the limit depends on speed and temperature.

No coefficient of friction enters: a contact node holds until its shear traction reaches the limit (Bowden & Tabor),
then it slips. The coefficient of friction is the outcome, the sum of shear over the sum of normal force.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.accelerated_gradients import ahead_of
from pipeline.physics.rough.contact.normal_contact import apply


@dataclass(frozen=True)
class ShearContact:
    """Shear traction (2, ny, nx) in Pa along x and y, ``sticking`` nodes (ny, nx), ``iterations``."""

    traction: np.ndarray
    sticking: np.ndarray
    iterations: int


def solve_shear_limit(limit, compliance, displacement, tolerance=1e-6, max_iterations=5000):
    """Shear traction when the bases of the solids are displaced by ``displacement`` (m) along x.

    ``limit`` (ny, nx) in Pa: largest shear traction of each node, 0 where open; ``compliance``: SurfaceCompliance of
    both solids. Minimises t C t / 2 - t d subject to |t| <= limit: accelerated projected gradients, the projection
    exact. The last step is below ``tolerance`` times the largest limit, measured over the whole map; otherwise
    ConvergenceError.
    """
    lipschitz = _largest_eigenvalue(compliance)
    imposed = np.array([displacement, 0.0])[:, None, None]
    traction = np.stack([limit, np.zeros_like(limit)])
    ahead, momentum = traction, 1.0
    for iteration in range(max_iterations):
        slip = imposed - _apply(compliance, ahead)
        new = _project(ahead + slip / lipschitz, limit)
        step = new - traction
        if np.abs(new - ahead).max() <= tolerance * limit.max():
            sticking = (limit > 0.0) & (np.hypot(*new) < limit * (1.0 - 1e-9))
            return ShearContact(new, sticking, iteration)
        ahead, momentum = ahead_of(new, traction, ahead, momentum)
        traction = new
    raise ConvergenceError("shear limit", f"steps below {tolerance:g} of the limit within {max_iterations} iterations",
                           f"{np.abs(step).max() / limit.max():.2g}", "raise max_iterations or tolerance")


def full_slip_displacement(limit, compliance):
    """Base displacement in m at which every contact node slips along x, the uniform shear of the blocks removed.

    0 where no node has a limit: all slip at once.
    """
    if not np.any(limit > 0.0):
        return 0.0
    displaced = apply(compliance.along, limit)
    return displaced[limit > 0.0].max() - compliance.along[0, 0] * limit.mean()


def limit_at_speed(limit, speed, reference_speed, rate, softening, heating):
    """Shear limit in Pa at a sliding speed: rate term and thermal softening.

    limit * (1 + rate ln(speed / reference)) * (1 - softening * rise), with the flash rise = ``heating`` (K/Pa, see
    flash_temperature) times the limit itself; solved for the limit.
    """
    fast = limit * (1.0 + rate * np.log(speed / reference_speed))
    return fast / (1.0 + softening * heating * fast)


def film_factor(film, pressure, distance):
    """Factor of a Film (``friction_states``) on the shear limit: 1 + g p / p_0 (1 - exp(-s / d)), none before sliding.

    The closed form of x' = (|v| / d) (p / p_0 - x), 1 + g x, under one pressure (Pa) over the ``distance`` s in m.
    """
    return 1.0 + film.gain * (pressure / film.pressure) * -np.expm1(-distance / film.length)


def _apply(compliance, traction):
    along, across = scipy.fft.rfft2(traction)
    image = np.stack([compliance.along * along + compliance.cross * across,
                      compliance.cross * along + compliance.across * across])
    return scipy.fft.irfft2(image, s=traction.shape[1:])


def _project(traction, limit):
    size = np.hypot(*traction)
    return traction * np.where(size > limit, limit / np.where(size > 0.0, size, 1.0), 1.0)


def _largest_eigenvalue(compliance):
    mean, half = (compliance.along + compliance.across) / 2.0, (compliance.along - compliance.across) / 2.0
    return (mean + np.hypot(half, compliance.cross)).max()

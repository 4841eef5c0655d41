"""Normal contact of two rough elastic solids under a prescribed mean pressure.

The gap between the undeformed surfaces is closed by the surface compliance of both solids; contact nodes carry
pressure and no gap, the others a gap and no pressure (frictionless, no adhesion). All maps are periodic, (ny, nx).
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError

#: area of the boundary cells that a node-wise count adds, in spacing * perimeter (Yastrebov et al. 2017, equation 8)
PERIMETER_SHARE = (np.pi - 1.0 + np.log(2.0)) / 24.0


@dataclass(frozen=True)
class NormalContact:
    """Solution: contact ``pressure`` (ny, nx) Pa, ``approach`` of the two reference planes in m, ``iterations``."""

    pressure: np.ndarray
    approach: float
    iterations: int


def apply(compliance, traction):
    """Surface displacement (ny, nx) in m by a traction map; ``compliance`` is one array of a SurfaceCompliance."""
    return scipy.fft.irfft2(compliance * scipy.fft.rfft2(traction), s=traction.shape)


def solve_normal_contact(gap, compliance, mean_pressure, start=None, tolerance=1e-6, max_iterations=2000):
    """Contact pressure under ``mean_pressure`` (Pa) by the conjugate gradients of Polonsky & Keer (1999).

    ``gap`` (ny, nx) in m: distance of the undeformed surfaces, any reference; ``compliance`` (ny, nx // 2 + 1) in m/Pa:
    normal compliance of both solids, or a CompositeCompliance; ``start``: a pressure map to start from. The remaining
    gap of contact nodes and the remaining overlap of others are below ``tolerance`` times the rms of ``gap``; otherwise
    ConvergenceError.
    """
    if not isinstance(compliance, np.ndarray):
        return compliance.settled(lambda gap, alike, start: solve_normal_contact(
            gap, alike, mean_pressure, start, tolerance, max_iterations), gap, start, tolerance)
    scale = gap.std()
    if mean_pressure <= 0.0 or scale == 0.0:
        raise ConfigError("normal contact", "a positive pressure and a gap that varies",
                          f"{mean_pressure:g} Pa on a gap of {scale:g} m rms")
    pressure = np.full(gap.shape, float(mean_pressure)) if start is None else np.maximum(start, 0.0)
    pressure = pressure * (mean_pressure / pressure.mean())
    direction, conjugate, previous = np.zeros_like(gap), 0.0, 1.0
    for iteration in range(max_iterations):
        distance = gap + apply(compliance, pressure)
        bearing = (pressure > 0.0).astype(float)
        count = bearing.sum()
        approach = np.vdot(distance, bearing) / count
        distance -= approach
        residual = distance * bearing
        error = max(residual.max(), -distance.min()) / scale
        if error < tolerance:
            return NormalContact(pressure, approach, iteration)
        square = np.vdot(residual, residual)
        direction = residual + conjugate * square / previous * (direction * bearing)
        image = apply(compliance, direction)
        image -= np.vdot(image, bearing) / count
        curvature = np.vdot(image, direction)       # of a single touching node none: its own stiffness is the step
        step = np.vdot(residual, direction) / curvature if curvature > 0.0 else 1.0 / _self_compliance(compliance, gap)
        pressure, conjugate = _advance(pressure, step, direction, distance, mean_pressure)
        previous = square if square > 0.0 else 1.0
    raise ConvergenceError("normal contact", f"a gap error of {tolerance:g} rms within {max_iterations} iterations",
                           f"{error:.2g}", "raise max_iterations or tolerance")


def full_contact_pressure(gap, compliance):
    """Mean pressure in Pa from which on every node touches: the one under which the deepest node just carries nothing.

    Where all nodes touch, the pressure is the mean plus that which flattens the gap, -gap / compliance per wavenumber
    (Johnson, Contact Mechanics, 1985, section 13.2: p* of a wavy surface). Arguments as of ``solve_normal_contact``; of
    a composite it is that of its one modulus.
    """
    compliance = compliance if isinstance(compliance, np.ndarray) else compliance.whole
    flattening = scipy.fft.rfft2(gap)
    flattening[0, 0] = 0.0
    waves = compliance.copy()
    waves[0, 0] = 1.0
    return scipy.fft.irfft2(flattening / waves, s=gap.shape).max()


def _self_compliance(compliance, gap):
    """Displacement of a node by a traction on itself alone, over the mean displacement taken off, in m/Pa."""
    unit = np.zeros(gap.shape)
    unit[0, 0] = 1.0
    image = apply(compliance, unit)
    return image[0, 0] - image.mean()


def _advance(pressure, step, direction, distance, mean_pressure):
    """One projected step; overlapping open nodes join the contact, which restarts the conjugate directions."""
    pressure = np.maximum(pressure - step * direction, 0.0)
    overlap = (pressure == 0.0) & (distance < 0.0)
    joined = overlap.any()
    if joined:
        pressure[overlap] -= step * distance[overlap]
    pressure *= mean_pressure / pressure.mean()
    return pressure, 0.0 if joined else 1.0


def contact_area(contact):
    """(node-wise share, perimeter-corrected share) of the real contact area of a periodic mask (ny, nx).

    The correction removes the half-filled boundary cells: A - (pi - 1 + ln 2) / 24 * perimeter * spacing
    (Yastrebov, Anciaux & Molinari, Tribology International 114, 2017).
    """
    switches = sum(np.count_nonzero(contact != np.roll(contact, 1, axis)) for axis in (0, 1))
    counted = np.count_nonzero(contact) / contact.size
    return counted, counted - PERIMETER_SHARE * switches / contact.size


def interface_stiffness(gap, compliance, contact, tolerance, max_iterations, step=0.02):
    """dp / d(approach) in Pa/m about a solution: central difference over +-``step`` of the mean pressure.

    The uniform compliance of the blocks (wavenumber 0) is removed: what remains belongs to the rough interface. A
    brake model fills the depth of the blocks with the bulk of pad and disc; the moduli of the blocks are effective
    values of the asperities and say nothing about that bulk. Raises ConfigError where the load flattens the interface:
    nothing is left that could be stiff.
    """
    mean, flat = contact.pressure.mean(), full_contact_pressure(gap, compliance)
    if flat <= mean:
        raise ConfigError("normal contact", f"a load that leaves nodes open, below {flat:.3g} Pa", f"{mean:.3g} Pa",
                          "lower the pressure or the wear, or raise the modulus of the asperities")
    low, high = (solve_normal_contact(gap, compliance, mean * factor, contact.pressure, tolerance, max_iterations)
                 for factor in (1.0 - step, 1.0 + step))
    return 1.0 / ((high.approach - low.approach) / (2.0 * step * mean) - uniform(compliance))


def uniform(compliance):
    """Mean displacement in m by a pressure of 1 Pa all over; ``compliance`` as of ``solve_normal_contact``."""
    return float(compliance[0, 0]) if isinstance(compliance, np.ndarray) else compliance.uniform

"""Normal contact of two rough elastic solids under a prescribed mean pressure.

The gap between the undeformed surfaces is closed by the surface compliance of both solids; contact nodes carry
pressure and no gap, the others a gap and no pressure (frictionless, no adhesion). All maps are periodic, (ny, nx).
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.rough.contact.contact_steps import Path, stencil

#: area of the boundary cells that a node-wise count adds, in spacing * perimeter (Yastrebov et al. 2017, equation 8)
PERIMETER_SHARE = (np.pi - 1.0 + np.log(2.0)) / 24.0
#: errors, in rms gaps, down to which contacts are sought in single precision, and that share of the tolerance
_SINGLE, _SURE = 1e-5, 0.98


@dataclass(frozen=True)
class NormalContact:
    """Solution: contact ``pressure`` (ny, nx) Pa, ``approach`` of the two reference planes in m, ``iterations``."""

    pressure: np.ndarray
    approach: float
    iterations: int


def apply(compliance, traction):
    """Surface displacement (ny, nx) in m by a traction map; ``compliance`` is one array of a SurfaceCompliance."""
    waves = scipy.fft.rfft2(traction)
    waves *= compliance
    # irfft2 to the last bit, and faster
    return scipy.fft.irfft(scipy.fft.ifft(waves, axis=0, overwrite_x=True), n=traction.shape[1])


def solve_normal_contact(gap, compliance, mean_pressure, start=None, tolerance=1e-6, max_iterations=2000):
    """Contact pressure under ``mean_pressure`` (Pa) by projected conjugate gradients.

    Those of Polonsky & Keer (1999), with the conjugate factor of Polak & Ribiere (1969): where nodes join the contact
    it needs no restart. ``gap`` (ny, nx) in m: distance of the undeformed surfaces, any reference; ``compliance`` (ny,
    nx // 2 + 1) in m/Pa: normal compliance of both solids, or a CompositeCompliance; ``start``: a pressure map to start
    from. The remaining gap of contact nodes and the remaining overlap of others are below ``tolerance`` times the rms
    of ``gap``; otherwise ConvergenceError.
    """
    if not isinstance(compliance, np.ndarray):
        return compliance.settled(lambda gap, alike, start: solve_normal_contact(
            gap, alike, mean_pressure, start, tolerance, max_iterations), gap, start, tolerance)
    scale = gap.std()
    if mean_pressure <= 0.0 or scale == 0.0:
        raise ConfigError("normal contact", "a positive pressure and a gap that varies",
                          f"{mean_pressure:g} Pa on a gap of {scale:g} m rms")
    near, begun = stencil(compliance, gap.shape), max(_SURE * tolerance, _SINGLE)
    pressure = np.full(gap.shape, float(mean_pressure)) if start is None else np.maximum(start, 0.0)
    pressure, done = _in_single(gap, compliance, near, mean_pressure, pressure, scale, begun, max_iterations)
    contact, error = _relaxed(gap, compliance, near, mean_pressure, pressure, tolerance * scale, max_iterations - done)
    if error >= tolerance * scale:
        raise ConvergenceError("normal contact", f"a gap error of {tolerance:g} rms within {max_iterations} iterations",
                               f"{error / scale:.2g}", "raise max_iterations or tolerance")
    return replace(contact, iterations=done + contact.iterations)


def _in_single(gap, compliance, near, mean_pressure, pressure, scale, tolerance, iterations):
    """(pressure, iterations) of the contact in single precision, from a ``pressure`` map.

    Lengths are in ``scale`` m, pressures in the mean. A displacement of all nodes alike, which may exceed the roughness
    by far, is left out, so that rounding stays near 1e-7 of the gap.
    """
    waves = np.asarray(compliance * (mean_pressure / scale), np.float32)
    waves[0, 0] = 0.0
    contact, _ = _relaxed(np.asarray((gap - gap.mean()) / scale, np.float32), waves, near * (scale / mean_pressure),
                          1.0, np.asarray(pressure / pressure.mean(), np.float32), tolerance, iterations)
    return mean_pressure * contact.pressure.astype(float), contact.iterations


def _relaxed(gap, compliance, near, mean_pressure, pressure, tolerance, iterations):
    """(NormalContact, error in m) once the error is below ``tolerance`` (m) or ``iterations`` are over; in the
    precision of its arrays. ``near``: the stencil of the compliance."""
    pressure = pressure * (mean_pressure / pressure.mean())
    joining = float(near.max())
    bearing, path, displaced, iteration = np.flatnonzero(pressure > 0.0), Path(near, gap), None, 0
    while True:
        displaced = apply(compliance, pressure) if displaced is None else displaced
        distance = (gap + displaced).ravel()
        approach = distance[bearing].mean()
        distance -= approach
        overlap = -distance.min()
        error = max(distance[bearing].max(), overlap)
        if error < tolerance or iteration == iterations:
            return NormalContact(pressure, approach, iteration), error
        free = _free(distance, bearing) if overlap > 0.0 else bearing
        slope = path.turn(free, distance[free])
        image = apply(compliance, path.direction)
        step = slope / np.vdot(image, path.direction)
        bearing, factor = _advance(pressure, step * path.direction.ravel()[free], free,
                                   -step * joining * distance[free], mean_pressure)
        displaced = None if factor is None else factor * (displaced - step * image)
        iteration += 1


def _free(distance, bearing):
    """Nodes that bear or overlap, by their places in the flat ``distance`` (n,) from the approach, in m."""
    free = distance < 0.0
    free[bearing] = True
    return np.flatnonzero(free)


def _advance(pressure, relief, free, joining, mean_pressure):
    """One projected step of the ``free`` nodes by their ``relief`` (n,) in Pa; changes ``pressure``.

    Nodes that would open but overlap are loaded by ``joining`` (n,) Pa, > 0 at such. (Nodes that bear then, factor on
    the straight step that keeps the mean; None where nodes were projected.)
    """
    straight = pressure.ravel()[free] - relief
    new = np.maximum(straight, 0.0)
    joins = (new == 0.0) & (joining > 0.0)
    new[joins] = joining[joins]
    factor = mean_pressure * pressure.size / new.sum()
    pressure.ravel()[free] = factor * new
    return free[new > 0.0], factor if np.array_equal(new, straight) else None


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
    low = solve_normal_contact(gap, compliance, mean * (1.0 - step), contact.pressure, tolerance, max_iterations)
    high = solve_normal_contact(gap, compliance, mean * (1.0 + step), 2.0 * contact.pressure - low.pressure, tolerance,
                                max_iterations)
    return 1.0 / ((high.approach - low.approach) / (2.0 * step * mean) - uniform(compliance))


def uniform(compliance):
    """Mean displacement in m by a pressure of 1 Pa all over; ``compliance`` as of ``solve_normal_contact``."""
    return float(compliance[0, 0]) if isinstance(compliance, np.ndarray) else compliance.uniform

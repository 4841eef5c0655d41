"""Physics that no catalogue holds, for a diagnosis to leave unnamed: each builder as those of ``joint_laws``."""

import numpy as np

from pipeline.blind_trial.generators.switching.event_motion import STOPS, Crossing, Law, stopped
from pipeline.blind_trial.generators.switching.joint_laws import reversal, rubbing, smooth

#: stages of a line that delays; instants of random impacts in typical periods; bounce below which a body rests
_STAGES, _APART, _REST = 8, 6.0, 1e-3
#: loss of sloshing liquid, twice its damping ratio
_LOSS = 0.06


def quintic(spot, size):
    return (smooth(spot, lambda e, v: size * spot.force * (e / spot.length) ** 5),)


def magnet(spot, size):
    """A magnet that repels from one side, harder as it comes near: F = A (1 / (1 - e / g)^2 - 1)."""
    gap, pole = 2.5 * spot.length, size * spot.force
    return (smooth(spot, lambda e, v: pole * (1 / max(1 - e / gap, 0.02) ** 2 - 1)),)


def lagging(spot, size):
    """A control force that follows the elongation through a line of lags, half a radian or more behind."""
    rate = _STAGES * spot.angular / spot.between(0, 0.5, 1.5)

    def rates(t, e, v, z, mode):
        return rate * (np.concatenate(([e], z[:-1])) - z)

    return (Law(spot.row, lambda t, e, v, z, mode: size * spot.stiffness * z[-1], _STAGES, rates, spot.length),)


def dead_time(spot, size):
    """Friction that turns round some time after the slip has; z: the time since then. Mode: direction of its force,
    2 of it while it waits."""
    force, wait = size * spot.force, spot.between(0, 0.2, 0.5) / spot.angular

    def began(mechanism, law, v, z):
        return v, 0 * z

    def crossings(mode):
        way = int(np.sign(mode))
        if abs(mode) == 1:
            return (Crossing(lambda t, e, v, z: -way * v, 2 * way, began),)
        return (Crossing(lambda t, e, v, z: z[0] - wait, -way), Crossing(lambda t, e, v, z: way * v, way))

    return (Law(spot.row, lambda t, e, v, z, mode: force * np.sign(mode), 1, lambda t, e, v, z, mode: np.ones(1),
                wait, lambda e, v: 1 if v >= 0 else -1, crossings),)


def root_drag(spot, size):
    """Drag that grows with the square root of the speed."""
    return (smooth(spot, lambda e, v: size * spot.force * np.sign(v) * np.sqrt(abs(v) / spot.speed)),)


def lift(spot, size):
    """A lift that grows with the speed squared, the same way for either direction."""
    return (smooth(spot, lambda e, v: size * spot.force * (v / spot.speed) ** 2),)


def slosh(spot, size):
    """Liquid that sloshes as a pendulum in large swings; z is its angle, and its speed over arm and frequency."""
    angular, mass = spot.angular * spot.between(0, 0.7, 1.3), size * spot.stiffness / spot.angular**2
    arm = 1.5 * spot.length

    def pull(v, z):
        return np.sin(z[0]) + _LOSS * (z[1] - v / (angular * arm))

    def rates(t, e, v, z, mode):
        return angular * np.array([z[1] - v / (angular * arm), -pull(v, z)])

    return (Law(spot.row, lambda t, e, v, z, mode: -mass * angular**2 * arm * pull(v, z), 2, rates),)


def impacts(spot, size):
    """Blows at random instants that nobody records: half sines of a tenth of a radian."""
    random = np.random.default_rng([int(1e6 * s) for s in spot.shape])
    period = 2 * np.pi / spot.angular
    instants = np.cumsum(random.exponential(_APART * period, 400))
    sizes, width = random.standard_normal(400), period / 8

    def force(t, e, v, z, mode):
        k = np.searchsorted(instants, t) - 1
        since = t - instants[k] if k >= 0 else np.inf
        return -8 * size * spot.force * sizes[k] * np.sin(np.pi * since / width) if since < width else 0.0

    return (Law(spot.row, force),)


def switched_spring(spot, size):
    """A second spring that is clutched in while the body moves away from its middle, and let go when it returns."""
    def force(t, e, v, z, mode):
        return size * spot.stiffness * e if mode == 1 else 0.0

    def crossings(mode):
        s = 1 if mode == 1 else -1
        return (Crossing(lambda t, e, v, z: -s * e * v, 1 - mode),)

    return (Law(spot.row, force, first=lambda e, v: int(e * v > 0), crossings=crossings),)


def threshold_flow(spot, size):
    """An elastic branch that flows only above a threshold: z' = g v - max(|z| - z_0, 0) sgn(z) / tau."""
    branch, time = size * spot.stiffness, spot.between(0, 0.3, 1.0) / spot.angular
    limit = 0.6 * branch * spot.length

    def rates(t, e, v, z, mode):
        return branch * v - np.sign(z) * np.maximum(abs(z) - limit, 0.0) / time

    return (Law(spot.row, lambda t, e, v, z, mode: z[0], 1, rates, spot.force),)


def rigid_stop(spot, size):
    """A stop on one side that the body hits and leaves with a restitution; nearer the larger the size."""
    gap, restitution = 3.2 * spot.length / (1 + size), spot.between(0, 0.3, 0.8)

    def struck(mechanism, law, v, z):
        return stopped(mechanism, law, v, restitution), z

    def crossings(mode):
        return (Crossing(lambda t, e, v, z: e - gap, lambda v: STOPS if v < _REST * spot.speed else -1, struck),)

    return (Law(spot.row, lambda t, e, v, z, mode: 0.0, first=-1, crossings=crossings,
                limits=lambda t, e, z: (0.0, np.inf)),)


def clamped(spot, size):
    """Friction of a clamp that holds by the elongation itself: its limit grows with the way from the middle, from a
    hundredth of what it is at the typical way."""
    def limit(e):
        return size * spot.stiffness * (abs(e) + 0.01 * spot.length)

    return (Law(spot.row, lambda t, e, v, z, mode: mode * limit(e), first=rubbing,
                crossings=lambda mode: (reversal(mode),), limits=lambda t, e, z: (-limit(e), limit(e))),)

"""The friction law mu(pressure, speed, distance): a table, read multilinearly, constant outside.

The few computed points are first refined by monotone cubics (``refine``); a solver then reads the fine
table with the scalar kernel ``friction_at``, which also gives the slopes that its tangent needs.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.numerics.compiled import borrowing, njit

AXES = ("pressure", "speed", "distance")


def refuse_beyond(distance, last, where):
    """ConfigError at ``where`` for a sliding ``distance`` (m) beyond the ``last`` of a friction map."""
    if distance > last * (1 + 1e-6):
        raise ConfigError(where, f"at most {last:g} m, the last distance of the friction map", f"{distance:g} m",
                          "lower it, or raise micro_friction.recorded_distances")


@dataclass(frozen=True)
class FrictionLaw:
    """mu on the grid pressure (P,) Pa x speed (V,) m/s x distance (S,) m; ``friction`` is (P, V, S)."""

    pressure: np.ndarray
    speed: np.ndarray
    distance: np.ndarray
    friction: np.ndarray

    def __post_init__(self):
        for name in (*AXES, "friction"):
            object.__setattr__(self, name, np.ascontiguousarray(getattr(self, name), dtype=float))
        sizes = tuple(getattr(self, name).size for name in AXES)
        if self.friction.shape != sizes or 0 in sizes:
            raise ConfigError("friction law", f"a table of shape {sizes}, none of them 0", str(self.friction.shape))
        for name in AXES:
            if np.any(np.diff(getattr(self, name)) <= 0):
                raise ConfigError(f"friction law: {name}", "strictly rising values", str(getattr(self, name)))

    @classmethod
    def of(cls, table):
        """The law of a table with these axes and values, as the product FrictionMap is one."""
        return cls(table.pressure, table.speed, table.distance, table.friction)

    @property
    def table(self):
        """Arguments that ``friction_at`` takes after the state: the three axes and the table."""
        return self.pressure, self.speed, self.distance, self.friction

    def evaluate(self, pressure, speed, distance):
        """(mu, outside) for broadcastable arrays of the state; outside is True where an axis was clipped."""
        states = np.broadcast_arrays(pressure, speed, distance)
        flat = np.ascontiguousarray([np.ravel(s) for s in states], dtype=float)
        friction, outside = _evaluate(flat, *self.table)
        return friction.reshape(states[0].shape), outside.reshape(states[0].shape)

    def states(self, pressure, speed, distance):
        """(mu, dmu/dpressure in 1/Pa, dmu/dspeed in s/m), each (k,), at states (k,) and one distance; as of
        ``friction_at``."""
        return _states(np.ascontiguousarray(pressure, float), np.ascontiguousarray(speed, float), float(distance),
                       *self.table)

    def slope(self, name, pressure, speed, distance):
        """dmu/d``name`` (an axis) at one state, continuous: slopes of intervals, straight between their middles.

        Second order in the intervals, where those of ``friction_at`` are first order; 0 outside the axis.
        """
        axis, state = getattr(self, name), [pressure, speed, distance]
        place = state[AXES.index(name)]
        if not axis[0] < place < axis[-1]:
            return 0.0
        low = int(np.searchsorted(axis, place, side="right")) - 1
        near = axis[max(low - 1, 0):low + 3]
        state[AXES.index(name)] = near
        return straight_slope(near, self.evaluate(*state)[0], place)

    def on(self, *axes):
        """The same law on other axes, exactly where they hold the values of its own."""
        return FrictionLaw(*axes, self.evaluate(*np.meshgrid(*axes, indexing="ij"))[0])


def straight_slope(known, values, place):
    """Slope (...) at ``place`` (...) of ``values`` (n,) over rising ``known`` (n,): straight between the middles of the
    intervals, where it is theirs."""
    return np.interp(place, (known[1:] + known[:-1]) / 2, np.diff(values) / np.diff(known))


def refine(axes, values, subdivisions):
    """Monotone, overshoot-free refinement of a table.

    ``axes`` are the strictly rising axes of ``values``; every interval of axis i is cut into ``subdivisions[i]``
    equal parts and filled by PCHIP (Fritsch & Carlson 1980) along one axis after the other. No value leaves the
    range of the table; axes of length 1 stay. Returns (refined axes, refined values).
    """
    fine_axes = []
    for number, (axis, parts) in enumerate(zip(axes, subdivisions, strict=True)):
        axis = np.asarray(axis, dtype=float)
        fine = np.interp(np.arange((axis.size - 1) * parts + 1) / parts, np.arange(axis.size), axis)
        if axis.size > 1:
            values = scipy.interpolate.PchipInterpolator(axis, values, axis=number)(fine)
        fine_axes.append(fine)
    return fine_axes, np.array(values, dtype=float)


@borrowing
def _locate(axis, value):
    """Interval (low, high), weight of its end, 1 / length, and 1 if the value was clipped."""
    last = axis.size - 1
    if value <= axis[0] or last == 0:
        return 0, 0, 0.0, 0.0, 1 if value != axis[0] else 0
    if value >= axis[last]:
        return last, last, 0.0, 0.0, 1 if value > axis[last] else 0
    low, high = 0, last
    while high - low > 1:       # in less time than np.searchsorted
        middle = (low + high) // 2
        if axis[middle] <= value:
            low = middle
        else:
            high = middle
    length = axis[low + 1] - axis[low]
    return low, low + 1, (value - axis[low]) / length, 1.0 / length, 0


@borrowing
def friction_at(pressure, speed, distance, pressures, speeds, distances, table, first=0):
    """(mu, dmu/dpressure in 1/Pa, dmu/dspeed in s/m, outside) at one state.

    Multilinear on the axes; outside them mu is constant and its slope zero, and ``outside`` is 1. An axis of one
    value does not vary: it is outside wherever the state differs from it. ``first`` is the row where the table begins,
    where several laws on the same axes are stacked.
    """
    p0, p1, wp, ip, outside_p = _locate(pressures, pressure)
    v0, v1, wv, iv, outside_v = _locate(speeds, speed)
    s0, s1, ws, _, outside_s = _locate(distances, distance)
    corners = _over_distance(table, first + p0, first + p1, v0, v1, s0, s1, ws)
    mu, slope_p, slope_v = _over_pressure_and_speed(corners, wp, ip, wv, iv)
    return mu, slope_p, slope_v, 1 if outside_p + outside_v + outside_s > 0 else 0


@borrowing
def mean_friction_at(pressure, speed, distance, share, pressures, speeds, distances, table, first):
    """(mu, dmu/dpressure, dmu/dspeed): those of ``friction_at``, mean over ``distance`` (d,) m by ``share`` (d,).

    As cheap as one reading and a part of one for each further distance. Shares sum to 1.
    """
    p0, p1, wp, ip, _ = _locate(pressures, pressure)
    v0, v1, wv, iv, _ = _locate(speeds, speed)
    m00, m01, m10, m11 = 0.0, 0.0, 0.0, 0.0
    for d in range(distance.size):
        if share[d] > 0.0:
            s0, s1, ws, _, _ = _locate(distances, distance[d])
            corners = _over_distance(table, first + p0, first + p1, v0, v1, s0, s1, ws)
            m00 += share[d] * corners[0]
            m01 += share[d] * corners[1]
            m10 += share[d] * corners[2]
            m11 += share[d] * corners[3]
    return _over_pressure_and_speed((m00, m01, m10, m11), wp, ip, wv, iv)


@borrowing(inline="always")
def _over_distance(table, p0, p1, v0, v1, s0, s1, weight):
    """Values at the corners (pressure, speed) of a cell, interpolated over distance."""
    return (table[p0, v0, s0] * (1.0 - weight) + table[p0, v0, s1] * weight,
            table[p0, v1, s0] * (1.0 - weight) + table[p0, v1, s1] * weight,
            table[p1, v0, s0] * (1.0 - weight) + table[p1, v0, s1] * weight,
            table[p1, v1, s0] * (1.0 - weight) + table[p1, v1, s1] * weight)


@borrowing(inline="always")
def _over_pressure_and_speed(corners, wp, ip, wv, iv):
    """(mu, dmu/dpressure, dmu/dspeed) from the corners of a cell."""
    m00, m01, m10, m11 = corners
    low = m00 * (1.0 - wv) + m01 * wv
    high = m10 * (1.0 - wv) + m11 * wv
    slope_v = ((m01 - m00) * (1.0 - wp) + (m11 - m10) * wp) * iv
    return low * (1.0 - wp) + high * wp, (high - low) * ip, slope_v


@njit
def _states(pressure, speed, distance, pressures, speeds, distances, table):
    states = np.empty((3, pressure.size))
    for i in range(pressure.size):
        states[0, i], states[1, i], states[2, i], _ = friction_at(
            pressure[i], speed[i], distance, pressures, speeds, distances, table, 0)
    return states


@njit
def _evaluate(states, pressures, speeds, distances, table):
    size = states.shape[1]
    friction, outside = np.empty(size), np.zeros(size, dtype=np.bool_)
    for i in range(size):
        mu, _, _, clipped = friction_at(
            states[0, i], states[1, i], states[2, i], pressures, speeds, distances, table, 0)
        friction[i], outside[i] = mu, clipped == 1
    return friction, outside

"""Laws of contacts about a sliding state, as far as derivatives of roots ask for them.

A contact law and a friction map are tables, linear between their rows. Roots hang on the slopes of both, which are
staircases: their own derivatives are 0 or infinite, and what differences of roots give is a matter of the step. Here
slopes vary as the steps of the staircase do on average, over a ``reach`` of so many rows to each side.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.physics.sliding.model import FrictionState

#: distance over which the slope of a friction law that is no table changes, as a logarithm
_SMOOTH = 1e-3


@dataclass(frozen=True)
class LocalLaw:
    """Normal law of contacts about their ``closure`` (c,) m: ``force`` N, ``stiffness`` N/m, ``curvature`` N/m^2, each
    (c,).

        N = N0 + k0 (f c - c0) + k0' (f c - c0)^2 / 2,    f the factor on the slope of the law at a given pressure.
    """

    closure: np.ndarray
    force: np.ndarray
    stiffness: np.ndarray
    curvature: np.ndarray

    @classmethod
    def about(cls, family, sliding, reach=1):
        """Of a Family about its SlidingState."""
        contact, contacts = sliding.contact, family.model.contacts
        curvature = contacts.area * curvature_of(contact.closure, family.law_closure, family.law_pressure, reach)
        moves = (contact.stiffness > 0) & ~contacts.fixed
        return cls(contact.closure, contact.force, contact.stiffness, np.where(moves, curvature, 0.0))

    def __call__(self, factor, closure):
        """(force, slope) each (c,) at other closures (c,), with a ``factor`` f."""
        beyond = factor * closure - self.closure
        return (self.force + (self.stiffness + self.curvature * beyond / 2) * beyond,
                factor * (self.stiffness + self.curvature * beyond))


def curvature_of(closure, closures, pressures, reach=1):
    """d^2 p / dc^2 (c,) Pa/m^2 of a table at ``closure`` (c,) m, by the differences of its slopes; 0 for one slope."""
    slope, middle = np.diff(pressures) / np.diff(closures), (closures[1:] + closures[:-1]) / 2
    row = np.searchsorted(middle, closure)
    low, high = np.maximum(row - reach, 0), np.minimum(row + reach - 1, len(middle) - 1)
    apart = middle[high] - middle[low]
    return np.divide(slope[high] - slope[low], apart, out=np.zeros(len(row)), where=apart > 0)


@dataclass(frozen=True)
class LocalFriction:
    """Coefficient of friction about a ``pressure`` Pa and a sliding ``speed`` m/s, each (c,), to the second order.

    ``state``: the FrictionState there; ``by_pressure``, ``by_both``, ``by_speed`` (c,) its second derivatives.
    """

    pressure: np.ndarray
    speed: np.ndarray
    state: FrictionState
    by_pressure: np.ndarray
    by_both: np.ndarray
    by_speed: np.ndarray

    @classmethod
    def about(cls, family, sliding, friction_map, reach=1):
        """Of a Family about its SlidingState, friction that of a product FrictionMap, or None."""
        pressure, speed = sliding.contact.force / family.model.contacts.area, abs(family.model.sliding_speed)
        far = [np.exp(_SMOOTH if friction_map is None else reach * np.diff(np.log(axis)).mean()) for axis in
               ((1.0,) if friction_map is None else (friction_map.pressure, friction_map.speed))]
        over_pressure, over_speed = far[0], far[-1]

        def slopes(pressures, speeds):
            state = family.friction(pressures, speeds)
            return np.broadcast_to(state.pressure_slope, len(speed)), np.broadcast_to(state.speed_slope, len(speed))

        def differences(axis, factor):
            ends = [(pressure * factor**side, speed) if axis == 0 else (pressure, speed * factor**side)
                    for side in (-1, 1)]
            along = ends[1][axis] - ends[0][axis]
            low, high = slopes(*ends[0]), slopes(*ends[1])
            return [np.divide(b - a, along, out=np.zeros(len(speed)), where=along > 0)
                    for a, b in zip(low, high, strict=True)]

        by_pressure, mixed = differences(0, over_pressure)
        other, by_speed = differences(1, over_speed)
        return cls(pressure, speed, family.friction(pressure, speed), by_pressure, (mixed + other) / 2, by_speed)

    def __call__(self, pressure, speed):
        """FrictionState (c,) at other pressures and speeds (c,)."""
        along, across, state = pressure - self.pressure, speed - self.speed, self.state
        level = state.coefficient + state.pressure_slope * along + state.speed_slope * across
        level = level + self.by_pressure * along**2 / 2 + self.by_both * along * across + self.by_speed * across**2 / 2
        return FrictionState(level, state.pressure_slope + self.by_pressure * along + self.by_both * across,
                             state.speed_slope + self.by_both * along + self.by_speed * across)

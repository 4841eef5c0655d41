"""Laws of contacts about a sliding state, as far as derivatives of roots ask for them.

A contact law and a friction map are tables, linear between their rows. Roots hang on the slopes of both, which are
staircases: their own derivatives are 0 or infinite, and what differences of roots give is a matter of the step. Here
slopes vary as the steps of the staircase do on average, over a ``reach`` of so many rows to each side.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from pipeline.physics.sliding.model import FrictionState

#: distance over which the slope of a friction law that is no table changes, as a logarithm
_SMOOTH = 1e-3
#: the same over which the coefficient itself does
_NEAR = 1e-5


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
    def about(cls, family, contact, reach=1):
        """Of a Family about the Preload of its contacts in steady sliding."""
        contacts = family.model.contacts
        if family.law_added:
            curvature = family.added.curvature(contacts.area, contact.closure, partial(curvature_of, reach=reach))
        else:
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

    ``state``: the FrictionState there; ``steady`` (2, c): what steady friction changes by over pressure and speed, more
    than the slopes where it remembers; ``bend`` (2, 2, c): what both slopes change by over pressure and over speed.
    """

    pressure: np.ndarray
    speed: np.ndarray
    state: FrictionState
    steady: np.ndarray
    bend: np.ndarray

    @classmethod
    def about(cls, family, force, friction_map, reach=1):
        """Of a Family under contact forces (c,) N, friction that of a product FrictionMap, or None."""
        pressure, speed = force / family.model.contacts.area, abs(family.model.sliding_speed)
        far = [np.exp(_SMOOTH if friction_map is None else reach * np.diff(np.log(axis)).mean()) for axis in
               ((1.0,) if friction_map is None else (friction_map.pressure, friction_map.speed))]
        over_pressure, over_speed = far[0], far[-1]

        def slopes(pressures, speeds):
            state = family.friction(pressures, speeds)
            return np.broadcast_to(state.pressure_slope, len(speed)), np.broadcast_to(state.speed_slope, len(speed))

        def differences(axis, factor, values=slopes):
            ends = [(pressure * factor**side, speed) if axis == 0 else (pressure, speed * factor**side)
                    for side in (-1, 1)]
            along = ends[1][axis] - ends[0][axis]
            low, high = values(*ends[0]), values(*ends[1])
            return [np.divide(b - a, along, out=np.zeros(len(speed)), where=along > 0)
                    for a, b in zip(low, high, strict=True)]

        bend = np.array([differences(0, over_pressure), differences(1, over_speed)])
        steady = [differences(axis, np.exp(_NEAR), lambda *at: (family.friction(*at).coefficient,))[0]
                  for axis in range(2)]
        return cls(pressure, speed, family.friction(pressure, speed), np.array(steady), bend)

    def __call__(self, pressure, speed):
        """FrictionState (c,) at other pressures and speeds (c,)."""
        moved, state = np.array([pressure - self.pressure, speed - self.speed]), self.state
        turned = np.einsum("ac,abc->bc", moved, self.bend)
        level = state.coefficient + (moved * (self.steady + turned / 2)).sum(axis=0)
        return FrictionState(level, state.pressure_slope + turned[0], state.speed_slope + turned[1])

"""Masses with dry friction, play and stops between them, by SciPy from event to event: nothing here is ours.

Between two events the equations are smooth and DOP853 solves them; events are the end of sliding, a holding force at
its limit, and an elongation at a kink of its spring.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

#: how far beyond an event a margin begins, as shares of 1 m/s and 1 m: else it would be met again at once
_PAST = 1e-13


@dataclass(frozen=True)
class Masses:
    """``mass`` (n,) kg on springs and dampers along the ``rows`` (j, n), friction of the size ``limit`` (j,) N in each.

    ``load(t)`` (n,) N; ``spring(e)``: further forces (j,) N at the elongations e (j,), whose slopes jump at ``kinks``
    ((joint, elongation), ...).
    """

    mass: np.ndarray
    rows: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    limit: np.ndarray
    load: object
    spring: object = None
    kinks: tuple = ()

    def pulled(self, time, state):
        """Accelerations (n,) without friction."""
        x, v = np.split(state, 2)
        e = self.rows @ x
        inner = self.stiffness * e + self.damping * (self.rows @ v)
        if self.spring is not None:
            inner = inner + self.spring(e)
        return (self.load(time) - inner @ self.rows) / self.mass

    @property
    def mobility(self):
        """(j, j) acceleration along the joints per unit of force in them."""
        return (self.rows / self.mass) @ self.rows.T

    def friction(self, time, state, sliding):
        """Friction (j,) of joints that slide with the sign ``sliding`` (j,), 0: at rest, held."""
        force, rest = sliding * self.limit, (sliding == 0) & (self.limit > 0)
        if rest.any():
            left = self.rows @ self.pulled(time, state) - self.mobility @ force
            force[rest] = np.linalg.solve(self.mobility[np.ix_(rest, rest)], left[rest])
        return force

    def switched(self, time, state, sliding):
        """Signs (j,) after an event: joints at rest stay there, or slide where they would be overcome."""
        force, sliding = sliding * self.limit, sliding.copy()
        rest = np.flatnonzero((sliding == 0) & (self.limit > 0))
        pulled, mobility = self.rows @ self.pulled(time, state), self.mobility
        for _ in range(500 if len(rest) > 1 else 1):
            for k in rest:
                wanted = force[k] + (pulled - mobility @ force)[k] / mobility[k, k]
                force[k] = np.clip(wanted, -self.limit[k], self.limit[k])
        overcome = rest[abs(force[rest]) >= (1 - 1e-9) * self.limit[rest]]
        sliding[overcome] = np.sign(force[overcome])
        return sliding

    def motion(self, time, start, breaks=None):
        """Displacements (n, samples) at the instants ``time`` from the state ``start`` (2 n,).

        ``breaks``: instants among them at which the load has kinks.
        """
        state, shown = np.asarray(start, float), np.empty((len(self.mass), len(time)))
        sliding = self.switched(time[0], state, np.sign(self.rows @ np.split(state, 2)[1]) * (self.limit > 0))
        sides = np.array([np.sign(self.rows[k] @ np.split(state, 2)[0] - at) or 1.0 for k, at in self.kinks])
        for now, end in pairwise([time[0], time[-1]] if breaks is None else breaks):
            while now < end:
                now, state, sliding, sides = self._on(now, end, state, sliding, sides, time, shown)
        return shown

    def _on(self, now, end, state, sliding, sides, time, shown):
        """(time, state, signs of sliding, sides of the kinks) at the next event; fills what is ``shown`` till then."""
        def slope(t, y):
            force = self.friction(t, y, sliding)
            return np.concatenate((np.split(y, 2)[1], self.pulled(t, y) - force @ self.rows / self.mass))

        joints = np.flatnonzero(self.limit > 0)
        events = [self._stops(k, sliding) if sliding[k] else self._breaks_away(k, sliding) for k in joints]
        events += [self._passes(k, at, side) for (k, at), side in zip(self.kinks, sides, strict=True)]
        solution = solve_ivp(slope, (now, end), state, "DOP853", events=events, dense_output=True, rtol=1e-9,
                             atol=1e-12)
        inside = (time >= now) & (time <= solution.t[-1])
        if inside.any():
            shown[:, inside] = solution.sol(time[inside])[:len(self.mass)]
        now, state, sliding, sides = float(solution.t[-1]), solution.y[:, -1], sliding.copy(), sides.copy()
        if solution.status == 1:
            met = np.array([len(at) > 0 for at in solution.t_events])
            sliding[joints[met[:len(joints)]]] = 0
            sides[met[len(joints):]] *= -1
            sliding = self.switched(now, state, sliding)
        return now, state, sliding, sides

    def _stops(self, k, sliding):
        return _terminal(lambda _, y: sliding[k] * (self.rows[k] @ np.split(y, 2)[1]) + _PAST)

    def _breaks_away(self, k, sliding):
        return _terminal(lambda t, y: self.limit[k] - abs(self.friction(t, y, sliding)[k]))

    def _passes(self, k, at, side):
        return _terminal(lambda _, y: side * (self.rows[k] @ np.split(y, 2)[0] - at) + _PAST)


def _terminal(margin):
    """An event of solve_ivp that ends where ``margin`` falls through 0."""
    margin.terminal, margin.direction = True, -1
    return margin

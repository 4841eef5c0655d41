"""Masses with Coulomb friction between them, by SciPy from switch to switch: a reference without time steps of ours."""

from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp


class Masses:
    """``mass`` (n,) kg on springs and dampers along the ``rows`` (j, n), friction of the size ``limit`` (j,) N in each.

    ``knots`` (k,) s and ``load`` (k, n) N: forces on the masses, linear between.
    """

    def __init__(self, mass, rows, stiffness, damping, limit, knots, load):
        self.mass, self.rows, self.limit = (np.asarray(a, float) for a in (mass, rows, limit))
        self.stiffness, self.damping = np.asarray(stiffness, float), np.asarray(damping, float)
        self.knots, self.load = knots, load
        self.mobility = self.rows @ (self.rows / self.mass).T

    def pulled(self, time, state):
        """Accelerations (n,) without friction."""
        x, v = np.split(state, 2)
        force = [np.interp(time, self.knots, column) for column in self.load.T]
        inner = self.rows.T @ (self.stiffness * (self.rows @ x) + self.damping * (self.rows @ v))
        return (force - inner) / self.mass

    def friction(self, time, state, sliding):
        """Friction (j,) of joints that slide with the sign ``sliding`` (j,), 0: at rest, held."""
        force, rest = sliding * self.limit, sliding == 0
        if rest.any():
            left = self.rows @ self.pulled(time, state) - self.mobility @ force
            force[rest] = np.linalg.solve(self.mobility[np.ix_(rest, rest)], left[rest])
        return force

    def switched(self, time, state, sliding):
        """Signs (j,) after a switch: joints at rest stay there, or slide where they would be overcome."""
        force, sliding = sliding * self.limit, sliding.copy()
        rest = np.flatnonzero((sliding == 0) & (self.limit > 0))
        pulled = self.rows @ self.pulled(time, state)
        for _ in range(2000):
            for k in rest:
                wanted = force[k] + (pulled - self.mobility @ force)[k] / self.mobility[k, k]
                force[k] = np.clip(wanted, -self.limit[k], self.limit[k])
        overcome = rest[abs(force[rest]) >= (1 - 1e-9) * self.limit[rest]]
        sliding[overcome] = np.sign(force[overcome])
        return sliding

    def motion(self, time, start):
        """Displacements (n, samples) at the instants ``time``, some of them knots, from the state ``start`` (2 n,)."""
        state, now, shown = np.asarray(start, float), time[0], [np.asarray(start, float)]
        sliding = np.sign(self.rows @ np.split(state, 2)[1]) * (self.limit > 0)
        sliding = self.switched(now, state, sliding)
        for now, end in pairwise(time):
            while now < end:
                now, state, sliding = self._until_switch(now, end, state, sliding)
            shown.append(state)
        return np.array(shown).T[:len(self.mass)]

    def _until_switch(self, now, end, state, sliding):
        def slope(t, y):
            force = self.friction(t, y, sliding)
            return np.concatenate((np.split(y, 2)[1], self.pulled(t, y) - self.rows.T @ force / self.mass))

        def event(k):
            def margin(t, y):
                if sliding[k]:
                    return sliding[k] * (self.rows[k] @ np.split(y, 2)[1]) + 1e-13
                return self.limit[k] - abs(self.friction(t, y, sliding)[k])

            margin.terminal, margin.direction = True, -1
            return margin

        joints = np.flatnonzero(self.limit > 0)
        solution = solve_ivp(slope, (now, end), state, events=[event(k) for k in joints], rtol=1e-11, atol=1e-14)
        now, state = float(solution.t[-1]), solution.y[:, -1]
        if solution.status == 1:
            stopped = sliding.copy()
            stopped[[k for k, at in zip(joints, solution.t_events, strict=True) if len(at)]] = 0
            sliding = self.switched(now, state, stopped)
        return now, state, sliding

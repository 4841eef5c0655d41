"""Motion of a mechanism whose laws switch at events, by solve_ivp (DOP853) from one event to the next.

    M q'' + C q' + K q + sum_laws row F(t, e, v, z, mode) = push(t),    z' = G(t, e, v, z, mode)

e = row q, v = row q'. A law in mode HELD is a constraint v = 0: its force is whatever holds it, within limits, beyond
which it gives way (mode 1 above the upper one, -1 below the lower one). Nothing is smoothed: a held slip is zero, an
impact changes velocities at its instant, and no step goes across an event.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConvergenceError

HELD = 0
_RELATIVE, _ABSOLUTE = 1e-8, 1e-10
#: steps of the fastest vibration, and of a motion, at least, so that hardly a pair of events hides within one; most
#: events of a motion; most within a step, more of which are a chatter that nothing ends
_STEPS, _PIECES, _MOST, _CROWD = 10, 50, 20_000, 300
#: first steps of a piece, in longest ones: a slip that ends within the first one hides its end
_FIRST_STEPS = (0.03, 1e-3, 3e-5, 1e-6)
#: where the push is asked for the value left of a break, in longest steps
_BEFORE = 1e-9


@dataclass(frozen=True)
class Crossing:
    """Event of a law: ``value(t, e, v, z)`` passes 0 upwards; the law is then in mode ``then``, after
    ``change(mechanism, law, v, z)`` -> (velocities (n,), z), where there is one.

    ``then``: a mode, or STOPS where the slip comes to rest, so that forces decide, or ``then(v)`` -> one of these.
    """

    value: Callable
    then: object
    change: Callable | None = None


STOPS = "stops"


@dataclass(frozen=True)
class Law:
    """A force along ``row`` (n,) that resists: ``force(t, e, v, z, mode)`` N.

    ``states`` z that change by ``rates(t, e, v, z, mode)``, of typical ``scale``, from ``z0``; ``first``: the mode at
    the start, or ``first(e, v)`` -> mode; ``crossings(mode)`` -> (Crossing, ...); ``limits(t, e, z)`` -> (low, high) N
    of a law that can hold.
    """

    row: np.ndarray
    force: Callable
    states: int = 0
    rates: Callable | None = None
    scale: float = 1.0
    first: object = 1
    crossings: Callable = lambda mode: ()
    limits: Callable | None = None
    z0: tuple = ()


@dataclass(frozen=True)
class Mechanism:
    """``mass``, ``damping``, ``stiffness`` (n, n) and ``laws``; ``length`` m and ``speed`` m/s of a typical motion."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    laws: tuple = ()
    length: float = 1.0
    speed: float = 1.0

    @property
    def size(self):
        return len(self.mass)

    @property
    def fastest(self):
        """Highest angular frequency of the mechanism without its laws, rad/s."""
        return float(np.sqrt(np.abs(np.linalg.eigvals(np.linalg.solve(self.mass, self.stiffness))).max()))


@dataclass(frozen=True)
class Motion:
    """Displacements, velocities, accelerations (n, instant), and how many ``events`` there were."""

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    events: int


def moved(mechanism, push, time, start=None, breaks=(), accelerated=True):
    """Motion at the instants ``time`` from ``start`` (2 n,), at rest where it is None, under ``push(t)`` (n,) N.

    ``breaks`` s: where the push jumps or bends; ``push`` is asked right of them. ``accelerated``: whether accelerations
    are wanted; else they are zeros. Raises ConvergenceError.
    """
    run = _Run(mechanism, push, accelerated, time[-1] - time[0])
    state = run.begun(np.zeros(2 * mechanism.size) if start is None else np.asarray(start, float))
    modes = run.first_modes(time[0], state)
    ends = [t for t in sorted(breaks) if time[0] < t < time[-1]] + [time[-1]]
    found, now, events = [], time[0], 0
    since, crowd = now, 0
    for end in ends:
        while now < end:
            piece = run.piece(now, end, state, modes)
            inside = time[(time >= now) & ((time < piece.t[-1]) | (piece.t[-1] >= time[-1]))]
            if len(inside):
                found.append(run.shown(inside, piece.sol(inside), modes))
            now, state = piece.t[-1], piece.y[:, -1]
            if piece.status == 1:
                state, modes = run.switched(now, state, modes, [len(t) > 0 for t in piece.t_events])
                events += 1
                crowd = crowd + 1 if now - since < run.longest else 0
                since = since if crowd else now
            if events > _MOST or crowd > _CROWD:
                raise ConvergenceError("motion of a switching rig", f"at most {_MOST} events, {_CROWD} of them within"
                                       f" {run.longest:.3g} s", f"more, at {now:.3g} s")
    return Motion(*(np.concatenate(parts, axis=1) for parts in zip(*found, strict=True)), events)


class _Run:
    """One motion of a Mechanism under ``push``: its right-hand side and events in given modes."""

    def __init__(self, mechanism, push, accelerated, duration):
        self.mechanism, self.push, self.accelerated = mechanism, push, accelerated
        self.inverse, self.n = np.linalg.inv(mechanism.mass), mechanism.size
        counts = [law.states for law in mechanism.laws]
        firsts = 2 * self.n + np.concatenate(([0], np.cumsum(counts))).astype(int)
        self.slots = [slice(a, b) for a, b in zip(firsts[:-1], firsts[1:], strict=True)]
        scales = [[law.scale] * law.states for law in mechanism.laws]
        self.absolute = _ABSOLUTE * np.array([*[mechanism.length] * self.n, *[mechanism.speed] * self.n,
                                              *(s for part in scales for s in part)])
        self.longest = min(2 * np.pi / (_STEPS * mechanism.fastest), duration / _PIECES)
        self.last = np.inf

    def begun(self, start):
        states = [law.z0 or (0.0,) * law.states for law in self.mechanism.laws]
        return np.concatenate((start, *states)) if states else start

    def seen(self, law, slot, state):
        """(e, v, z) of a law."""
        return law.row @ state[:self.n], law.row @ state[self.n:2 * self.n], state[slot]

    def first_modes(self, time, state):
        modes = []
        for law, slot in zip(self.mechanism.laws, self.slots, strict=True):
            e, v, _ = self.seen(law, slot, state)
            modes.append(law.first(e, v) if callable(law.first) else law.first)
        stopping = [k for k, law in enumerate(self.mechanism.laws) if law.limits is not None and modes[k] == STOPS]
        for k in stopping:
            modes[k] = HELD
        for k in stopping:
            modes[k] = self._stopped(time, state, modes, k)
        return modes

    def forces(self, time, state, modes):
        """(n,) N of everything but what holds."""
        q, v = state[:self.n], state[self.n:2 * self.n]
        total = self.push(min(time, self.last)) - self.mechanism.stiffness @ q - self.mechanism.damping @ v
        for law, slot, mode in zip(self.mechanism.laws, self.slots, modes, strict=True):
            if law.limits is None or mode != HELD:
                total = total - law.row * law.force(time, law.row @ q, law.row @ v, state[slot], mode)
        return total

    def holding(self, law, total):
        """N that a law must bear so that its slip does not change, under all other forces ``total`` (n,)."""
        along = self.inverse @ law.row
        return along @ total / (law.row @ along)

    def acceleration(self, time, state, modes):
        total = self.forces(time, state, modes)
        for law, mode in zip(self.mechanism.laws, modes, strict=True):
            if law.limits is not None and mode == HELD:
                total = total - law.row * self.holding(law, total)
        return self.inverse @ total

    def rate(self, modes):
        def rate(time, state):
            change = np.empty(len(state))
            change[:self.n] = state[self.n:2 * self.n]
            change[self.n:2 * self.n] = self.acceleration(time, state, modes)
            for law, slot, mode in zip(self.mechanism.laws, self.slots, modes, strict=True):
                if law.states:
                    change[slot] = law.rates(time, *self.seen(law, slot, state), mode)
            return change
        return rate

    def piece(self, begin, end, state, modes):
        """Solution up to the next event, or to ``end``, left of which the push is asked."""
        self.last = end - _BEFORE * self.longest
        events = [self._event(law, slot, crossing, modes, begin) for law, slot, crossing in self._crossings(modes)]
        for part in _FIRST_STEPS:
            first = min(part * self.longest, end - begin)
            solution = solve_ivp(self.rate(modes), (begin, end), state, "DOP853", dense_output=True, rtol=_RELATIVE,
                                 events=events or None, atol=self.absolute, max_step=self.longest, first_step=first)
            if solution.status < 0 or not np.isfinite(solution.y).all():
                raise ConvergenceError("motion of a switching rig", "an integration that succeeds", solution.message)
            if solution.status == 0 or solution.t[-1] - begin > _BEFORE * self.longest:
                break
        return solution

    def _crossings(self, modes):
        """[(law, slot, Crossing)] of all that can happen in these modes."""
        listed = []
        for law, slot, mode in zip(self.mechanism.laws, self.slots, modes, strict=True):
            if law.limits is not None and mode == HELD:
                listed += [(law, slot, Crossing(side, then)) for side, then in ((1, 1), (-1, -1))]
            else:
                listed += [(law, slot, crossing) for crossing in law.crossings(mode)]
        return listed

    def _event(self, law, slot, crossing, modes, begin):
        """Event of solve_ivp; one that has just passed counts as about to pass, so that its return is not missed."""
        def event(time, state):
            value = asked(time, state)
            return min(value, 0.0) if time == begin else value

        def asked(time, state):
            if callable(crossing.value):
                return crossing.value(time, *self.seen(law, slot, state))
            low, high = law.limits(time, law.row @ state[:self.n], state[slot])
            force = self.holding(law, self.forces(time, state, modes))
            return force - high if crossing.value == 1 else low - force
        event.terminal, event.direction = True, 1
        return event

    def switched(self, time, state, modes, happened):
        """(state, modes) after the events of a piece that ``happened``."""
        state, modes = state.copy(), list(modes)
        for (law, slot, crossing), so in zip(self._crossings(modes), happened, strict=True):
            if not so:
                continue
            k = next(i for i, other in enumerate(self.mechanism.laws) if other is law)
            modes[k] = crossing.then(self.seen(law, slot, state)[1]) if callable(crossing.then) else crossing.then
            if crossing.change is not None:
                state[self.n:2 * self.n], state[slot] = crossing.change(
                    self.mechanism, law, state[self.n:2 * self.n], state[slot])
            if modes[k] == STOPS:
                modes[k] = HELD
                state[self.n:2 * self.n] = stopped(self.mechanism, law, state[self.n:2 * self.n])
                modes[k] = self._stopped(time, state, modes, k)
        return state, modes

    def _stopped(self, time, state, modes, k):
        """Mode of the law ``k`` whose slip is zero: held, or the side to which the others push it on."""
        law, slot = self.mechanism.laws[k], self.slots[k]
        force = self.holding(law, self.forces(time, state, modes))
        low, high = law.limits(time, law.row @ state[:self.n], state[slot])
        return 1 if force > high else -1 if force < low else HELD

    def shown(self, time, states, modes):
        accelerations = np.zeros((self.n, len(time)))
        if self.accelerated:
            accelerations = np.array([self.acceleration(t, s, modes) for t, s in zip(time, states.T, strict=True)]).T
        return states[:self.n], states[self.n:2 * self.n], accelerations


def stopped(mechanism, law, velocity, restitution=0.0):
    """Velocities (n,) after a blow along a law that leaves its slip at minus ``restitution`` times what it was."""
    along = np.linalg.solve(mechanism.mass, law.row)
    slip = law.row @ velocity
    velocity = velocity - (1 + restitution) * slip * along / (law.row @ along)
    return velocity - (law.row @ velocity) * along / (law.row @ along) if restitution == 0.0 else velocity

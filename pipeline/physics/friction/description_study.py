"""The three friction descriptions of Allgaier et al. (1999), section 4, in an implicit FE-like setting, counted.

Many contacts with two tangential directions each ("3D contact") under Newmark's trapezoidal rule; every step solves

    M a + C v + K u = f + sum_i n_i N_i + t_i T_i,     N_i = N(closure),  T_i by the description,

by Newton's method without line search, as FE codes of the time did; a step that does not converge is halved. The
tangent holds dT/ds and, where ``consistent``, the unsymmetric dT/dN, which the paper says its evolution rule lacked.

- evolution: T = L e + (T0 - L e) exp(-k |s| / L) for the slip increment s along e, limit L = mu N;
- elastic: T = T0 + k s, returned radially to L;
- rigid: multipliers; no slip increment while |T + r s| < L, else T = L (T + r s) / |T + r s| (Alart & Curnier 1991).
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.friction.dry_friction import DESCRIPTIONS, evolution_curve
from pipeline.physics.numerics import newmark

#: Newton iterations before a step counts as diverged; the shortest step as a share of the whole
ITERATIONS, SHORTEST = 25, 1 / 256
TOLERANCE = 1e-6


@dataclass(frozen=True)
class Sliding:
    """n coordinates, c contacts on a drive: ``normal`` (c, n), ``tangent`` (2, c, n).

    Normal law N = ``pressure_scale`` (exp(closure / ``length``) - 1), N and m; ``stiffness`` N/m is the tangential one
    of each contact. ``load`` (n,) N, modulated by 1 + ``modulation`` sin(2 pi ``frequency`` t); ``drive`` (2,) m/s
    turns to and fro by ``swing`` rad at the same frequency.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiff: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    load: np.ndarray
    drive: np.ndarray
    friction: float
    stiffness: float
    pressure_scale: float
    length: float
    modulation: float = 0.5
    frequency: float = 2250.0
    swing: float = 0.5


@dataclass(frozen=True)
class Count:
    """Of one run: Newton iterations of every attempted step, halvings, unknowns per solution, slipping share, and the
    displacement (steps, n) reached; ``converged``: whether no step had to be given up."""

    iterations: np.ndarray
    halvings: int
    unknowns: int
    sliding_share: float
    displacement: np.ndarray
    converged: bool

    @property
    def cost(self):
        """Solutions of linear equations times their cubed size: work of the factorisations."""
        return float(self.iterations.sum()) * self.unknowns**3


def block_on_drive(side=4, friction=0.4, **options):
    """Sliding of a block with ``side`` x ``side`` elastic feet on a drive: 3 coordinates a foot, 5 of the block.

    The block shifts in three directions and tilts about two axes; springs hold it at about 2.2 kHz, as pin and disc
    are held. Its damping and the length of its normal law are chosen so that it follows its load: with stiffer, less
    damped contacts it bounces irregularly, and no two descriptions give the same motion.
    """
    feet, half = side * side, 0.005
    place = np.array([(x, y) for x in np.linspace(-half, half, side) for y in np.linspace(-half, half, side)])
    size, base = 3 * feet + 5, 3 * feet
    stiff, mass = np.zeros((size, size)), np.diag(np.r_[np.full(base, 1e-4), [0.05] * 3, [5e-6] * 2])
    for foot, (x, y) in enumerate(place):
        for axis, spring in enumerate((2e7, 2e7, 5e7)):
            row = np.zeros(size)
            row[3 * foot + axis], row[base + axis] = 1.0, -1.0
            if axis == 2:
                row[base + 3], row[base + 4] = -x, -y
            else:
                row[base + 3 + axis] = 0.005    # the axes of tilt lie above the feet
            stiff += spring * np.outer(row, row)
    held = 0.05 * (2 * np.pi * 2200.0) ** 2
    stiff[base:base + 2, base:base + 2] += held * np.eye(2)
    stiff[base + 3:, base + 3:] += 200.0 * np.eye(2)
    unit = np.eye(size)
    load = np.zeros(size)
    load[base + 2] = -20.0
    options_used = {"drive": np.array([0.04, 0.0]), "stiffness": 5e6, "pressure_scale": 0.5, "length": 1e-6, **options}
    return Sliding(mass, 1e-5 * stiff + 2e3 * mass, stiff, unit[2:base:3], np.array([unit[0:base:3], unit[1:base:3]]),
                   load, friction=friction, **options_used)


def run(problem, description, step, steps, consistent=True):
    """Count of ``steps`` steps of ``step`` s from rest under the load without friction."""
    if description not in DESCRIPTIONS:
        raise ConfigError("friction description", f"one of {', '.join(DESCRIPTIONS)}", repr(description))
    state = _State(problem, description, consistent)
    kept, iterations, halvings, slid = [], [], 0, []
    for number in range(steps):
        done, length = 0.0, 1.0
        while done < 1 - 1e-12:
            used, sliding = state.advance((number + done) * step, length * step)
            iterations.append(used)
            if sliding is None:
                halvings, length = halvings + 1, length / 2
                if length < SHORTEST:
                    return Count(np.array(iterations), halvings, state.unknowns, float(np.mean(slid or [0.0])),
                                 np.array(kept), False)
                continue
            slid.append(sliding)
            done += length
        kept.append(state.place.copy())
    return Count(np.array(iterations), halvings, state.unknowns, float(np.mean(slid)), np.array(kept), True)


def curve_error(displacement, force, limit, description, stiffness, exponent=1.0):
    """Root mean square error over ``limit`` of first loading by one description against a curve (k,), (k,)."""
    if description == "evolution":
        drawn = evolution_curve(np.asarray(displacement, float), limit, stiffness, exponent)
    elif description == "elastic":
        drawn = np.minimum(stiffness * displacement, limit)
    else:
        drawn = np.where(displacement > 0, limit, 0.0)
    return float(np.sqrt(np.mean((np.asarray(drawn) - force) ** 2)) / limit)


class _State:
    """Motion, friction forces (2, c) and the implicit step of one run."""

    def __init__(self, problem, description, consistent):
        self.problem, self.description, self.consistent = problem, description, consistent
        self.place = _pressed(problem)
        self.speed, self.pull = np.zeros_like(self.place), np.zeros((2, len(problem.normal)))
        normal, _ = _normal(problem, self.place)
        self.rate = np.linalg.solve(problem.mass, problem.load + problem.normal.T @ normal - problem.stiff @ self.place)
        self.unknowns = len(self.place) + (self.pull.size if description == "rigid" else 0)

    def advance(self, time, step):
        """(iterations, sliding share) of one step; None for the share where Newton's method does not converge."""
        p = self.problem
        ahead, fast = newmark.predicted(self.place, self.speed, self.rate, step)
        way, load = _way(p, time, step), p.load * (1 + p.modulation * np.sin(2 * np.pi * p.frequency * (time + step)))
        inertia = 4 / step**2 * p.mass + 2 / step * p.damping + p.stiff
        u, pull, scale = self.place.copy(), self.pull.copy(), np.linalg.norm(p.load)
        for iteration in range(1, ITERATIONS + 1):
            rate = 4 / step**2 * (u - ahead)
            slip = way - np.einsum("dcn,n->dc", p.tangent, u - self.place)
            normal, stiff = _normal(p, u)
            limit = p.friction * normal
            inner = p.mass @ rate + p.damping @ (fast + step / 2 * rate) + p.stiff @ u - load - p.normal.T @ normal
            tangent = inertia + (p.normal.T * stiff) @ p.normal
            coupling = p.friction * stiff if self.consistent else 0 * stiff
            if self.description == "rigid":
                change, pull_change, miss, sliding = self._multiplied(inner, tangent, pull, slip, limit, coupling)
            else:
                pull, by_slip, by_limit, sliding = _yielding(p, self.description, self.pull, slip, limit)
                miss = inner - np.einsum("dcn,dc->n", p.tangent, pull)
                tangent = tangent + np.einsum("dci,dec,ecj->ij", p.tangent, by_slip, p.tangent)
                tangent = tangent + np.einsum("dci,dc,cj->ij", p.tangent, by_limit * coupling, p.normal)
                change, pull_change = np.linalg.solve(tangent, -miss), 0.0
            size = np.linalg.norm(miss)
            if size <= TOLERANCE * scale:
                self.place, self.speed, self.rate, self.pull = u, fast + step / 2 * rate, rate, pull
                return iteration, float(sliding.mean())
            if not np.isfinite(size) or size > 1e8 * scale:
                return iteration, None
            u, pull = u + change, pull + pull_change
        return ITERATIONS, None

    def _multiplied(self, inner, tangent, pull, slip, limit, coupling):
        """One Newton step with the friction forces as unknowns: (du, dT, imbalance, sliding contacts)."""
        p, count, size = self.problem, len(limit), len(inner)
        trial = pull + p.stiffness * slip
        length = np.maximum(np.hypot(*trial), 1e-300)
        along, sliding = trial / length, length > limit
        gap = np.where(sliding, pull - limit * along, -p.stiffness * slip)
        turn = _turning(along) * limit / length         # of the direction with the trial force
        by_pull = np.where(sliding, np.eye(2)[:, :, None] - turn, 0.0)
        by_slip = np.where(sliding, -p.stiffness * turn, -p.stiffness * np.eye(2)[:, :, None])
        rows = np.concatenate(p.tangent)
        lower = np.einsum("dec,ecn->dcn", -by_slip, p.tangent)
        lower = lower + np.where(sliding, along * coupling, 0.0)[:, :, None] * p.normal
        corner = np.zeros((2, count, 2, count))
        index = np.arange(count)
        corner[:, index, :, index] = np.moveaxis(by_pull, 2, 0)
        matrix = np.block([[tangent, -rows.T], [lower.reshape(2 * count, size), corner.reshape((2 * count,) * 2)]])
        miss = np.r_[inner - rows.T @ pull.ravel(), gap.ravel()]
        step = np.linalg.solve(matrix, -miss)
        return step[:size], step[size:].reshape(2, count), miss, sliding


def _turning(along):
    """(2, 2, c): I - e e^T."""
    return np.eye(2)[:, :, None] - along[:, None] * along[None]


def _yielding(problem, description, begin, slip, limit):
    """(T, dT/ds (2, 2, c), dT/dL (2, c), sliding (c,)) of the elastic stick or the evolution rule."""
    k, identity = problem.stiffness, np.eye(2)[:, :, None]
    if description == "elastic":
        trial = begin + k * slip
        length = np.maximum(np.hypot(*trial), 1e-300)
        along, sliding = trial / length, length > limit
        return (np.where(sliding, limit * along, trial), np.where(sliding, k * limit / length * _turning(along),
                                                                  k * identity), np.where(sliding, along, 0.0), sliding)
    closed, length = limit > 0, np.hypot(*slip)
    safe = np.where(closed, limit, 1.0)
    along = np.where(length > 0, slip / np.maximum(length, 1e-300), 0.0)
    left = np.where(closed, np.exp(-k * length / safe), 0.0)
    drawn = limit * along + (begin - limit * along) * left
    forwards = k / safe * left * (limit * along - begin)
    sideways = np.where(length > 0, limit * (1 - left) / np.maximum(length, 1e-300), k * closed)
    by_slip = forwards[:, None] * along[None] + sideways * _turning(along)
    by_limit = along * (1 - left) + (begin - limit * along) * left * k * length / safe**2
    return drawn, by_slip, by_limit, left < 0.01


def _normal(problem, u):
    """Force and stiffness (c,): exponential rise from zero at touch, linear beyond twenty lengths."""
    closure = -(problem.normal @ u) / problem.length
    rise = np.exp(np.clip(closure, 0.0, 20.0))
    force = problem.pressure_scale * (rise - 1 + rise * np.maximum(closure - 20.0, 0.0))
    return np.where(closure > 0, force, 0.0), np.where(closure > 0, problem.pressure_scale * rise / problem.length, 0.0)


def _way(problem, time, step):
    """(2, 1) way of the drive over a step."""
    angle = problem.swing * np.sin(2 * np.pi * problem.frequency * (time + step / 2))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return step * (turn @ problem.drive)[:, None]


def _pressed(problem):
    """Equilibrium (n,) under the load without friction."""
    u = np.zeros(len(problem.load))
    u -= 2 * problem.length * problem.normal.sum(axis=0)
    for _ in range(200):
        normal, stiff = _normal(problem, u)
        miss = problem.load + problem.normal.T @ normal - problem.stiff @ u
        if np.linalg.norm(miss) <= 1e-9 * np.linalg.norm(problem.load):
            return u
        change = np.linalg.solve(problem.stiff + (problem.normal.T * stiff) @ problem.normal
                                 + 1e-9 * np.diag(np.diag(problem.stiff)), miss)
        u = u + change * min(1.0, problem.length / max(abs(problem.normal @ change).max(), 1e-300))
    raise ConvergenceError("friction descriptions: pressing on", "equilibrium without friction", "none in 200 steps")

"""The linear part of a sliding model for time stepping: pairs of states that evolve by themselves, and their step.

Real modes q of the supported system with open contacts: q'' + D q' + W q = modal force. Where D is diagonal, the pair
(q_j, q_j') of each mode evolves by itself; modes that D couples are split by the eigenvectors of their state matrix
into pairs (real and imaginary part of a complex mode, or two real ones). Every pair x obeys x' = A x + B f, and its
step is exact for forces that are linear in time (Nigam & Jennings 1969), in all limits: w = 0, undamped, over-damped.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.numerics import newmark

#: share of the largest squared frequency, and of the largest damping, that counts as rounding
_ROUNDING = 1e-12
_COUPLING = 1e-9
#: worst conditioning of the eigenvectors of coupled modes
_CONDITION = 1e10
#: largest norm of a matrix whose exponential is taken by a Taylor series of so many terms: 0.5^16 / 16! = 7e-19
_SERIES, _TERMS = 0.5, 15
#: modal systems that are kept: runs of one model follow one another
_KEPT = 8


@dataclass(frozen=True)
class ModalSystem:
    """m real modes and their m pairs of states.

    ``squared`` (m,) rad^2/s^2, ``damping`` (m, m) 1/s, ``shape`` (n, m) mass-normalised, ``momentum`` (m, n) =
    shape^T M, which takes motions to modes; ``blocks`` (m, 2, 2) the A of the pairs; ``state`` (2m, 2, m) takes pairs
    to (q, q'), ``pairs`` (2, m, 2m) back; ``coupled``: whether pairs differ from modes.
    """

    squared: np.ndarray
    damping: np.ndarray
    shape: np.ndarray
    momentum: np.ndarray
    blocks: np.ndarray
    state: np.ndarray
    pairs: np.ndarray
    coupled: bool

    @property
    def highest(self):
        """Highest natural frequency, rad/s."""
        return float(np.sqrt(abs(self.squared).max(initial=0.0)))

    def observed(self, rows):
        """(2, r, 2, m): displacement and velocity of ``rows`` (r, n) from the pairs."""
        modal, half = rows @ self.shape, len(self.squared)
        return np.array([np.einsum("rj,jab->rab", modal, part) for part in (self.state[:half], self.state[half:])])

    def driven(self, rows):
        """(r, 2, m): rate of the pairs per unit force along each of ``rows`` (r, n)."""
        return np.einsum("abj,rj->rab", self.pairs[..., len(self.squared):], rows @ self.shape)

    def to_pairs(self, displacement, velocity):
        """Pairs (2, m) of a displacement and a velocity (n,)."""
        return self.pairs @ np.concatenate((self.momentum @ displacement, self.momentum @ velocity))

    def from_pairs(self, pairs):
        """(displacement, velocity), (n,) each, of pairs (2, m)."""
        state = np.einsum("jab,ab->j", self.state, pairs)
        return [self.shape @ half for half in np.split(state, 2)]


def modal_system(model, damping="full", highest=np.inf):
    """ModalSystem of a SlidingModel with its joints and without its contacts.

    ``damping`` is full, or diagonal to drop what couples the modes; ``highest`` (Hz) leaves out the modes above it.
    Raises ConfigError where the mass is not positive definite or coupled modes are critically damped.
    """
    parts = [np.ascontiguousarray(matrix, float).tobytes() for matrix in model.supported()]
    return _modal_system(*parts, model.size, damping, highest)


@lru_cache(_KEPT)
def _modal_system(mass, drag, stiffness, size, damping, highest):
    mass, drag, stiffness = (np.frombuffer(m).reshape(size, size) for m in (mass, drag, stiffness))
    try:
        squared, shape = scipy.linalg.eigh((stiffness + stiffness.T) / 2, mass)
    except np.linalg.LinAlgError:
        raise ConfigError("time stepping: mass", "a positive definite matrix", "a massless motion",
                          "give every coordinate a mass") from None
    kept = squared <= (2 * np.pi * highest) ** 2
    squared, shape = squared[kept], shape[:, kept]
    squared = np.where(abs(squared) <= _ROUNDING * abs(squared).max(initial=0.0), 0.0, squared)
    modal = shape.T @ drag @ shape
    if damping == "diagonal":
        modal = np.diag(np.diag(modal))
    return ModalSystem(squared, modal, shape, shape.T @ mass, *_pairs(squared, modal))


def step_matrices(system, step):
    """(E, first, last), each (m, 2, 2): exact step of the pairs, x -> E x + first B f + last B f next."""
    return _step_matrices(np.ascontiguousarray(system.blocks, float).tobytes(), system.coupled, step)


@lru_cache(_KEPT)
def _step_matrices(blocks, coupled, step):
    blocks = np.frombuffer(blocks).reshape(-1, 2, 2)
    count = len(blocks)
    scale = np.ones((count, 2))
    if not coupled:
        scale[:, 1] = 1 / step      # (q, h q'): the entries of the exponent are of one size
    augmented = np.zeros((count, 6, 6))
    augmented[:, :2, :2] = step * blocks * scale[:, None, :] / scale[:, :, None]
    augmented[:, [0, 1, 2, 3], [2, 3, 4, 5]] = 1.0
    grown = _exponential(augmented)[:, :2]
    back = scale[:, :, None] / scale[:, None, :]
    once, ramp = step * grown[..., 2:4] * back, step * grown[..., 4:6] * back
    return grown[..., :2] * back, once - ramp, ramp


def _exponential(matrices):
    """exp of each of ``matrices`` (m, a, a), by a Taylor series of halved ones that is squared again.

    Its last term is below rounding. All at once, where scipy.linalg.expm takes one after the other.
    """
    size = np.abs(matrices).sum(axis=2).max(initial=0.0)
    halvings = max(0, int(np.ceil(np.log2(max(size, 1e-300) / _SERIES))))
    halved, unit = matrices / 2.0**halvings, np.eye(matrices.shape[-1])
    grown = np.broadcast_to(unit, matrices.shape)
    for term in range(_TERMS, 0, -1):
        grown = unit + halved @ grown / term
    for _ in range(halvings):
        grown = grown @ grown
    return grown


def newmark_matrices(system, step, gamma):
    """(E, first, last) as of ``step_matrices``, by Newmark's rule with a = f - D v - W q.

    Raises ConfigError for coupled modes.
    """
    if system.coupled:
        raise ConfigError("time stepping: lagrange", "modes that damping does not couple", "coupled modes",
                          "take diagonal modal damping")
    pull, drag = system.squared, np.diag(system.damping)
    inertia = 1 + gamma * step * drag + newmark.beta_of(gamma) * step**2 * pull
    matrices = []
    for q, v, force, force_next in np.eye(4):
        a = force - drag * v - pull * q
        ahead, fast = newmark.predicted(q, v, a, step, gamma)
        a_next = (force_next - drag * fast - pull * ahead) / inertia
        matrices.append(newmark.corrected(ahead, fast, a_next, step, gamma))
    step_matrix = np.moveaxis(np.array(matrices), 2, 0).swapaxes(1, 2)      # (m, 2, 4)
    first, last = (np.stack([np.zeros_like(step_matrix[..., 0]), step_matrix[..., k]], axis=2) for k in (2, 3))
    return step_matrix[..., :2], first, last


def _pairs(squared, damping):
    """(blocks, state, pairs, coupled): modes that damping does not couple stay, the others are split."""
    count = len(squared)
    blocks, state, pairs = np.zeros((count, 2, 2)), np.zeros((2 * count, 2, count)), np.zeros((2, count, 2 * count))
    linked = abs(damping) > _COUPLING * abs(damping).max(initial=0.0)
    if not linked[~np.eye(count, dtype=bool)].any():
        members, unit = np.arange(count), np.zeros((count, 2, 2, count))
        blocks[:, 0, 1], blocks[:, 1, 0], blocks[:, 1, 1] = 1.0, -squared, -np.diag(damping)
        unit[members, 0, 0, members] = unit[members, 1, 1, members] = 1.0
        state = unit.swapaxes(0, 1).reshape(2 * count, 2, count)
        return blocks, state, np.ascontiguousarray(state.transpose(1, 2, 0)), False
    graph = scipy.sparse.csr_array(linked, dtype=float)     # as the library has it: it takes others in twice the time
    groups, label = scipy.sparse.csgraph.connected_components(graph, connection="weak")
    for group in range(groups):
        members = np.flatnonzero(label == group)
        both = np.concatenate((members, members + count))
        matrix = np.block([[np.zeros((len(members),) * 2), np.eye(len(members))],
                           [-np.diag(squared[members]), -damping[np.ix_(members, members)]]])
        if len(members) == 1:
            split, blocks[members[0]] = np.eye(2), matrix
        else:
            split, blocks[members] = _split(matrix)
        columns = np.arange(2 * len(members)).reshape(len(members), 2)   # columns of the pairs of the group
        inverse = np.linalg.inv(split)
        for member, pair in zip(members, columns, strict=True):
            state[both, :, member] = split[:, pair]
            pairs[:, member, both] = inverse[pair]
    return blocks, state, pairs, groups < count


def _split(matrix):
    """(basis, blocks): real basis (2g, 2g) in which ``matrix`` is block diagonal with the blocks (g, 2, 2)."""
    value, vector = np.linalg.eig(matrix)
    upper, real = np.flatnonzero(value.imag > 0), np.flatnonzero(value.imag == 0)
    columns, blocks = [], []
    for k in upper:
        columns += [vector[:, k].real, vector[:, k].imag]
        blocks.append([[value[k].real, value[k].imag], [-value[k].imag, value[k].real]])
    for first, second in real.reshape(-1, 2):
        columns += [vector[:, first].real, vector[:, second].real]
        blocks.append(np.diag(value[[first, second]].real))
    basis = np.column_stack(columns)
    rows = np.linalg.norm(basis, axis=1, keepdims=True)
    condition = np.linalg.cond(basis / np.where(rows > 0, rows, 1.0))
    if not condition < _CONDITION:
        raise ConfigError("time stepping: damping", "coupled modes with distinct roots",
                          f"eigenvectors of condition {condition:.2g}",
                          "change a damper a little, or take diagonal modal damping")
    return basis, np.array(blocks)

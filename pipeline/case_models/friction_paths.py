"""Unstable modes of a case followed over friction: the system at shares of the friction, and fields of the product."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.physics.sliding.model import congruent
from pipeline.physics.stability.constrained_modes import is_hard
from pipeline.physics.stability.friction_path import FrictionSystem, enriched, friction_path
from pipeline.physics.stability.growth_balance import body_shares
from pipeline.physics.system.system import runs
from pipeline.products.motion import COUPLING, FALLING, SINGLE

#: difference of two frequencies, as a share of them, that is rounding next to a coalescence
_EQUAL = 1e-7
#: MAC from which on two modes count as meeting: their shapes share half of their amplitude squared
_MEETING = 0.5


@dataclass(frozen=True)
class OverFriction:
    """``system`` ((M, C, K), Settling or None) over the share of friction, in the coordinates of ``basis`` (n, m).

    ``inverse`` (m, n): coordinates of a motion that the basis holds.
    """

    system: Callable
    basis: np.ndarray
    inverse: np.ndarray


def over_friction(linearised, model, sliding, basis, shapes, hysteretic):
    """OverFriction of an operating point, with the growing modes ``shapes`` (n, g) exactly.

    ``linearised`` (model, Steady, basis) gives the matrices; ``model`` is a SlidingModel about ``sliding``, a Steady,
    ``basis`` a FrictionBasis; ``hysteretic``: (damping, stiffness), each (n, n), that its loss factors add, or None.
    """
    if is_hard(model):
        system = partial(_with_share, linearised, model, sliding, basis)
        return OverFriction(system, basis.shape, basis.shape.T @ model.mass)
    whole = replace(basis, shape=enriched(basis.shape, model.mass, shapes))
    about = model.projected(whole.shape)
    system = FrictionSystem(*(_with_share(linearised, about, sliding, whole, share) for share in (0.0, 1.0)))
    if hysteretic is not None:
        system = system.with_losses(*(congruent(part, whole.shape, runs(model.coordinate_body)) for part in hysteretic))
    return OverFriction(system, whole.shape, whole.shape.T @ model.mass)


def _with_share(linearised, model, sliding, basis, share):
    return linearised(model, sliding.with_share(share), basis)


def followed(neutral, over, root, motion):
    """FrictionPath, its shapes in all coordinates, of a ``root`` 1/s and its ``motion`` (n,) in an OverFriction."""
    path = friction_path(over.system, root, over.inverse @ motion, neutral)
    return replace(path, start=over.basis @ path.start)


def path_fields(index, paths, friction, falling, model, diameters):
    """Fields of ComplexModes of the FrictionPaths of unstable modes number ``index`` (f,).

    ``friction`` (f,): coefficient at the operating point of each; ``falling`` (f,): whether friction that falls with
    slip speed feeds it most; ``model``: product ReducedModel; ``diameters`` (shapes (g, v, 3)): nodal diameters of the
    disc in them.
    """
    lengths = [len(p.share) for p in paths]
    starts = np.array([shape[:len(model.mass)] for p in paths for shape in p.start.T])
    starts = starts.reshape(2 * len(paths), len(model.mass))        # without coordinates that effects add
    moves = starts.any(axis=1)
    body, lines = np.full(len(starts), -1), np.full(len(starts), -1)
    body[moves] = [np.argmax(body_shares(model, shape)) for shape in starts[moves]]
    if moves.any():
        lines[moves] = diameters(on_surface(model, starts[moves]))
    roots, others = ([getattr(p, name) for p in paths] for name in ("root", "meeting"))
    pair = [(root[0], other[0]) for root, other in zip(roots, others, strict=True)]
    mechanism = [FALLING if falls else COUPLING if path.alike >= _MEETING else SINGLE
                 for falls, path in zip(falling, paths, strict=True)]
    return {"followed_mode": index, "followed_mechanism": mechanism,
            "followed_critical": friction * [p.critical for p in paths],
            "followed_alike": [p.alike for p in paths], "followed_nearest": [_nearest(p) for p in paths],
            "pair_root": np.reshape(pair, (len(paths), 2)), "pair_body": body.reshape(-1, 2),
            "pair_diameters": lines.reshape(-1, 2), "path_mode": np.repeat(index, lengths),
            "path_friction": np.concatenate([[]] + [f * p.share for f, p in zip(friction, paths, strict=True)]),
            "path_root": np.concatenate([np.empty(0, complex), *roots]),
            "path_meeting": np.concatenate([np.empty(0, complex), *others])}


def on_surface(model, motions):
    """Motions (g, v, 3) of the surface of a product ReducedModel, in single precision.

    ``motions``: each (n,) complex, or longer by coordinates that effects add.
    """
    vertices, axes, size = model.recovery.shape
    given = np.array([motion[:size] for motion in motions], complex).reshape(-1, size)
    parts = np.concatenate((given.real, given.imag)).astype(model.recovery.dtype)   # one pass of the large matrix
    moved = (model.recovery.reshape(-1, size) @ parts.T).T.reshape(2, len(given), vertices, axes)
    return (moved[0] + 1j * moved[1]).astype(np.complex64)


def _nearest(path):
    """Smallest distance (Hz) of the frequencies of the two modes on the path; 0 where they become equal, but for
    rounding, or without a second one."""
    known = path.meeting != 0
    distance = (path.root.imag - path.meeting.imag)[known]
    equal = (np.sign(distance) != np.sign(distance[:1])).any() or (abs(distance) < _EQUAL * path.root[-1].imag).any()
    return 0.0 if equal or not known.any() else abs(distance).min() / (2 * np.pi)

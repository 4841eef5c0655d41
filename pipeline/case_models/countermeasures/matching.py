"""What a countermeasure makes of each unstable mode: weaker, stronger, gone, as it was, or not to be told; new ones.

An unstable mode before is sought among all modes after, stable ones too, by the MAC on the surface nodes that both
models have; a mode that is unstable after and is none of these, among all modes before. Near a flutter boundary a mode
that was one mixture of two may be like both of them afterwards: where all that it may be are stable, it is gone,
whichever it is; else the match is ambiguous and no growth rate is compared.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.countermeasures.nearby_modes import among, modes_about, points_of, shapes_of
from pipeline.physics.modal.shape_matching import common_points, counterparts

UNCHANGED, WEAKER, STRONGER, GONE, NEW, AMBIGUOUS = STATES = (
    "unchanged", "weaker", "stronger", "gone", "new", "ambiguous")
#: a MAC below says nothing: the counterpart is not known
_KNOWN = 0.25
#: roots this close, as a share, are of one frequency
_NEAR = 0.02
#: roots of two solutions of one system differ by less than this share
_SOLVED = 1e-5


@dataclass(frozen=True)
class ComparedMode:
    """One mode at one operating point: roots (1/s) before and after, None where no counterpart is known; the ``mac`` of
    the two, the largest of a ``rival``, whether the match is ``clear``, and one of STATES; ``error`` (1/s): by how much
    finer models move a growth rate."""

    operating: int
    before: complex | None
    after: complex | None
    mac: float
    rival: float
    clear: bool
    state: str
    error: float


def compared_modes(base, other, convergence, neutral, operating=None):
    """[ComparedMode] of two Brakes, those unstable before first, strongest first, at each operating point.

    ``convergence``: product of the case; growth up to ``neutral`` times the size of a root is none; ``operating``: one
    operating point alone, an index. Roots after are those of the reduced model, moved by what the full matrices move
    the root before.
    """
    points = common_points(*points_of(base.model)[:2], *points_of(other.model)[:2])
    where = range(len(base.modes.operating_speed)) if operating is None else (operating,)
    return [row for k in where for row in _at(k, base, other, points, convergence, neutral)]


def _at(operating, base, other, points, convergence, neutral):
    before, after = (np.flatnonzero(b.modes.unstable_operating == operating) for b in (base, other))
    before = before[np.argsort(-base.modes.unstable_root[before].real, kind="stable")]
    reduced, unstable = base.modes.unstable_reduced[before], other.modes.unstable_reduced[after]
    if not len(before) and not len(after):
        return []
    root, shape = modes_about(other, operating, np.concatenate((reduced, unstable)))
    match = counterparts(points.mac(shapes_of(base, operating, before), shape))
    grows = root.real > neutral * abs(root)
    shift = base.modes.unstable_root[before] - reduced
    rows = [_row(operating, match, k, base.modes.unstable_root[j], root + shift[k], grows, convergence)
            for k, j in enumerate(before)]
    taken = {k for mode in range(len(before)) for k in _may_be(match, mode)}
    left = np.array([k for k in np.flatnonzero(grows) if k not in taken and among(root[k], unstable, _SOLVED)], int)
    return rows + _new(operating, base, points, root[left], shape[left], convergence)


def _may_be(match, mode):
    """Indices of what a mode may be afterwards; none where nothing is like it."""
    if match.counterpart[mode] < 0 or match.alike(mode)[0] < _KNOWN:
        return ()
    return (int(match.counterpart[mode]), *match.rivals[mode])


def _row(operating, match, mode, before, roots, grows, convergence):
    """ComparedMode of one that was unstable."""
    may_be, (mac, rival), error = _may_be(match, mode), match.alike(mode), growth_error(convergence, before)
    clear, after = match.clear(mode), roots[may_be[0]] if may_be else None
    unstable = [k for k in may_be if grows[k]]
    if not unstable and (may_be or not grows.any()):
        state = UNCHANGED if clear and abs(after.real - before.real) <= error else GONE
    elif not clear:
        state = AMBIGUOUS
    else:
        change = after.real - before.real
        state = UNCHANGED if abs(change) <= error else STRONGER if change > 0 else WEAKER
    return ComparedMode(operating, before, after, mac, rival, clear, state, error)


def _new(operating, base, points, unstable, shape, convergence):
    """[ComparedMode] of what is ``unstable`` afterwards (u,) and was not before."""
    if not len(unstable):
        return []
    root, known = modes_about(base, operating, unstable)
    match = counterparts(points.mac(known, shape).T)
    rows = []
    for k in np.argsort(-unstable.real, kind="stable"):
        may_be, (mac, rival), error = _may_be(match, k), match.alike(k), growth_error(convergence, unstable[k])
        clear, before = match.clear(k), root[may_be[0]] if may_be else None
        same = clear and abs(unstable[k].real - before.real) <= error
        rows.append(ComparedMode(operating, before, unstable[k], mac, rival, clear, UNCHANGED if same else NEW, error))
    return rows


def growth_error(convergence, root):
    """By how much (1/s) the finer model of a product Convergence, or the reduction, moves the growth of a ``root``.

    That of the mode of its frequency there; of others the largest share, or the tolerance where all is converged; 0
    without one, of a model that nothing refines.
    """
    if convergence is None:
        return 0.0
    growth, neutral = abs(root.real), float(convergence.neutral)
    near = np.flatnonzero(abs(convergence.root.imag / root.imag - 1) <= _NEAR)
    if len(near):
        mode = near[np.argmin(abs(convergence.root[near] - root))]
        here, *others = (getattr(convergence, name)[mode].real for name in ("root", "refined_root", "reduced_root"))
        lost = abs(here) if convergence.found[mode] == 0 else 0.0
        return float(max(neutral, lost, *(abs(other - here) for other in others)))
    share = convergence.growth_tolerance if convergence.converged else np.minimum(convergence.growth_share, 1.0)
    return float(max(neutral, float(share) * growth))

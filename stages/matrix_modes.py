"""Stage matrix_modes: complex modes of a system of matrices, at its operating points and over speed and friction."""

from functools import partial

import numpy as np
import scipy

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.stability.matrices.family import MatrixFamily, Term
from pipeline.physics.stability.matrices.roots import STRIP, strip_modes, with_left
from pipeline.products import Matrices, MatrixModes, RootsOfMatrices

TWO_PI = 2.0 * np.pi


class Settings(Section):
    """Operating points, the band, and the map."""

    speeds: Quantities("rad/s", gt=0) = option(("1 rad/s",), "speeds of the operating points")
    friction: float = option(1.0, "coefficient of friction at the operating points over that of the matrices", ge=0)
    frequency_max: Quantity("Hz", gt=0) = option("10 kHz", "highest frequency that is searched")
    neutral: float = option(1e-6, "growth below this share of the angular frequency counts as neither growth nor decay",
                            ge=0)
    map_speeds: Quantities("rad/s", gt=0) | None = option(None, "speeds of the map; none = those of the operating"
                                                                " points")
    map_friction: tuple[float, ...] = option((0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5),
                                             "coefficients of friction of the map, over that of the matrices",
                                             min_length=1)


def _check(sections):
    if min(sections["matrix_modes"].map_friction) < 0:
        raise ConfigError("matrix_modes.map_friction", "coefficients of friction from 0 on", "a negative one")


@stage(check=_check)
def matrix_modes(matrices: Matrices, settings: Settings, context: Context) -> MatrixModes:
    """Compute complex modes of a system of matrices, what moves those that grow, and a map of stability.

    Method:
    All roots up to {frequency_max} were computed without reduction, about shifts whose discs cover the imaginary axis,
    at the operating points and over speed and friction; a mode is unstable if its growth rate exceeds {neutral} times
    its angular frequency. Derivatives of roots follow from left and right vectors.
    """
    family = family_of(matrices)
    reference = float(matrices.reference_speed)
    solve = partial(_solved, family, reference, settings, context.solver)
    found = context.map(solve, [(speed, settings.friction) for speed in settings.speeds], "operating points")
    known = {(speed, settings.friction): _leading(settings, one) for speed, one in zip(settings.speeds, found,
                                                                                      strict=True)}
    speeds = sorted(set(settings.map_speeds or settings.speeds))
    points = [(speed, friction) for speed in speeds for friction in sorted(set(settings.map_friction))]
    left = [point for point in points if point not in known]
    known |= dict(zip(left, context.map(partial(_mapped, solve, settings), left, "map"), strict=True))
    shape = len(speeds), -1
    growth, frequency, unstable = (np.reshape(each, shape) for each in zip(*(known[p] for p in points), strict=True))
    return MatrixModes(
        friction=settings.friction, highest=settings.frequency_max, neutral=settings.neutral,
        term=[term.name for term in family.terms],
        roots=_roots(family, reference, found, settings, context), map_speed=speeds,
        map_friction=sorted(set(settings.map_friction)), map_growth=growth, map_frequency=frequency,
        map_unstable=unstable)


def family_of(matrices):
    """MatrixFamily of the product Matrices."""
    size = int(matrices.size)
    return MatrixFamily(tuple(
        Term(name, str(term.kind), scipy.sparse.csr_matrix((term.value, (term.row, term.column)), (size, size)),
             tuple(zip(*(each.tolist() for each in (term.coefficient, term.speed_power, term.friction_power)),
                       strict=True))) for name, term in matrices.terms.items()))


def _solved(family, reference, settings, solver, point):
    """Found at a point (speed rad/s, friction), its vectors only where modes grow."""
    speed, friction = point
    return strip_modes(family.at(speed / reference, friction), settings.frequency_max, solver)


def _growing(settings, roots):
    return np.flatnonzero(roots.real > settings.neutral * abs(roots.imag))


def _leading(settings, found):
    """(largest growth rate, its frequency, number of modes that grow)."""
    roots = found.roots
    if not len(roots):
        return 0.0, 0.0, 0
    first = roots[roots.real.argmax()]
    return first.real, first.imag / TWO_PI, len(_growing(settings, roots))


def _mapped(solve, settings, point):
    return _leading(settings, solve(point))


def _roots(family, reference, found, settings, context):
    """RootsOfMatrices of the operating points."""
    tasks = []
    for speed, one in zip(settings.speeds, found, strict=True):
        tasks += [(speed / reference, one.modes[k]) for k in _growing(settings, one.roots)]
    outcome = context.map(partial(_followed, family, settings.friction, context.solver), tasks, "unstable modes")
    counts = [len(one.modes) for one in found]
    number = {speed / reference: k for k, speed in enumerate(settings.speeds)}
    return RootsOfMatrices(
        speed=settings.speeds, searched=STRIP * settings.frequency_max,
        root_operating=np.repeat(np.arange(len(counts)), counts), root=np.concatenate([one.roots for one in found]),
        unstable_operating=[number[speed] for speed, _ in tasks], unstable_root=[o[0] for o in outcome],
        residual=[o[1] for o in outcome], per_term=np.reshape([o[2] for o in outcome], (-1, len(family.terms))),
        per_speed=[o[3][0] for o in outcome], per_friction=[o[3][1] for o in outcome])


def _followed(family, friction, solver, task):
    """(root, residual, per term, per speed and friction) of an unstable mode."""
    speed, mode = task
    mode = with_left(mode, family.at(speed, friction), solver)
    return mode.root, mode.residual, *family.derivatives(mode, speed, friction)

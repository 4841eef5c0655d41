"""Local searches from several starts, side by side, of brakes that are computed in rounds.

A start follows slopes by L-BFGS-B within the ends of the ranges, then tries every other value of each list, and goes on
from the best while that is lower. All starts advance together: what they ask for in one round are independent brakes.
The search is walked through from its beginning each time, by what is computed so far: the same brakes lead to the same
next ones.
"""

import numpy as np
import scipy

from pipeline.case_models.design_search.course import ALL, SETTLED, SPENT, Asked, Course

FIRST, LINE, DIFFERENCE, OTHER = ROLES = ("start", "line search", "difference", "other value of a list")
#: shares are searched stretched by it, so that a first step goes over a part of one over it
_STRETCH = 4.0
#: trials along one line, and lines
_ALONG, _LINES = 8, 50
#: why a local search ended, by the status of L-BFGS-B
_ENDED = ("no step lowers it by more than the tolerance", f"{_LINES} steps were made",
          "nothing is lower along the slope: a minimum, or a kink where two modes grow alike")


class Wanted(Exception):  # noqa: N818
    """A start cannot go on before these points are computed."""

    def __init__(self, points, role):
        super().__init__(role)
        self.points, self.role = points, role


def first_points(space, starts, seed):
    """Points from which ``starts`` searches begin: the case where the space holds it, the others spread over it."""
    found = [] if space.own is None else [space.own]
    spread = scipy.stats.qmc.Halton(len(space.values), rng=np.random.default_rng(seed))
    for _ in range(100 * starts):
        if len(found) == starts:
            break
        sample = spread.random(1)[0]
        point = tuple(int(share * len(value.choices)) if value.choices else value.at(share)
                      for value, share in zip(space.values, sample, strict=True))
        found += [point] if point not in found else []
    return found[:starts]


def search(space, firsts, evaluate, rules):
    """The Course of a search as far as brakes are computed.

    ``firsts``: where starts begin; ``evaluate(point)``: Evaluation, None where it is not computed yet.
    """
    asked, known, number = {}, {}, 0
    if space.own is not None:
        known[space.own] = evaluate(space.own)
    if not space.ranges and space.combinations() <= rules.budget:
        return _every(space, firsts, evaluate, known)
    while True:
        ended, wanted = [], {}
        for k, first in enumerate(firsts):
            try:
                ended.append(_from(space, first, known, rules))
            except Wanted as more:
                ended.append("")
                for point in more.points:
                    wanted.setdefault(point, Asked(k, more.role, number))
        if _settled(space, known):
            return _course(asked, known, firsts, ended, SETTLED)
        taken = dict(list(wanted.items())[:rules.budget - len(asked)])
        if not taken:
            return _course(asked, known, firsts, ended, SPENT)
        asked |= taken
        computed = {point: evaluate(point) for point in taken}
        if None in computed.values():
            return Course(asked, known, tuple(firsts), tuple(ended), False)
        known, number = known | computed, number + 1


def _settled(space, known):
    """Whether nothing can be lower: no growth is left, and no cost that counts."""
    return (space.worth >= 0).all() and any(each.objective <= 0 for each in known.values())


def _course(asked, known, firsts, ended, otherwise):
    return Course(asked, known, tuple(firsts), tuple(why or otherwise for why in ended), True)


def _every(space, firsts, evaluate, known):
    """The Course of a search that tries every combination of its lists."""
    asked = {point: Asked(0, OTHER, 0) for point in space.every_combination() if point not in known}
    computed = {point: evaluate(point) for point in asked}
    found = {point: value for point, value in computed.items() if value is not None}
    return Course(asked, known | found, tuple(firsts[:1]), (ALL,), len(found) == len(asked))


def _from(space, first, known, rules):
    """Why the search from a point ended; Wanted where it cannot go on."""
    def look(points, role):
        missing = [point for point in points if point not in known]
        if missing:
            raise Wanted(missing, role)
        return [known[point] for point in points]

    look([first], FIRST)
    point = first
    while True:
        point, why = _along_slopes(space, point, look, rules)
        better = _other_values(space, point, look, rules)
        if better is None:
            return why
        point = better


def _along_slopes(space, point, look, rules):
    """(lowest point of a local search from ``point`` over the ranges, why it ended)."""
    if not space.ranges:
        return point, "no other value of a list is lower"
    visited = {}

    def objective(stretched):
        here = space.at(stretched / _STRETCH, point)
        value = look([here], LINE)[0]
        visited[here] = value.objective
        return value.objective / rules.scale, _slopes(space, here, value, look, rules) / (_STRETCH * rules.scale)

    result = scipy.optimize.minimize(
        objective, _STRETCH * space.shares(point), jac=True, method="L-BFGS-B",
        bounds=[(0.0, _STRETCH)] * len(space.ranges),
        options={"ftol": rules.tolerance, "gtol": rules.tolerance, "maxls": _ALONG, "maxiter": _LINES})
    return min(visited, key=visited.get), _ENDED[result.status]


def _slopes(space, point, value, look, rules):
    """(r,) change of the objective by the shares of the ranges at a point."""
    if value.growth <= 0:
        return space.cost_slopes(point)
    shares, beside = space.shares(point), {}
    for place, k in enumerate(space.ranges):
        if k not in value.slopes:
            step = rules.step if shares[place] + rules.step <= 1 else -rules.step
            beside[place] = space.at(shares + step * (np.arange(len(shares)) == place), point)
    others = dict(zip(beside, look(list(beside.values()), DIFFERENCE), strict=True))
    found = [(others[place].growth - value.growth) / (space.shares(beside[place])[place] - shares[place])
             if place in beside else value.slopes[k] for place, k in enumerate(space.ranges)]
    return np.array(found) + space.cost_slopes(point)


def _other_values(space, point, look, rules):
    """The lowest point with another value of one list; None where none is lower by more than the tolerance."""
    others = [(*point[:k], index, *point[k + 1:]) for k in space.lists
              for index in range(len(space.values[k].choices)) if index != point[k]]
    if not others:
        return None
    here, values = look([point], LINE)[0].objective, [each.objective for each in look(others, OTHER)]
    lowest = int(np.argmin(values))
    return others[lowest] if values[lowest] < here - rules.tolerance * rules.scale else None

"""What a search did not look at, by numbers: how much of the box is empty, what was never tried, how starts ended."""

import numpy as np
import scipy

from pipeline.case_models.design_search.course import SETTLED, SPENT

#: points of the box whose nearest brake is sought, and ranges up to which halves are counted
_PROBES, _HALVES = 1024, 20
#: shares within which a value lies at the end of its range, and within which two starts came to the same design
_AT_END, _ALIKE = 1e-3, 0.05


def emptiness(space, points):
    """(largest distance of a point of the ranges from the nearest of ``points``, over the diagonal of the box; parts
    that halving each range makes, and how many of them hold one); 0, 1, 1 without ranges."""
    count = len(space.ranges)
    if not count or not points:
        return 0.0 if points else 1.0, 1, int(bool(points))
    shares = np.array([space.shares(point) for point in points])
    probes = scipy.stats.qmc.Halton(count, rng=np.random.default_rng(0)).random(_PROBES)
    nearest = scipy.spatial.cKDTree(shares).query(probes)[0]
    halves = len({tuple(row) for row in shares[:, :_HALVES] >= 0.5})
    return float(nearest.max() / np.sqrt(count)), 2**min(count, _HALVES), halves


def combinations_tried(space, points):
    """Number of combinations of the lists that hold one of ``points``."""
    return len({tuple(point[k] for k in space.lists) for point in points})


def at_ends(space, point):
    """Names of the ranges at an end of which a point lies."""
    shares = space.shares(point)
    return [space.values[k].name for k, share in zip(space.ranges, shares, strict=True)
            if min(share, 1 - share) <= _AT_END]


def not_searched(space, course, best, budget, outside):
    """Sentences on what a Course leaves open.

    ``best``: the best point, None where it is the case outside the space; ``outside``: settings of the brake that are
    numbers and that the space does not name.
    """
    points = list(course.known)
    far, parts, held = emptiness(space, points)
    said = [f"{outside} settings that are numbers, and every choice that the space does not name, stayed as in"
            " the case: meshes of parts, shapes and joints that the program does not have cannot be searched."]
    if space.ranges:
        said.append(f"{len(points)} brakes are points of a box of {len(space.ranges)} ranges: a point of it lies up to"
                    f" {100 * far:.0f} % of its diagonal from the nearest of them, and {held} of the {parts} parts that"
                    " halving each range makes hold one.")
    if space.lists:
        said.append(f"{combinations_tried(space, points)} of {space.combinations()} combinations of the lists were"
                    " tried.")
    if len(course.asked) >= budget:
        said.append(f"The budget of {budget} brakes was used up: {course.ended.count(SPENT)} of"
                    f" {len(course.ended)} starts had not ended.")
    elif SETTLED in course.ended:
        said.append("The search ended with the first brake without unstable modes: other starts were left where they"
                    " were.")
    said += _elsewhere(space, course, best)
    if best is not None and at_ends(space, best):
        said.append(f"The best design lies at an end of {', '.join(at_ends(space, best))}: a wider range may hold a"
                    " better one.")
    every = not space.ranges and combinations_tried(space, points) == space.combinations()
    said.append("Every design of the space was tried, so that none of it is better." if every else
                "Local searches end in local minima: that no better design exists is not shown.")
    return [*said, "Designs were judged at the operating points of the case, in the reduced model, without its scatter:"
            " the comparison of countermeasures draws the scatter of the best one."]


def _elsewhere(space, course, best):
    """What the starts came to that ended elsewhere than the best."""
    there = [point for point in map(course.lowest, range(len(course.firsts))) if point is not None]
    away = [course.known[p].objective for p in there if best is not None and _distance(space, p, best) > _ALIKE]
    if not away:
        return []
    ends = " to ".join(dict.fromkeys(f"{end:.4g}" for end in (min(away), max(away))))
    return [f"{len(away)} of {len(there)} starts ended in other designs, with objectives of {ends} 1/s."]


def _distance(space, first, second):
    if any(first[k] != second[k] for k in space.lists):
        return 1.0
    return abs(space.shares(first) - space.shares(second)).max(initial=0.0)

"""Spaces made by hand, brakes whose growth rates are closed forms, and a search of them in rounds."""

from dataclasses import replace

import numpy as np

from pipeline.case_models.design_search.course import Evaluation, Rules
from pipeline.case_models.design_search.multistart import first_points, search
from pipeline.case_models.design_search.space import Space, Value

#: two masses of 1 kg, each with a spring and a damper, coupled by friction: N/m, N s/m, N/m
SPRING, DAMPING, COUPLING = 1.0, 0.05, 0.1


def ranged(own, low, high, log=False, name="joints.spring"):
    value = Value(name, "N/m", low, high, log, (), own if low <= own <= high else None, own, 0.0)
    return replace(value, start=value.share(own), spelt=("N/m", 1.0))


def listed(choices, own=0, name="joints.kind"):
    return Value(name, "", 0.0, 0.0, False, tuple(choices), own, choices[own], float(own))


def space(*values, worth=None):
    worth = np.zeros(len(values)) if worth is None else np.array(worth)
    return Space(values, {}, worth)


def flutter_root(spring, damping=DAMPING, coupling=COUPLING):
    """The root with the largest real part of M = 1, C = damping, K = [[1, coupling], [-coupling, spring]]."""
    stiffness = np.array([[SPRING, coupling], [-coupling, spring]])
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -damping * np.eye(2)]])
    roots = np.linalg.eigvals(first_order)
    return roots[np.argmax(roots.real)]


def flutter_boundary(damping=DAMPING, coupling=COUPLING):
    """Spring above 1 N/m at which flutter ends: K has the eigenvalues k +- i f, stable where f^2 <= damping^2 k."""
    apart = np.roots([0.25, 0.5 * damping**2, damping**2 * SPRING - coupling**2])     # f^2 = coupling^2 - apart^2/4
    return SPRING + apart.max()


def in_rounds(space, growth, budget=40, starts=4, seed=0, slopes=None, **rules):
    """(Course, number of points computed in each round) of a search whose brakes are computed as they are asked for."""
    done, rounds, own = {}, [], space.own

    def value(point):
        given = {} if slopes is None else slopes(point)
        return Evaluation(max(growth(point), 0.0), space.cost(point), given)

    def known(point):
        return value(point) if point == own else done.get(point)

    given = Rules(budget, scale=(1.0 if own is None else value(own).growth) or 1.0, **rules)
    firsts = first_points(space, starts, seed)
    while True:
        course = search(space, firsts, known, given)
        new = [point for point in course.asked if point not in done]
        if not new:
            assert course.complete
            return course, rounds
        done.update((point, value(point)) for point in new)
        rounds.append(len(new))


def best(course):
    return min(course.known, key=lambda point: course.known[point].objective)

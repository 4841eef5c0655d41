"""What a brake of a search comes to: its growth rates in the reduced model, and their slopes by vectors.

Modes are those of ``complex_modes`` of one frequency once, at the operating point where they grow most, which are the
modes that ``sensitivities`` differentiates.
"""

import numpy as np

from pipeline.case_models.design_search.course import Evaluation

LARGEST, SUM = "largest", "sum"


def growth_rates(modes):
    """(indices of the unstable modes that count, their growth rates 1/s) of a product ComplexModes."""
    first = np.flatnonzero(modes.unstable_first == np.arange(len(modes.unstable_first)))
    return first, modes.unstable_reduced[first].real


def growth_of(modes, which):
    """Growth (1/s) of the brake of a product ComplexModes: its LARGEST growth rate, or their SUM; 0 without any."""
    rates = growth_rates(modes)[1]
    return float(rates.sum() if which == SUM else rates.max(initial=0.0))


def evaluation(space, point, modes, sensitivities, which):
    """Evaluation of a point of a Space by the products ComplexModes and Sensitivities (or None) of its brake.

    ``which``: LARGEST growth rate, or the SUM of those of all unstable modes.
    """
    members, rates = growth_rates(modes)
    if not len(members):
        return Evaluation(0.0, space.cost(point))
    selected = members if which == SUM else members[[np.argmax(rates)]]
    return Evaluation(growth_of(modes, which), space.cost(point), _slopes(space, point, selected, sensitivities))


def _slopes(space, point, selected, sensitivities):
    """{value: change of the growth by its share} of the values that have derivatives by vectors."""
    rows = [] if sensitivities is None else [k for mode in selected
                                             for k in np.flatnonzero(sensitivities.mode == mode)]
    if len(rows) < len(selected):
        return {}
    columns = {str(name): p for p, (name, method) in
               enumerate(zip(sensitivities.parameter, sensitivities.method, strict=True)) if method == "analytic"}
    found = {}
    for k in space.ranges:
        value = space.values[k]
        column = columns.get(value.name)
        if column is not None and sensitivities.known[rows, column].all():
            slope = sensitivities.derivative[rows, column].real.sum() * _share(sensitivities, rows, column, point[k])
            found[k] = float(slope * value.scale(point[k]))
    return found


def _share(sensitivities, rows, column, number):
    """Change of what is derived by the change of the setting that it belongs to, whose value is ``number``.

    Joints share the stiffness of their setting and are derived by their mean, a fluid column by its own stiffness:
    these are in proportion to the setting. What is 0 is the setting itself.
    """
    value = float(sensitivities.value[rows, column].mean())
    return value / number if value and number else 1.0


def at_operating_points(modes):
    """(largest growth rate (o,) 1/s, 0 where all are stable; unstable modes (o,)) at each operating point."""
    count = len(modes.operating_speed)
    largest, number = np.zeros(count), np.zeros(count, int)
    np.maximum.at(largest, modes.unstable_operating, modes.unstable_reduced.real)
    np.add.at(number, modes.unstable_operating, 1)
    return largest, number

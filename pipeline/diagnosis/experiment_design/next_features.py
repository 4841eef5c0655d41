"""What free vibrations or slow turns to record next: hammer records, growth phases and turns at other loads and speeds.

A record that nobody has made shows what the most similar recorded one did, as well as that: so many poles near its own,
each as the completed model of every hypothesis has it there.
"""

from dataclasses import replace

import numpy as np

from pipeline.diagnosis.experiment_design.next_run import Planned, changed, words
from pipeline.physics.virtual_rig.inputs import input_unit, stated_inputs
from pipeline.physics.virtual_rig.response import at_begin

_LIFTED = "hammer, lifted"
#: factors on the one load or speed that was recorded, where there is only one
_BESIDE = (0.5, 2.0)


def planned_records(bench, seen, given, where="diagnosis.next"):
    """Planned Features (m,) from ``seen`` {run: Features}.

    ``given`` is the section ``next`` {condition or number of the bench: values}: one thing changed in the first record
    of each kind that has it. Without it: all recorded loads at all recorded speeds, and half and twice of where only
    one was recorded. ConfigError for names that the bench does not have, and units that do not fit.
    """
    kinds = {}
    for name, features in seen.items():
        kinds.setdefault(kind(bench, features), {})[name] = features
    if given:
        return tuple(_asked(bench, kind_name, members, name, value, f"{where}.{name}") for name, values in given.items()
                     for value in values for kind_name, members in _of(bench, kinds, name))
    return tuple(record for kind_name, members in kinds.items() for record in _crossed(bench, seen, kind_name, members))


def kind(bench, features):
    """How the Features of a run are recorded, in words."""
    if features.seen is None:
        return "slow turn"
    speed, inputs = at_begin(bench, features.run)
    return "growth phase" if speed else "hammer at rest" if inputs.any() else _LIFTED


def _of(bench, kinds, name):
    """(kind, its members) in which ``name`` can be another: a speed where it slides, a load where something presses."""
    without = {"speed": ("hammer at rest", _LIFTED), **dict.fromkeys(bench.model.input_name, (_LIFTED,))}
    return [(kind_name, members) for kind_name, members in kinds.items() if kind_name not in without.get(name, ())]


def _asked(bench, kind_name, members, name, value, where):
    like, features = next(iter(members.items()))
    run, altered = changed(bench, features.run, name, value, where)
    full_name = f"{kind_name}, {words(name, value)}"
    return Planned(full_name, like, replace(features, run=replace(run, name=full_name)), altered)


def _crossed(bench, seen, kind_name, members):
    """Planned Features of one kind at points (speed, loads) that none of its ``members`` has."""
    if kind_name == _LIFTED:
        return
    every = [_point(bench, features) for features in seen.values()]
    points = {name: _point(bench, features) for name, features in members.items()}
    for speed in _beside({speed for speed, _ in points.values()}):
        for load in _beside({load for _, load in every if any(load)}):
            point = speed, load
            if point not in points.values():
                like = min(points, key=lambda name: _apart(points[name], point))
                yield _at(bench, kind_name, like, members[like], point)


def _point(bench, features):
    """(speed in rad/s, inputs (i,) in N, or m of moved ends) of Features."""
    inputs = [float(np.ravel(value)[0]) for value in stated_inputs(bench, features.run)]
    return at_begin(bench, features.run)[0], tuple(inputs)


def _beside(values):
    """Sorted speeds or loads, and factors of the only one."""
    if len(values) != 1:
        return sorted(values)
    only, = values
    return sorted({only, *(tuple(f * v for v in only) if isinstance(only, tuple) else f * only for f in _BESIDE)})


def _apart(first, second):
    """Distance of two points, in powers of e."""
    sizes = [(abs(speed), np.linalg.norm(load)) for speed, load in (first, second)]
    return sum(abs(np.log(a / b)) for a, b in zip(*sizes, strict=True) if a and b)


def _at(bench, kind_name, like, features, point):
    """Planned like the ``features`` of a run ``like`` at another point."""
    speed, load = point
    inputs = dict(zip(bench.model.input_name, load, strict=True))
    conditions = [f"{n} = {v:g} {input_unit(bench, n)}" for n, v in inputs.items()]
    conditions += [f"speed = {speed:g} rad/s"] if speed else []
    name = f"{kind_name}, {', '.join(conditions)}"
    run = replace(features.run, name=name, inputs=inputs, drive=None,
                  conditions={**features.run.conditions, "speed": speed})
    return Planned(name, like, replace(features, run=run), {})

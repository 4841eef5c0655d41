"""Nominal numbers of a bench by name, to read and to change: what a calibration fits and a completed case states.

    joints.NAME.stiffness  N/m          inputs.NAME.gain    1       channels.NAME.gain    1
    joints.NAME.damping    N s/m        inputs.NAME.offset  N       channels.NAME.delay   s
    loads.JOINT            N            channels.NAME.offset, and .drift per s, in the unit of the channel
    bodies.NAME.mass       1 (factor)   friction            1 (factor)
    bodies.NAME.stiffness  1 (factor)   contact.stiffness   1 (factor)     contact.damping  N s/m
    bodies.NAME.frequency  1 (factor)   friction.stiffness  1 (factor)     bodies.NAME.damping  1 (factor)
    bodies.NAME.modal_mass 1 (factor)

Factors are of the given model; ``frequency`` is that of all modes of a body held by the joints that touch nothing else,
at the same mass, and ``damping`` of body and those joints; ``modal_mass`` is of mass, damping and stiffness of body and
those joints, which keep their frequencies; ``friction.stiffness`` is that of a contact before it slides. ``loads`` are
constant forces, as of a weight or a cable, that pull the ends of a joint apart.
Bodies of one coordinate also have masses.NAME in kg. What acts about an axis has N m/rad, N m s/rad, N m and kg m^2.
Effects that the case states have EFFECT@LOCATION.PARAMETER, as in coulomb@guide.force.
"""

from dataclasses import replace
from difflib import get_close_matches
from itertools import groupby
from operator import itemgetter

import numpy as np

from pipeline.case_models.effect_block import MARK, restated
from pipeline.contract import ConfigError
from pipeline.contract.units import TURNED, to_si
from pipeline.effects.typical import JOINT, locations
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.time_stepping.elements import Element, Wave
from pipeline.physics.time_stepping.simulate import Penalty


def known(bench):
    """{name: SI unit} of every number of the bench that can be changed."""
    model = bench.model
    units = {"friction": "1"} if len(model.contacts.area) else {}
    if isinstance(bench.law, Penalty) and len(model.contacts.area):
        units |= {"contact.stiffness": "1", "contact.damping": "N s/m"}
    if getattr(bench.friction, "description", "rigid") != "rigid":
        units["friction.stiffness"] = "1"
    for name in model.joints.name:
        units |= {f"joints.{name}.stiffness": "N/m", f"joints.{name}.damping": "N s/m"}
    units |= {f"loads.{name}": "N" for name in locations(JOINT, bench)}
    for index, name in enumerate(model.body_name):
        units |= {f"bodies.{name}.{what}": "1" for what in ("mass", "stiffness", "frequency", "damping",
                                                          "modal_mass")}
        if np.sum(model.coordinate_body == index) == 1:
            units[f"masses.{name}"] = "kg"
    for name in model.input_name:
        units |= {f"inputs.{name}.gain": "1", f"inputs.{name}.offset": "N"}
    for channel in bench.channels:
        unit = channel.measurand.unit
        units |= {f"channels.{channel.name}.gain": "1", f"channels.{channel.name}.delay": "s",
                  f"channels.{channel.name}.offset": unit, f"channels.{channel.name}.drift": f"{unit}/s"}
    turned = {name for name in units if _turns(name) in model.turning}
    stated = {} if bench.stated is None else {name: unit for name, (_, unit) in bench.stated.numbers().items()}
    return {name: TURNED.get(unit, unit) if name in turned else unit for name, unit in units.items()} | stated


def read(bench, given, where):
    """{name: SI value} of ``given`` {name: quantity as written}.

    ConfigError for unknown names and units, and for masses and factors of bodies that are not above 0.
    """
    units = known(bench)
    values = {name: to_si(value, _known(name, units, where), f"{where}.{name}") for name, value in given.items()}
    for name, value in values.items():
        if _steps(name)[0] in ("masses", "bodies") and not value > 0:
            raise ConfigError(f"{where}.{name}", "a value above 0", f"{value:g}")
    return values


def nominal(bench, name, where="parameters"):
    """The value that the bench has now; 1 of a factor."""
    unit = _known(name, known(bench), where)
    if MARK in name:
        return float(bench.stated.numbers()[name][0])
    kind, name_of, what = _steps(name)
    if kind == "joints":
        row = bench.model.joints.name.index(name_of)
        return float(getattr(bench.model.joints, what)[row])
    if kind == "masses":
        return _own_mass(bench.model, name_of)
    if kind == "channels":
        return float(getattr(next(c for c in bench.channels if c.name == name_of), what))
    if name == "contact.damping":
        return float(np.mean(bench.law.damping))
    return 1.0 if unit == "1" else 0.0


def is_factor(name):
    """Whether a number counts as a factor on what the model has, so that 1 leaves it as it is."""
    if MARK in name:
        return False
    kind, _, what = _steps(name)
    return kind in ("bodies", "friction") or name == "contact.stiffness" or (kind == "inputs" and what == "gain")


def corrected(bench, values):
    """The bench with ``values`` {name: SI value} in place of its own."""
    stated = {name: value for name, value in values.items() if MARK in name}
    if stated:
        bench, values = restated(bench, stated), {n: v for n, v in values.items() if n not in stated}
    changes = [(*_steps(name), value) for name, value in values.items()]
    for kind, alike in groupby(changes, key=itemgetter(0)):
        if kind == "joints":
            bench = _joints(bench, alike)
            continue
        for _, owner, what, value in alike:
            bench = _CHANGES[kind](bench, owner, what, value)
    return bench


def _turns(name):
    """What must act about an axis for a number of this name to do so, as ``turning`` of a SlidingModel has it."""
    kind, owner, _ = _steps(name)
    return f"joints.{owner}" if kind == "loads" else f"{kind}.{owner}"


def _steps(name):
    """(kind, owner, what) of a name; owners may hold dots."""
    kind, _, rest = name.partition(".")
    if kind in ("friction", "masses", "contact", "loads"):
        return kind, rest, rest
    owner, _, what = rest.rpartition(".")
    return kind, owner, what


def _known(name, units, where):
    if name in units:
        return units[name]
    near = get_close_matches(str(name), units, 1)
    raise ConfigError(f"{where}.{name}", "a number of the bench, such as " + ", ".join(list(units)[:4]), "none of them",
                      f"did you mean '{near[0]}'?" if near else None)


def _joints(bench, changes):
    joints = bench.model.joints
    numbers = {what: np.array(getattr(joints, what), float) for what in ("stiffness", "damping")}
    for _, owner, what, value in changes:
        numbers[what][joints.name.index(owner)] = value
    return _with_model(bench, joints=replace(joints, **numbers))


def _mass(bench, owner, what, value):
    return _body(bench, owner, "mass", value / _own_mass(bench.model, owner))


def _own_mass(model, owner):
    index = np.flatnonzero(model.coordinate_body == model.body_name.index(owner))
    return float(model.mass[index, index][0])


def _body(bench, owner, what, factor):
    """Rows and columns of one body times the factor: its own block exactly."""
    own_coordinates = bench.model.coordinate_body == bench.model.body_name.index(owner)
    if what == "frequency":
        return _held_body(bench, own_coordinates, {"stiffness": factor**2})
    if what == "damping":
        return _held_body(bench, own_coordinates, {"damping": factor})
    if what == "modal_mass":
        return _held_body(bench, own_coordinates, dict.fromkeys(("mass", "damping", "stiffness"), factor))
    root = np.where(own_coordinates, np.sqrt(factor), 1.0)
    return _with_model(bench, **{what: getattr(bench.model, what) * np.outer(root, root)})


def _held_body(bench, own_coordinates, factors):
    """One body and the joints that touch nothing else: what ``factors`` {mass, damping or stiffness: factor} tell."""
    model, joints = bench.model, bench.model.joints
    alone = joints.rows[:, own_coordinates].any(axis=1) & ~joints.rows[:, ~own_coordinates].any(axis=1)
    held = {what: getattr(joints, what) * np.where(alone, factor, 1.0) for what, factor in factors.items()
            if what != "mass"}
    root = {what: np.where(own_coordinates, np.sqrt(factor), 1.0) for what, factor in factors.items()}
    matrices = {what: getattr(model, what) * np.outer(each, each) for what, each in root.items()}
    return _with_model(bench, joints=replace(joints, **held), **matrices)


def _input(bench, owner, what, value):
    model = bench.model
    row = model.input_name.index(owner)
    if what == "offset":
        return _pushed(bench, f"offset {owner}", model.input_rows[row], value)
    rows = np.array(model.input_rows)
    rows[row] *= value
    return _with_model(bench, input_rows=rows)


def _load(bench, owner, what, value):
    return _pushed(bench, f"load {owner}", bench.joint(owner)[0], value)


def _pushed(bench, name, row, value):
    """The bench with a constant force ``value`` N along ``row`` (n,)."""
    return bench.with_elements(Element(name, row, Wave(1.0, amplitude=value))) if value else bench


def _channel(bench, owner, what, value):
    return bench.with_channels(lambda c: replace(c, **{what: value}) if c.name == owner else c)


def _friction(bench, owner, what, factor):
    if what == "stiffness":
        stiffer = factor * np.asarray(bench.friction.stiffness)
        return replace(bench, friction=replace(bench.friction, stiffness=stiffer))
    law = bench.friction.law
    table = FrictionLaw(law.pressure, law.speed, law.distance, factor * np.asarray(law.friction))
    return replace(bench, friction=replace(bench.friction, law=table))


def _contact(bench, owner, what, value):
    own_value = value * np.asarray(bench.law.stiffness) if what == "stiffness" else value
    return replace(bench, law=replace(bench.law, **{what: own_value}))


def _with_model(bench, **change):
    return replace(bench, model=replace(bench.model, **change))


_CHANGES = {"masses": _mass, "bodies": _body, "inputs": _input, "loads": _load, "channels": _channel,
            "friction": _friction, "contact": _contact}

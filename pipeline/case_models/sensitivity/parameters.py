"""Declared values of a brake that enter its reduced matrices: name, value, and the Case with the value changed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import partial

import numpy as np

from pipeline.case_models.sensitivity.bodies import body_parameters
from pipeline.physics.sliding.model import at_pressure

#: joints of a brake by name -> their setting, the first that fits; PISTON is the spring of the piston on its backplate
PISTON = "piston_normal_*"
JOINTS = (
    ("abutment_*_trailing_tangential", "abutment_stiffness"), ("abutment_*_leading_tangential", "clip_stiffness"),
    ("abutment_*_radial", "abutment_radial_stiffness"), ("finger_normal_*", "finger_stiffness"),
    ("finger_*", "finger_shear_stiffness"), (PISTON, "shim_stiffness"), ("piston_*", "piston_shear_stiffness"),
    ("guide_pin_*_axial_*", "guide_pin_axial_stiffness"), ("guide_pin_*", "guide_pin_stiffness"),
    ("seal_axial_*", "piston_stiffness"), ("seal_*", "seal_stiffness"), ("mount_*", "mount_stiffness"),
    ("bolt_*", "bolt_stiffness"),
    ("fluid_column*", "bulk_modulus"))
LOSSES = ("abutment", "finger", "piston", "guide_pin", "bolt", "seal", "mount")
#: what a derivative is per where the value is 0
TYPICAL_LOSS, TYPICAL_TIME, TYPICAL_SLOPE = 0.01, 1e-6, 0.01


@dataclass(frozen=True)
class Parameter:
    """A value, in SI ``unit``; derivatives are per change by ``reference``, the value itself unless that is 0.

    ``source``: what scatters with it, as the product Probability calls it, '' for nothing; ``changed(case, step)``: the
    Case with the value larger by ``step`` references.
    """

    name: str
    value: float
    unit: str
    reference: float
    source: str
    changed: Callable


def parameters(case, structure, friction, points):
    """Parameters of a Case; ``structure``: its product Structure, or None; ``friction``: its mean coefficient."""
    model = case.model
    pressure = float(model.pressure[case.state])
    found = [
        Parameter("friction", friction, "1", friction or TYPICAL_SLOPE, "friction",
                  partial(_added, "friction", friction or TYPICAL_SLOPE)),
        *(Parameter(name, 0.0, "1", TYPICAL_SLOPE, name, partial(_added, field, TYPICAL_SLOPE)) for name, field in
          (("friction_over_pressure", "pressure_slope"), ("friction_over_speed", "speed_slope"))),
        Parameter("contact_stiffness", 1.0, "1", 1.0, "contact_stiffness", partial(_scaled, "contact_stiffness")),
        Parameter("complex_modes.damping_speed", points.damping_speed, "m/s", points.damping_speed, "damping_speed",
                  partial(_scaled, "damping_speed")),
        *((Parameter("structure.pressures", pressure, "Pa", pressure, "", _loaded),)
          if len(model.law_closure) else ()),
        Parameter("complex_modes.speeds", case.speed, "rad/s", case.speed, "", _faster)]
    found += _springs(model) + _joint_losses(model)
    bodies = [] if structure is None else body_parameters(model, structure)
    return found + [Parameter(*each) for each in bodies]


def _added(field, reference, case, step):
    return replace(case, factors=replace(case.factors, **{field: getattr(case.factors, field) + step * reference}))


def _scaled(field, case, step):
    return replace(case, factors=replace(case.factors, **{field: getattr(case.factors, field) * (1 + step)}))


def _loaded(case, step):
    """Under more load; linings that pressure stiffens are stiffer, too."""
    loaded, model = replace(case, load=case.load * (1 + step)), case.model
    if not model.lining_exponent:
        return loaded
    stiffer = at_pressure(model, (1 + step) * model.lining_pressure)
    return replace(loaded, model=replace(stiffer, lining_pressure=model.lining_pressure))


def _faster(case, step):
    return replace(case, speed=case.speed * (1 + step))


def _setting(model, name):
    """Dotted setting of a joint; of other systems its own name."""
    setting = next((s for pattern, s in JOINTS if fnmatchcase(name, pattern)), None)
    if setting is None:
        return f"joints.{name}.stiffness"
    if setting == "bulk_modulus":
        return "structure.piston.fluid.bulk_modulus"
    if setting == "shim_stiffness" and "piston" not in list(map(str, model.body_name)):
        setting = "piston_stiffness"
    return f"structure.joints.{setting}"


def _springs(model):
    """One Parameter of each setting that is the stiffness of joints, viscous damping following it; its value is the
    mean of its joints."""
    names = [_setting(model, str(name)) for name in model.joint_name]
    found = []
    for name in dict.fromkeys(names):
        members = np.array([n == name for n in names])
        value = float(model.joint_stiffness[members].mean())
        first = str(model.joint_name[np.flatnonzero(members)[0]])
        group = next((kind for kind in LOSSES if first.startswith(kind)), "")
        found.append(Parameter(name, value, "N/m", value, f"joint_stiffness:{group}", partial(_stiffer, members)))
    return found


def _stiffer(members, case, step):
    model, scale = case.model, np.where(members, 1 + step, 1.0)
    return replace(case, model=replace(model, joint_stiffness=scale * model.joint_stiffness,
                                       joint_damping=scale * model.joint_damping))


def _joint_losses(model):
    """Parameters of the loss factors of joints by kind, and of the loss time of all."""
    found, names = [], [str(n) for n in model.joint_name]
    for kind in (*LOSSES, "fluid_column"):
        members = np.array([name.startswith(kind) for name in names], bool)
        if members.any():
            value = float(model.joint_loss_factor[members][0])
            name = "structure.piston.fluid.loss_factor" if kind == "fluid_column" else \
                f"structure.joints.{kind}_loss_factor"
            reference = value or TYPICAL_LOSS
            found.append(Parameter(name, value, "1", reference, f"joint_loss:{kind}",
                                   partial(_lossier, reference * members)))
    sprung = np.array([not name.startswith("fluid_column") for name in names], bool)
    if sprung.any():
        time = float(np.max(model.joint_damping[sprung] / model.joint_stiffness[sprung]))
        reference = time or TYPICAL_TIME
        found.append(Parameter("structure.joints.loss_time", time, "s", reference, "joint_loss",
                               partial(_slower, reference * sprung)))
    return found


def _lossier(added, case, step):
    model = case.model
    return replace(case, model=replace(model, joint_loss_factor=model.joint_loss_factor + step * added))


def _slower(added, case, step):
    model = case.model
    return replace(case, model=replace(model, joint_damping=model.joint_damping
                                       + step * added * model.joint_stiffness))

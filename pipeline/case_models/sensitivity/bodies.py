"""Moduli, densities, loss factors and damping ratios of the bodies of a brake, in its reduced matrices.

A body scales with its modulus and density, where it has several materials with those of all. A pad is lining and
backplate: the moduli of the lining change by one factor, its densities together; behind a lining with a shim nothing is
changed. Shapes that the bodies are reduced to stay.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.physics.reduction.craig_bampton import modal_damping
from pipeline.physics.sliding.model import lining_part

TYPICAL_LOSS = 0.01
PAD, LINING, SHIM = "pad", "lining", "shim rubber"


def body_parameters(model, structure):
    """(name, value, unit, reference, source, changed) of each value of the bodies, as of a Parameter."""
    found, names = [], list(map(str, model.body_name))
    ratios = {name: float(structure.body(name).damping_ratio) for name in names if name in structure.body_name}
    parts = {name: np.flatnonzero([n.partition("_")[0] == name and n in ratios for n in names])
             for name in dict.fromkeys(n.partition("_")[0] for n in ratios)}
    damp = partial(_damped, [ratios.get(name, 0.0) for name in names])
    for part, members in parts.items():
        coordinates = np.isin(model.coordinate_body, members)
        body = structure.body(names[members[0]])
        whole = np.outer(coordinates, coordinates) * model.stiffness
        found += _materials(f"structure.{part}", model, body, coordinates, whole, damp)
        ratio = ratios[names[members[0]]]
        found.append((f"structure.{part}.damping_ratio", ratio, "1", ratio or TYPICAL_LOSS, "",
                      partial(_more_damped, damp, members, ratio or TYPICAL_LOSS)))
    return found


def _materials(name, model, body, coordinates, whole, damp):
    """Of the moduli, densities and loss factors of one part."""
    group = f"body_loss:{name.rpartition('.')[2]}"
    found = [(f"{name}.{'density' if len(body.density) == 1 else 'densities'}", float(body.density.mean()), "kg/m^3",
              float(body.density.mean()), "", partial(_denser, damp, coordinates))]
    if len(body.density) == 1 or LINING not in body.material_name:
        moduli = [(f"{name}.young", whole, body, 0, "")]
        losses = [f"{name}.loss_factor"]
    else:
        lining = lining_part(model)
        names = list(map(str, body.material_name))
        first, behind = names.index(LINING), next((k for k, name in enumerate(names) if name != LINING), 0)
        moduli = [(f"{name}.lining_young", lining, body, first, "lining_stiffness"),
                  (f"{name}.backplate_young", whole - lining, body, behind, "")]
        losses = [f"{name}.lining_loss_factor", f"{name}.backplate_loss_factor"]
        if SHIM in body.material_name:       # what is behind the lining is not one material, and stays in one part
            del moduli[1:], losses[1:]
    for (modulus, stiffness, each, material, source), loss in zip(moduli, losses, strict=True):
        value, factor = _young(each.elasticity[material]), float(each.loss_factor[material])
        found.append((modulus, value, "Pa", value, source, partial(_stiffer, damp, stiffness, factor)))
        reference = factor or TYPICAL_LOSS
        found.append((loss, factor, "1", reference, group, partial(_lossier, reference * stiffness)))
    return found


def _young(elasticity):
    """Young's modulus of the first direction of an elastic matrix (6, 6)."""
    return float(1 / np.linalg.inv(elasticity)[0, 0])


def _damped(ratios, model, mass, stiffness, changed=None):
    """Viscous damping (n, n) of the bodies whose ``ratios`` (b,) are not 0, of other matrices."""
    damping = model.damping.copy()
    for body, ratio in enumerate(ratios if changed is None else changed):
        if ratio or ratios[body]:
            block = np.ix_(*(np.flatnonzero(model.coordinate_body == body),) * 2)
            damping[block] = modal_damping(mass[block], stiffness[block], ratio)
    return damping


def _denser(damp, coordinates, case, step):
    model, scale = case.model, 1 + step * np.outer(coordinates, coordinates)
    mass = scale * model.mass
    return replace(case, model=replace(model, mass=mass, gyroscopic=scale * model.gyroscopic,
                                       centrifugal=scale * model.centrifugal,
                                       damping=damp(model, mass, model.stiffness)))


def _stiffer(damp, part, loss_factor, case, step):
    model = case.model
    stiffness = model.stiffness + step * part
    return replace(case, model=replace(model, stiffness=stiffness, loss=model.loss + step * loss_factor * part,
                                       damping=damp(model, model.mass, stiffness)))


def _lossier(added, case, step):
    return replace(case, model=replace(case.model, loss=case.model.loss + step * added))


def _more_damped(damp, members, reference, case, step):
    ratios = np.array(damp.args[0], float)
    ratios[members] += step * reference
    model = case.model
    return replace(case, model=replace(model, damping=damp(model, model.mass, model.stiffness, changed=ratios)))

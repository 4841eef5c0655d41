"""The completed case where a disc that is flexible in the loop explains the heard lines: the same brake, two-way.

Its values are those of the most probable draw of the best hypothesis with a flexible disc, each with its origin. What a
case cannot state (the scatter of a friction map, the slope of a contact law from rough surfaces) is listed in its
description.
"""

import copy

import numpy as np

from pipeline.case_models.operating_points import DECAY_SPEED
from pipeline.contract import documents as yaml
from pipeline.contract.units import to_si
from pipeline.diagnosis.published.line_hypotheses import FALLING, FLEXIBLE, LOADING

#: chain of the completed case by the section that describes the brake
_CHAINS = {"lumped": "lumped_modes", "structure": "brake_squeal"}
#: sections that ask what was heard
_ASKED = ("recording", "noise_events", "line_evidence", "diagnosis")
#: part of the name of a joint -> its values in structure.joints
_JOINTS = {"abutment": ("abutment_stiffness", "clip_stiffness", "abutment_radial_stiffness"),
           "finger": ("finger_stiffness", "finger_shear_stiffness"),
           "piston": ("piston_stiffness", "piston_shear_stiffness", "shim_stiffness"),
           "guide_pin": ("guide_pin_stiffness", "guide_pin_axial_stiffness"), "mount": ("mount_stiffness",),
           "bolt": ("bolt_stiffness",)}
_LINING = ("lining_young_radial", "lining_young_tangential", "lining_young_normal", "lining_shear_normal",
           "lining_shear_in_plane")


def companions(product, case):
    """{file name: text} of the completed case; none where the lines do not name a flexible disc."""
    if case is None or str(product.verdict) != FLEXIBLE:
        return {}
    return {f"{case.name}_two_way.yaml": yaml.yaml_text(completed(product, case))}


def chosen(disc, evidence, weight):
    """(row, draw) of LineEvidence: the flexible hypothesis of the largest evidence, and the draw that carries most of
    it."""
    row = int(np.argmax(np.where(disc == FLEXIBLE, evidence, -np.inf)))
    return row, int(np.argmax(weight[row]))


def completed(product, case):
    """The document of the completed case of a product LineEvidence."""
    row, draw = chosen(product.disc, product.evidence, product.weight)
    name = str(product.hypothesis[row])
    values = {str(c): float(v) for c, v in zip(product.column, product.value[row, draw], strict=True)}
    document = {key: copy.deepcopy(part) for key, part in case.document.items() if key not in _ASKED}
    kind = next(kind for kind in _CHAINS if kind in document)
    hypothesis = case.document["line_evidence"].get("hypotheses", {}).get(name, {})
    writer = _Writer(document, f"line evidence of {case.name}: most probable draw of {name}")
    if hypothesis.get("joint_factors"):
        writer.left.append(f"joint_factors of {name}")
    for column, value in values.items():
        of, _, part = column.partition(":")
        if value and column not in (FALLING, LOADING, "friction", "friction_over_speed"):
            writer.apply(kind, of, part, value)
    writer.friction(kind, values, float(np.mean(product.speed)))
    document["chain"] = _CHAINS[kind]
    document["title"] = f"{document.get('title', case.name)}, disc flexible in the loop"
    document["description"] = (f"Completed from the lines that the bench heard ({case.name}, hypothesis {name}). "
                               + (f"Not expressed in this case: {'; '.join(writer.left)}." if writer.left else ""))
    return document


class _Writer:
    """Writes values into a ``document``, each with its ``source``; lists what is ``left`` out."""

    def __init__(self, document, source):
        self.document, self.source, self.left = document, source, []

    def apply(self, kind, of, part, factor):
        """One factor on the values that a source of scatter means."""
        places = getattr(self, f"_of_{kind}")(of, part)
        if not places:
            self.left.append(f"{of}{f' of {part}' if part else ''} {factor:.3g}")
        for section, key, unit in places:
            self.scale(section, key, unit, factor)

    def scale(self, section, key, unit, factor):
        """Multiply the value of a ``key`` of a ``section`` where it is stated."""
        if key not in section:
            return
        value = _plain(section[key])
        section[key] = self._stated(to_si(value, unit, key) * factor, unit)

    def friction(self, kind, values, speed):
        """Friction at the mean ``speed`` rad/s of the tests, its level and its slope dmu / dln(speed): as friction of
        complex_modes that falls or rises over the sliding speed there."""
        slope = values.get("friction_over_speed", 0.0) - values.get(FALLING, 0.0)
        level = values.get("friction", 0.0)
        if kind != "lumped":
            self.left += [f"friction higher by {level:.3g}, dmu/dln(speed) by {slope:.3g}"] * bool(level or slope)
            return
        modes = self.document["complex_modes"]
        levers = [to_si(_plain(c["lever"]), "m", "lever") for c in self.document["lumped"]["contacts"].values()
                  if "lever" in c]
        sliding = abs(speed) * float(np.mean(levers or [1.0]))
        last, rest = (float(_plain(modes.get(key) or modes["friction"])) for key in ("friction", "friction_at_rest"))
        decay = to_si(_plain(modes.get("decay_speed", DECAY_SPEED)), "m/s", "complex_modes.decay_speed")
        more = (rest - last) * np.exp(-sliding / decay)
        coefficient = last + more + level + slope * np.log(sliding)
        slope = slope - more * sliding / decay
        modes.update(friction=self._stated(coefficient + slope, "1"),
                     friction_at_rest=self._stated(coefficient + (1 - np.e) * slope, "1"),
                     decay_speed=self._stated(sliding, "m/s"))

    def _of_lumped(self, of, part):
        springs, lumped = self.document["lumped"]["springs"], self.document["lumped"]
        members = [spring for name, spring in springs.items() if part in name]
        if of == "joint_stiffness":
            return [(spring, key, unit) for spring in members
                    for key, unit in (("stiffness", "N/m"), ("damping", "N s/m"))]
        if of == "joint_loss":
            return [(spring, "damping", "N s/m") for spring in members]
        if of == "contact_stiffness":
            return [(contact, "stiffness", "N/m") for contact in lumped["contacts"].values()]
        return self._damping_speed(of)

    def _of_structure(self, of, part):
        structure = self.document["structure"]
        joints = structure.setdefault("joints", {})
        groups = [group for group in _JOINTS if group in part or not part]
        if of == "joint_stiffness":
            return [(joints, key, "N/m") for group in groups for key in _JOINTS[group]]
        if of == "joint_loss":
            return [(joints, f"{group}_loss_factor", "1") for group in groups]
        if of == "body_loss":
            return [(body, key, "1") for name, body in structure.items() if isinstance(body, dict) and part in name
                    for key in body if key.endswith("loss_factor") and name != "joints"]
        if of == "lining_stiffness":
            return [(structure["pad"], key, "Pa") for key in _LINING]
        return self._damping_speed(of)

    def _damping_speed(self, of):
        modes = self.document.setdefault("complex_modes", {})
        return [(modes, "damping_speed", "m/s")] if of == "damping_speed" else []

    def _stated(self, value, unit):
        return {"value": float(value) if unit == "1" else f"{float(value)!r} {unit}", "origin": "inferred",
                "source": self.source}


def _plain(value):
    return value["value"] if isinstance(value, dict) and "value" in value else value

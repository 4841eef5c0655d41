"""Values of a brake that nobody has stated or measured, and that decide its verdict: measure these first."""

from fnmatch import fnmatchcase

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.chapters.models.sensitivities import in_words
from pipeline.views.figures.number_format import percent, plural, quantity
from pipeline.views.pages.case_settings import written

DEFAULT, ASSUMED = "default", "assumed"
#: settings that decide on flutter, those first that commonly matter most, and the source of scatter that they belong to
DECIDING = (
    ("micro_friction.third_body_factor", "friction"), ("micro_friction.disc_strength", "friction"),
    ("complex_modes.damping_speed", "damping_speed"),
    ("structure.joints.abutment_*stiffness", "joint_stiffness:abutment"),
    ("structure.joints.clip_stiffness", "joint_stiffness:abutment"),
    ("structure.joints.finger_*stiffness", "joint_stiffness:finger"),
    ("structure.joints.shim_stiffness", "joint_stiffness:piston"),
    ("structure.joints.piston_*stiffness", "joint_stiffness:piston"),
    ("structure.joints.guide_pin_*stiffness", "joint_stiffness:guide_pin"),
    ("structure.joints.seal_stiffness", "joint_stiffness:seal"),
    ("structure.joints.mount_stiffness", "joint_stiffness:mount"),
    ("structure.joints.bolt_stiffness", "joint_stiffness:bolt"),
    ("structure.pad.lining_young_*", "lining_stiffness"), ("structure.pad.lining_shear_*", "lining_stiffness"),
    ("surface.*.rms_height", "contact_stiffness"), ("micro_friction.pad.youngs_modulus", "contact_stiffness"),
    ("structure.joints.*_loss_factor", "joint_loss"), ("structure.joints.loss_time", "joint_loss"),
    ("structure.*loss_factor", "body_loss"), ("structure.*.damping_ratio", "body_loss"),
    ("structure.disc.*radius", ""), ("structure.disc.*thickness", ""), ("structure.pad.*thickness", ""),
    ("structure.pad.*radius", ""), ("structure.pad.angle", ""), ("structure.*.young", ""),
    ("structure.*.backplate_young", ""), ("structure.*density", ""))
#: values of which another is what the sensitivities know
STANDS_FOR = (("structure.pad.lining_young_*", "structure.pad.lining_young"),
              ("structure.pad.lining_shear_*", "structure.pad.lining_young"),
              ("structure.pad.*density", "structure.pad.densities"))
#: values that act where another kind of joint is: a piston body, which bears on a shim, has a seal
_ALONE = {"structure.joints.shim_stiffness": "seal"}
#: rows that are shown open
_FIRST = 10
#: as of ``_influence``, of a value of which nothing is known
UNKNOWN = (1, 0.0), "—"


def to_measure(case, products):
    """Tables of the values that decide the verdict of a brake and are defaults of the program, or assumed.

    Ordered by what is known of their influence: what one standard deviation of them changes in the growth rate of the
    mode that grows most (sensitivities), or the share of the variance of the growth rate of the source that they belong
    to (probability); then what commonly matters. Empty for systems without such values.
    """
    rows = _rows(case, products)
    if not rows:
        return ()
    known = _influence(products, rows)
    order = sorted(range(len(rows)), key=lambda k: (rows[k][3] != DEFAULT, *known[rows[k][0]][0], rows[k][5]))
    cells = [(rows[k][0], rows[k][2], rows[k][3], known[rows[k][0]][1]) for k in order]
    meanings = [rows[k][4] for k in order]
    left = len(cells) - _FIRST
    tables = ((cells[:_FIRST], meanings[:_FIRST], "Values that decide and that are not yours, first those that matter"
               " most", False), (cells[_FIRST:], meanings[_FIRST:], f"{plural(left, 'further value')}", True))
    return tuple(Table(("setting", "value", "origin", "what it decides"), tuple(part), title, (1,), (3,), folded,
                       tuple(under)) for part, under, title, folded in tables if part)


def statement(case, products):
    """How many values that decide are defaults or assumed, in one sentence; '' where there are none."""
    rows = _rows(case, products)
    defaults = sum(row[3] == DEFAULT for row in rows)
    if not rows:
        return ""
    counted = ((defaults, "defaults of the program", "a default of the program"),
               (len(rows) - defaults, "assumed", "assumed"))
    told = [f"{number} {'is ' + one if number == 1 else 'are ' + several}" for number, several, one in counted
            if number]
    return (f"Of the values that decide this verdict, {' and '.join(told)}: the answer is of a typical brake as far as"
            " they go.")


def _rows(case, products):
    """(name, source of scatter, value, origin, meaning, rank) of the deciding values that are default or assumed."""
    rows, brake = [], products.get("structure")
    given = {f"structure.{name}" for name in getattr(brake, "mesh_given", ())}
    for stage, settings in case.settings.items():
        for key, value in settings.items():
            name = f"{stage}.{key}"
            rank = next((k for k, (pattern, _) in enumerate(DECIDING) if fnmatchcase(name, pattern)), None)
            origin = case.origins.get(stage, {}).get(key, {}).get("origin", DEFAULT)
            idle = case.idle.get(stage, {}).get(key)
            if rank is None or value is None or name in given or idle or _lacks(brake, name, rank):
                continue
            if origin in (DEFAULT, ASSUMED):
                rows.append((name, DECIDING[rank][1], written(value, case.units.get(stage, {}).get(key, "")), origin,
                             case.meanings.get(stage, {}).get(key, ""), rank))
    return rows if "structure" in case.settings else []


def _lacks(brake, name, rank):
    """Whether the setting ``name`` of ``rank`` in DECIDING is of joints that a product Structure, or None, has none
    of: fingers of a floating caliper, bolts of a fixed one."""
    kind = _ALONE.get(name, DECIDING[rank][1].partition("joint_stiffness:")[2])
    if name.startswith("structure.joints.") and name.endswith("_loss_factor"):
        kind = name.removeprefix("structure.joints.").removesuffix("_loss_factor")
    return bool(kind) and brake is not None and not any(str(each).startswith(kind) for each in brake.joint_name)


def _influence(products, rows):
    """{name: ((class, -size), words)}: what is known of the influence of each value, the best known first."""
    derived, probable = products.get("sensitivities"), products.get("probability")
    if derived is not None and len(derived.mode):
        return {name: _derived(derived, name, source) for name, source, *_ in rows}
    shares = {} if probable is None or not len(probable.value) else dict(
        zip(map(str, probable.source), map(float, probable.sensitivity), strict=True))
    return {name: _share(shares.get(source, shares.get(source.partition(":")[0])) if source else None)
            for name, source, *_ in rows}


def _share(size):
    return UNKNOWN if size is None else (
        (0, -max(size, 0.0)), f"{percent(max(size, 0.0), 2)} of the variance of the growth rate, with its group")


def _derived(product, name, source):
    """Influence of the value called ``name`` on the mode that grows most, or of the one that stands for it."""
    parameters = list(map(str, product.parameter))
    value = name if name in parameters else next(
        (known for pattern, known in STANDS_FOR if fnmatchcase(name, pattern)), source)
    if value not in parameters or not product.known[0, parameters.index(value)]:
        return UNKNOWN
    k = parameters.index(value)
    change, frequency = float(product.change[0, k]), quantity(product.mode_root[0].imag / (2 * np.pi), "Hz", 3)
    return (0, -abs(change)), (f"{'+' if change > 0 else ''}{quantity(change, '1/s', 2)} by one standard deviation, of"
                               f" the mode at {frequency}{'' if value == name else f', as {in_words(value)}'}")

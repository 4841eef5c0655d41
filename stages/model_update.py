"""Stage model_update: values of a body that its modal test asks for."""

import copy
from typing import Literal

import numpy as np

from pipeline.case_models.bodies.assembled_brake import AssembledBrake, sections
from pipeline.case_models.bodies.brake_bodies import Bracket, Caliper, Disc, Ground, Pad, Piston, Seal
from pipeline.case_models.bodies.brake_joints import Joints, PressedPads
from pipeline.case_models.bodies.declared_values import Value, known_values, named, refuse_unknown
from pipeline.case_models.bodies.free_body import FreeBody
from pipeline.case_models.bodies.measured_points import Point, refuse_unplaced, rows
from pipeline.contract import ConfigError, Context, Section, option, stage
from pipeline.contract import documents as yaml
from pipeline.physics.modal.disc_modes import describe
from pipeline.physics.modal.mode_pairing import assurance, grouped, nearest_mixture, real
from pipeline.physics.modal.model_updating import CLOSE, Test, update
from pipeline.products import ModalTest, ModelUpdate, ResponseFunctions
from pipeline.systems.disc_brake_rows import body_names

#: sections of the brake that hold its bodies and joints: those of ``structure`` under the same names
STRUCTURE = ("disc", "pad", "caliper", "bracket", "piston", "joints")
#: share of measured modes with a pair beyond doubt that must be exceeded for values to be handed on
_ENOUGH = 0.5
#: values whose joint only some brakes have: section, and its kind or None for a force of the piston
_ONLY_WITH = {"joints.mount_stiffness": "bracket", "joints.shim_stiffness": "piston",
              "joints.seal_stiffness": "piston"}


class Settings(Section):
    """The body hung freely, or the assembled brake; the values that may be off, and where the points of the test lie."""

    run: str | None = option(None, "run of the modal test; none = the only one")
    body: Literal["disc", "pad", "caliper", "assembly"] = option("disc", "body that was tested, hung freely; assembly ="
                                                                 " the whole brake at rest")
    disc: Disc = option(Disc(), "brake disc, as in the section structure")
    pad: Pad = option(Pad(), "pad, as in the section structure")
    caliper: Caliper = option(Caliper(), "caliper, as in the section structure")
    bracket: Ground | Bracket = option(Ground(), "bracket, as in the section structure", discriminator="kind")
    piston: Seal | Piston = option(Seal(), "piston, as in the section structure", discriminator="kind")
    joints: Joints = option(Joints(), "joints, as in the section structure")
    pressed: PressedPads = option(PressedPads(), "pads pressed on the disc in the test of an assembly")
    values: dict[str, Value] = option({}, "values that may be off, as SECTION.NAME; those of a single body also by their"
                                      " names alone")
    points: tuple[Point, ...] = option((), "points of the test; none = modes of a single body are paired by frequency"
                                       " alone")


def stated(given):
    """Refuse values and points that the brake does not have before anything is computed, and a case without any."""
    settings, where = given["model_update"], "model_update"
    part = None if settings.body == "assembly" else settings.body
    values = named(settings.values, part)
    refuse_unknown(values, known_values(sections(settings)), where)
    if not any(part is None or name.startswith(f"{part}.") for name in values):
        raise ConfigError(f"{where}.values", f"values of {part or 'bodies and joints'} that may be off, such as"
                          f" {part or 'disc'}.young: {{spread: 0.05}}", "none")
    if part is not None:
        return refuse_unplaced(settings.points, (part,), where)
    lacking = [name for name in values if (kind := _ONLY_WITH.get(name)) and getattr(settings, kind).kind != "body"]
    lacking += [name for name in values if name.startswith("pressed.") and not settings.pressed.force]
    if lacking:
        raise ConfigError(f"{where}.values", "joints that this brake has: bracket and piston as bodies, pads pressed by a"
                          " force", ", ".join(lacking), "state what they belong to, or leave them out")
    if not settings.points:
        raise ConfigError(f"{where}.points", "points of the test with the bodies that they lie on: modes of an assembly"
                          " are too close to be paired by frequency alone", "none")
    refuse_unplaced(settings.points, body_names(settings), where)


def companions(product, case):
    """The case with the values that the test asks for, with their standard deviations, and a brake with them.

    None where no more than half of the measured modes have a pair beyond doubt: it may be of something else.
    """
    if case is None or np.mean(product.clear) <= _ENOUGH:
        return {}
    document = copy.deepcopy(case.document)
    section = document.setdefault("model_update", {})
    for name, unit, value, spread in zip(product.parameter, product.unit, product.after, product.after_spread,
                                         strict=True):
        part, key = str(name).split(".")
        section.setdefault(part, {})[key] = {
            "value": f"{float(value):.6g} {unit}" if str(unit) else float(f"{value:.6g}"),
            "origin": "measured", "source": f"modal test {case.name}, {spread:.1%}"}
    section["values"] = _handed_on(product, section.get("values", {}))
    title = f"{document.get('title', case.name)}, updated"
    brake = {"chain": "brake_squeal", "title": title,
             "structure": {name: section[name] for name in STRUCTURE if name in section}}
    return {f"{case.name}_updated.yaml": yaml.yaml_text(document | {"title": title}),
            f"{case.name}_brake.yaml": yaml.yaml_text(brake)}


def _handed_on(product, values):
    """Section values with what the test leaves uncertain in place of the priors of its values."""
    names = [str(name) for name in product.parameter]
    left = {name: value for name, value in named(values, str(product.body)).items() if name not in names}
    for k, name in enumerate(names):
        beside = {names[j]: round(float(product.correlation[k, j]), 6) for j in range(k)
                  if abs(product.correlation[k, j]) > 0.01}
        left[name] = {"spread": float(f"{product.after_spread[k]:.4g}")} | ({"correlation": beside} if beside else {})
    return left


@stage(companions=companions, check=stated)
def model_update(responses: ResponseFunctions, modes: ModalTest, settings: Settings, context: Context) -> ModelUpdate:
    """Update the values of a body, or of the joints of a brake, by a modal test, and tell how well they are known.

    Method:
    Measured modes were paired with those of the finite-element model ({body}) by frequency and shape (MAC, of pairs of
    a disc with the nearest mixture of both); pairs in doubt (odds below e^3) do not count. The values declared were
    updated by all others, ln f being normal about that of the model with the error of the test and one of the model,
    which is integrated out; a split pair counts by its mean; priors are log-normal with the spreads declared. Bodies of
    an assembly are reduced to their joints (Craig-Bampton); pads under a force of the piston stick to the disc.
    """
    stated({"model_update": settings})
    name, test = _test(modes, settings)
    model = (AssembledBrake if settings.body == "assembly" else FreeBody)(settings, context.solver,
                                                                          float(test.frequency.max()))
    seen = rows(settings.points, test.place, test.reference, responses.tests[name].unit, model.nodes, "model_update")
    shown = np.zeros((len(test.frequency), 0)) if seen is None else _shown(test, seen)
    if settings.body == "assembly":
        seen = model.observe(seen)
    measured = Test(test.frequency, test.frequency_std / test.frequency, shown)
    found = update(model, seen and seen.products, measured, len(model.declared.names))
    context.log(f"{int(found.pairing.clear.sum())} of {len(test.frequency)} measured modes have a pair beyond doubt")
    return ModelUpdate(run=name, body=settings.body, **_values(model.declared, found), **_modes(test, model, found),
                       **_points(test, shown, seen, found))


def _test(modes, settings):
    """(name, TestModes) of the run of the settings."""
    held = {name: run for name, run in modes.runs.items() if len(run.frequency)}
    wanted = settings.run or (next(iter(held)) if len(held) == 1 else None)
    if wanted not in held:
        raise ConfigError("model_update.run", f"a run with modes: {', '.join(held) or 'none has any'}",
                          repr(settings.run))
    return wanted, held[wanted]


def _shown(test, seen):
    """Real shapes (t, n) as displacements: residues of velocities and accelerations are i w and (i w)^2 times those."""
    turn = 2j * np.pi * test.frequency[:, None]
    return np.array([real(row) for row in test.shape[:, seen.index] / turn ** seen.order])


def _values(declared, found):
    spread, correlation = declared.spread_of(found.covariance)
    return {"parameter": list(declared.names), "unit": declared.units.tolist(), "before": declared.stated,
            "before_spread": declared.spread, "after": declared.values(found.latent), "after_spread": spread,
            "correlation": correlation, "model_error": found.error, "model_error_spread": found.error_spread}


def _modes(test, model, found):
    """Fields of measured modes and of the groups of the model; a group before is that of the most alike shapes."""
    pairing, after, before = found.pairing, found.after, grouped(found.before.frequency, CLOSE)
    first = [group[0] for group in found.groups]
    alike = assurance(after.shown[:, first].T, [found.before.shown[:, group] for group in before]).argmax(axis=1)
    diameters = np.full(len(first), -1)
    if model.part == "disc":
        diameters = describe(model.solid(found.latent).mesh.node, after.shown)[0][first]
    return {"measured_frequency": test.frequency, "measured_std": test.frequency_std, "pair": pairing.group,
            "rival": pairing.rival, "odds": pairing.odds, "clear": pairing.clear.astype(int),
            "likeness": found.likeness, "frequency_spread": found.spread, "diameters": diameters,
            "frequency_before": [found.before.frequency[before[k]].mean() for k in alike],
            "frequency": [after.frequency[group].mean() for group in found.groups],
            "members": [len(group) for group in found.groups], **_movers(model, found)}


def _movers(model, found):
    """Fields of the body that moves most in each group, with its share of the kinetic energy."""
    if model.part != "assembly":
        return {"mover": [model.part] * len(found.groups), "mover_share": np.ones(len(found.groups))}
    share = np.array([found.after.share[:, group].mean(axis=1) for group in found.groups])
    return {"mover": [model.names[k] for k in share.argmax(axis=1)], "mover_share": share.max(axis=1)}


def _points(test, shown, seen, found):
    """Fields of the points: how well each agrees over the pairs, shapes of the model scaled to those measured."""
    if seen is None:
        return {"place": [], "reference": [], "agreement": [], "distance": []}
    clear = np.flatnonzero(found.pairing.clear)
    own = shown[clear] / np.linalg.norm(shown[clear], axis=1, keepdims=True)
    members = [found.groups[group] for group in found.pairing.group[clear]]
    model = np.array([nearest_mixture(shape, seen.products(found.after.shown[:, group]))
                      for shape, group in zip(own, members, strict=True)])
    both = np.sum(own**2, axis=0) * np.sum(model**2, axis=0)
    place, reference = ([str(each[i]) for i in seen.index] for each in (test.place, test.reference))
    return {"place": place, "reference": reference, "distance": seen.distance,
            "agreement": np.sum(own * model, axis=0) / np.sqrt(np.maximum(both, 1e-300))}

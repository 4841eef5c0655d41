"""Stage model_update: values of a body that its modal test asks for."""

from typing import Literal

import numpy as np

from pipeline.case_models.bodies.assembled_brake import AssembledBrake, sections
from pipeline.case_models.bodies.brake_bodies import Bracket, Caliper, Disc, Ground, Pad, Piston, Seal
from pipeline.case_models.bodies.brake_joints import Joints, PressedPads
from pipeline.case_models.bodies.declared_values import Value, known_values, named, refuse_unknown
from pipeline.case_models.bodies.free_body import FreeBody
from pipeline.case_models.bodies.measured_points import Point, refuse_unplaced, rows
from pipeline.case_models.bodies.other_meshes import off_by_mesh, other_meshes
from pipeline.case_models.bodies.updated_case import completed
from pipeline.contract import ConfigError, Context, Section, option, stage
from pipeline.physics.modal.disc_modes import describe
from pipeline.physics.modal.mode_pairing import assurance, grouped, nearest_mixture, real
from pipeline.physics.modal.model_updating import CLOSE, Test, update, with_errors
from pipeline.products import ModalTest, ModelUpdate, ResponseFunctions
from pipeline.systems.disc_brake_rows import body_names
from pipeline.systems.mesh_files.bodies import given as given_by_files

#: share of a body by which nodes of a coarser mesh may lie off the points
_ANYWHERE = 0.5
#: values whose joint only some brakes have, and the section that has to be a body
_ONLY_WITH = {"joints.mount_stiffness": "bracket", "joints.shim_stiffness": "piston",
              "joints.seal_stiffness": "piston"}
#: values whose joint only a fixed, or only a floating caliper has
_FIXED, _FLOATING = ("joints.bolt_",), ("joints.guide_pin_", "joints.finger_")


class Settings(Section):
    """The body hung freely or the assembled brake, the values that may be off, and where points of the test lie."""

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
    values: dict[str, Value] = option({}, "values that may be off, as SECTION.NAME; of a single body by their names"
                                      " alone as well")
    finer: float | None = option(1.5, "elements of a finer mesh over those of the mesh, in each direction, and of the"
                                 " disc's over those of a coarser one, by which the error of the mesh is estimated"
                                 " where points are stated; none = it is not", gt=1, le=4)
    points: tuple[Point, ...] = option((), "points of the test; none = modes of a single body are paired by frequency"
                                       " alone")


def stated(given):
    """Refuse values and points that the brake does not have before anything is computed, and a case without any."""
    settings, where = given["model_update"], "model_update"
    part = None if settings.body == "assembly" else settings.body
    values = named(settings.values, part)
    refuse_unknown(values, known_values(sections(settings)), where)
    taken = [name for name in given_by_files(settings) if name in values]
    if taken:
        raise ConfigError(f"{where}.values", "values that the case states, from which the update begins",
                          f"{', '.join(taken)} of the mesh file", "state them in the section of the body")
    if not any(part is None or name.startswith(f"{part}.") for name in values):
        raise ConfigError(f"{where}.values", f"values of {part or 'bodies and joints'} that may be off, such as"
                          f" {part or 'disc'}.young: {{spread: 0.05}}", "none")
    if settings.pad.lining_pressure_exponent:
        raise ConfigError(f"{where}.pad.lining_pressure_exponent", "0: an update finds the moduli at the pressure of"
                          " its test", f"{settings.pad.lining_pressure_exponent:g}", "state it in the case of a brake")
    if part is None:
        _refuse_lacking(settings, values, where)
    refuse_unplaced(settings.points, (part,) if part else body_names(settings), where)


def _refuse_lacking(settings, values, where):
    """Refuse values of joints that the assembled brake does not have, and a test without points."""
    lacking = [name for name in values if (kind := _ONLY_WITH.get(name)) and getattr(settings, kind).kind != "body"]
    lacking += [name for name in values if name.startswith(_FLOATING if settings.caliper.fixed else _FIXED)]
    lacking += [name for name in values if name.startswith("pressed.") and not settings.pressed.force]
    if lacking:
        raise ConfigError(f"{where}.values", "joints that this brake has: bracket and piston as bodies, a fixed or"
                          " floating caliper, pads pressed by a force", ", ".join(lacking),
                          "state what they belong to, or leave them out")
    if not settings.points:
        raise ConfigError(f"{where}.points", "points of the test with the bodies that they lie on: modes of an assembly"
                          " are too close to be paired by frequency alone", "none")


@stage(companions=completed, check=stated)
def model_update(responses: ResponseFunctions, modes: ModalTest, settings: Settings, context: Context) -> ModelUpdate:
    """Update the values of a body, or of the joints of a brake, by a modal test, and tell how well they are known.

    Method:
    Measured modes were paired with those of the finite-element model ({body}) by frequency and shape (MAC, of pairs of
    a disc with the nearest mixture of both); pairs in doubt (odds below e^3) do not count. The values declared were
    updated by all others, ln f being normal about that of the model with the error of the test and one of the model,
    which is integrated out; a split pair counts by its mean; priors are log-normal with the spreads declared. Bodies of
    an assembly are reduced to their joints (Craig-Bampton); pads under a force of the piston stick to the disc. The
    error of the mesh is what values of a finer one, of the disc a coarser one, show with an order of 2 ({finer} times
    the elements).
    """
    stated({"model_update": settings})
    name, test = _test(modes, settings)
    model, seen = _model(settings, test, responses.tests[name].unit, context)
    shown = np.zeros((len(test.frequency), 0)) if seen is None else _shown(test, seen)
    measured = Test(test.frequency, test.frequency_std / test.frequency, shown)
    found = update(model, seen and seen.products, measured, len(model.declared.names))
    context.log(f"{int(found.pairing.clear.sum())} of {len(test.frequency)} measured modes have a pair beyond doubt")
    checked = settings.finer is not None and seen is not None
    errors = [factor * _by_mesh(other, found, seen, test, responses.tests[name].unit, context)
              for other, factor in (other_meshes(settings, settings.finer) if checked else ())]
    whole = with_errors(found, measured, errors) if errors else found.covariance
    return ModelUpdate(run=name, body=settings.body, **_values(model.declared, found, whole),
                       **_modes(test, model, found), **_points(test, shown, seen, found),
                       mesh_checked=int(checked))


def _by_mesh(settings, found, seen, test, units, context):
    """Change (g,) of ln f of the groups by the mesh of other ``settings``."""
    model, there_seen = _model(settings, test, units, context, far=_ANYWHERE)
    there = model(found.latent)
    return off_by_mesh(found.after, found.groups, seen.products, there, grouped(there.frequency, CLOSE),
                       there_seen.products)


def _model(settings, test, units, context, **far):
    """(model of the body or the brake, Rows of the test on what its shapes show or None)."""
    kind = AssembledBrake if settings.body == "assembly" else FreeBody
    model = kind(settings, context.solver, float(test.frequency.max()))
    seen = rows(settings.points, test.place, test.reference, units, model.nodes, "model_update", **far)
    return model, model.observe(seen) if settings.body == "assembly" else seen


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


def _values(declared, found, covariance):
    """Fields of the values; their ``covariance`` (p, p) with the error of the mesh."""
    spread, correlation = declared.spread_of(covariance)
    without = declared.spread_of(found.covariance)[0]
    return {"parameter": list(declared.names), "unit": declared.units.tolist(), "before": declared.stated,
            "before_spread": declared.spread, "after": declared.values(found.latent), "after_spread": spread,
            "correlation": correlation, "mesh_spread": np.sqrt(np.maximum(spread**2 - without**2, 0.0)),
            "model_error": found.error, "model_error_spread": found.error_spread}


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

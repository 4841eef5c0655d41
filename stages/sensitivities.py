"""Stage sensitivities: derivatives of the growing modes of a brake to its values, ranked, and what makes one stable."""

from functools import partial

import numpy as np

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity import differences as again
from pipeline.case_models.sensitivity import remedies
from pipeline.case_models.sensitivity.derivatives import LEFT_OUT, derivatives, scatter_of
from pipeline.case_models.sensitivity.matrices import Case, without_surface
from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.contract import Context, Section, Variants, option, stage
from pipeline.physics.sliding.model import at_state
from pipeline.products import ComplexModes, Effects, FrictionMap, Probability, ReducedModel, Sensitivities, Structure


class Settings(Section):
    """Which modes, which values, and what is assumed of their scatter."""

    modes: int | None = option(None, "unstable modes, strongest first, those of one frequency counting once; none ="
                                     " all; 0 = no sensitivities", ge=0)
    differences: tuple[again.Difference, ...] = option(
        (), "settings of stages up to reduced_model for which the case is computed twice more, such as"
            " structure.disc.ring_thickness, with their scatter")
    unstated_scatter: float = option(0.05, "standard deviation over the value where the case declares no scatter", gt=0)
    remedies: int = option(3, "values that could make the strongest mode stable, each tried in the reduced model", ge=0)


def _check(sections):
    again.check_differences(sections, "sensitivities.differences")


def _variants(sections):
    """The case with each of the differences up and down, without a friction sweep, in the reduced model alone."""
    return again.raised_and_lowered(sections) if sections["sensitivities"].modes != 0 else {}


@stage(check=_check, variants=_variants)
def sensitivities(model: ReducedModel, friction_map: FrictionMap | None, modes: ComplexModes,
                  structure: Structure | None, probability: Probability | None, effects: Effects | None,
                  varied: Variants[ComplexModes], settings: Settings, context: Context) -> Sensitivities:
    """Rank what moves the growth rate of each unstable mode, and try what would make the strongest stable.

    Roots that differ by operating point alone count once, where they grow most.

    Method:
    Derivatives of each growing root to the values of the case follow from its left and right vectors and from the
    change of its sliding state, contact law and friction map being smoothed over their rows; settings named in
    'differences' were raised and lowered instead. Values are ranked by what one standard deviation of them changes, as
    the case declares it or {unstated_scatter} of the value. Up to {remedies} values were changed until the strongest
    mode no longer grows in the reduced model.
    """
    points, chosen = StabilitySettings.of(modes), _chosen(modes, settings.modes)
    where = modes.unstable_operating[chosen]
    tasks = [(operating, chosen[where == operating]) for operating in dict.fromkeys(where.tolist())]
    given = (model, effects), structure, friction_map, modes, points
    solved = zip(tasks, context.map(partial(_at_operating_point, *given), tasks, "operating points"), strict=True)
    found = {int(mode): (each, k) for (_, members), each in solved for k, mode in enumerate(members)}
    rows = [found[int(mode)] for mode in chosen]
    attempt = partial(_tried, *given, where[0] if len(where) else 0)
    others = again.by_differences(settings.differences if varied else (), modes, chosen, varied, context.case)
    return Sensitivities(
        mode=chosen, pressure=modes.operating_pressure[where], speed=modes.operating_speed[where],
        friction=modes.operating_friction[where], mode_root=modes.unstable_root[chosen],
        root=np.array([each.roots[k] for each, k in rows], complex),
        **_ranked(_joined(_by_vectors(rows, probability, settings), others)),
        unstated_scatter=settings.unstated_scatter, **_remedies(rows, attempt, settings, context),
        left_out=list(LEFT_OUT), left_out_reason=list(LEFT_OUT.values()))


def _chosen(modes, count):
    """Indices of up to ``count`` modes, strongest first."""
    first = np.flatnonzero(modes.unstable_first == np.arange(len(modes.unstable_first)))
    return first[:count]


def _case(brake, modes, points, operating):
    """(Case of the products ReducedModel and Effects, or None, at an operating point, mean friction there)."""
    model, effects = brake
    state, speed = divmod(int(operating), len(points.speeds))
    case = Case(without_surface(at_state(model, state)), state, points.speeds[speed], effects=effects)
    return case, float(modes.operating_friction[operating])


def _at_operating_point(brake, structure, friction_map, modes, points, task):
    """Derivatives of the modes of a task (operating point, their indices)."""
    operating, members = task
    case, friction = _case(brake, modes, points, operating)
    return derivatives(case, modes.unstable_reduced[members], structure, friction, friction_map, points)


def _by_vectors(rows, probability, settings):
    """Fields over the values that vectors give; ``rows``: (Derivatives, index of the root) of each mode."""
    values = rows[0][0].parameters if rows else ()
    table = {"parameter": [v.name for v in values], "unit": [v.unit for v in values],
             "method": ["analytic"] * len(values), "source": [scatter_of(v, probability)[0] for v in values],
             "declared": [int(scatter_of(v, probability)[1] is not None) for v in values]}
    columns = [_of_mode(each, k, probability, settings) for each, k in rows]
    for k, (name, kind) in enumerate((("value", float), ("scatter", float), ("derivative", complex), ("error", float))):
        table[name] = np.reshape([column[k] for column in columns], (len(rows), len(values))).astype(kind)
    return {**table, "known": np.ones((len(rows), len(values)), int)}


def _of_mode(each, k, probability, settings):
    """(values, scatters, derivatives of root k, errors), each (p,)."""
    reference = np.array([v.reference for v in each.parameters])
    widths = [(scatter_of(v, probability)[1], v.value) for v in each.parameters]
    scatter = [settings.unstated_scatter * abs(value) if width is None else width for width, value in widths]
    changes = each.changes[:, k] / reference
    return [v.value for v in each.parameters], scatter, changes[0], np.ptp(changes.real, axis=0)


def _joined(table, others):
    """Both tables, one beside the other."""
    return {name: np.concatenate((part, others[name]), axis=1) if isinstance(part, np.ndarray)
            else part + others[name] for name, part in table.items()}


def _ranked(table):
    """The table with what one standard deviation changes, and the ranks of that."""
    change, known = table["derivative"].real * table["scatter"], table["known"] > 0
    rank = 1 + np.argsort(np.argsort(np.where(known, -abs(change), np.inf), axis=1, kind="stable"), axis=1)
    return {**table, "change": change, "rank": np.where(known, rank, 0)}


def _remedies(rows, solve, settings, context):
    """Fields of what makes the strongest mode stable; ``solve``: as of the operating points."""
    if not rows:
        found, each = [], None
    else:
        each, k = rows[0]
        slopes = each.changes[0, k]
        picked = remedies.candidates(each.parameters, each.roots[k].real, slopes.real, settings.remedies)
        tasks = [(p, each.roots[k], each.shapes[:, k], slopes[p]) for p in picked]
        found = zip(picked, context.map(solve, tasks, "values that could make it stable"), strict=True)
    found = [(p, each.parameters[p].value + point[0] * each.parameters[p].reference, point[1])
             for p, point in found if point is not None]
    parameter, value, root = (list(column) for column in zip(*found, strict=True)) if found else ([], [], [])
    return {"remedy_mode": [0] * len(found), "remedy_parameter": parameter, "remedy_value": value,
            "remedy_root": np.array(root, complex)}


def _tried(brake, structure, friction_map, modes, points, operating, task):
    """What a task (index of a value, root, shape, slope) comes to, as of ``stabilised``."""
    number, root, shape, slope = task
    case, friction = _case(brake, modes, points, operating)
    value = parameters(case, structure, friction, points)[number]
    return remedies.stabilised(case, root, shape, value, slope, friction_map, points)

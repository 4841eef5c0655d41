"""verdict.json: what the first screen says, for other programs."""

import json

import numpy as np

from pipeline.views.chapters.convergence import WORDS, statement
from pipeline.views.chapters.friction import outside_computed
from pipeline.views.chapters.limit_cycle import total
from pipeline.views.chapters.models.countermeasures import best_variant
from pipeline.views.chapters.models.noise_matrix_tables import differing
from pipeline.views.chapters.pad_motion import open_balance
from pipeline.views.chapters.unstable_modes import critical_friction, losses, mechanism, pair, squealing

SCHEMA = "brakechain-verdict/2"
TWO_PI = 2.0 * np.pi


def verdict_text(verdict, products, failed=()):
    """JSON text of a Verdict and the ``products`` (name -> product or None) behind it; SI units, null where unknown.

    ``failed``: sentences on stages that could not be finished, which stand before all other warnings.
    """
    modes, refined, given = (products.get(name) for name in ("complex_modes", "convergence", "matrix_modes"))
    document = {"schema": SCHEMA, "headline": verdict.headline,
                "squeal_can_start": _can_start(modes) if given is None else len(given.roots.residual) > 0,
                "probability": _probability(products.get("probability")),
                "sensitivities": _sensitivities(products.get("sensitivities")),
                "unstable_modes": _of_matrices(given) + ([] if modes is None else _unstable(modes)),
                "convergence": None if refined is None else _convergence(refined),
                "transient": _transient(products.get("limit_cycle")),
                "countermeasures": _countermeasures(products.get("countermeasures")),
                "heard_lines": _heard(products.get("line_evidence")),
                "noise_matrix": _matrix(products.get("noise_matrix")),
                "warnings": [*failed] + _warnings(modes, refined) + list(filter(None, (
                    outside_computed(products), open_balance(products.get("multibody")))))}
    return json.dumps(document, indent=1) + "\n"


def _transient(cycle):
    """Growth while motion is small, and what it ends in, at each operating point; None where nothing was simulated."""
    if cycle is None:
        return None
    onset = [{"frequency": root.imag / TWO_PI, "growth_rate": root.real, "simulated_growth_rate": seen.real,
              "operating_point": int(k)}
             for k, root, seen in zip(cycle.onset_operating, cycle.onset_root, cycle.onset_simulated, strict=True)]
    level = total(cycle)[:, -1:]
    cycles = [{"pressure": float(p), "speed": float(v), "velocity": float(level[k, 0]),
               "frequency": float(cycle.cycle_frequency[k]), "settled": bool(cycle.settled[k]),
               "open_share": float(cycle.open_share[k, -1]), "stick_share": float(cycle.stick_share[k, -1]),
               "energy_imbalance": float(cycle.imbalance[k])}
              for k, (p, v) in enumerate(zip(cycle.pressure, cycle.speed, strict=True))]
    checks = {str(name): {"level_db": float(decibel), "frequency": float(frequency)} for name, decibel, frequency in
              zip(cycle.check, cycle.check_level, cycle.check_frequency, strict=True)}
    return {"onset": onset, "limit_cycles": cycles, "changes": checks}


def _heard(weighed):
    """What made it squeal by the lines that were heard; None where none were weighed."""
    if weighed is None:
        return None
    rows = zip(weighed.hypothesis, weighed.factor, weighed.factor_error, strict=True)
    return {"verdict": str(weighed.verdict), "lines": [float(f) for f in weighed.line],
            "ln_factor_flexible_against_rigid": float(weighed.flexible),
            "standard_error": float(weighed.flexible_error),
            "ln_factors": {str(name): {"value": float(v), "standard_error": float(e)} for name, v, e in rows}}


def _matrix(product):
    """Occurrence over a schedule, recorded stops beside it, and where they differ; None without a noise matrix."""
    if product is None:
        return None
    apart = [{"condition": name, "recorded": stops, "noisy": noisy, "predicted_noisy": float(expected),
              "family_wise_p": float(p), "model_squeals_too": "much" if sign > 0 else "little"}
             for name, noisy, stops, expected, p, sign in differing(product)]
    return {"schedule": str(product.title), "applications": int(product.applications.sum()),
            "occurrence": float(product.occurrence), "interval": [float(v) for v in product.occurrence_interval],
            "recorded": int(product.condition_stops.sum()), "noisy": int(product.condition_noisy.sum()),
            "predicted_noisy": float(product.all_expected), "differences": apart}


def _can_start(modes):
    return None if modes is None else bool(squealing(modes).any())


def _unstable(modes):
    """One entry for each unstable mode at each operating point, strongest first."""
    found, squeals = [], squealing(modes)
    for k, (root, point) in enumerate(zip(modes.unstable_root, modes.unstable_operating, strict=True)):
        diameters, in_plane, out_of_plane = (int(counts[k]) if counts[k] >= 0 else None for counts in (
            modes.unstable_diameters, modes.unstable_in_plane, modes.unstable_out_of_plane))
        found.append({
            "frequency": root.imag / TWO_PI, "growth_rate": root.real, "damping_ratio": -root.real / abs(root),
            "squeal": bool(squeals[k]), "nodal_diameters": diameters, "nodal_diameters_in_plane": in_plane,
            "nodal_diameters_out_of_plane": out_of_plane,
            "pressure": float(modes.operating_pressure[point]), "speed": float(modes.operating_speed[point]),
            "friction": float(modes.operating_friction[point]),
            "bodies": _named(modes.body_name, modes.unstable_share[k]),
            "growth_by_term": _named(modes.growth_term, modes.unstable_growth[k]), "damping": losses(modes, k),
            "finite_elements": _finite_elements(root, modes.unstable_reduced[k], modes.unstable_residual[k]),
            "same_mode_as": int(modes.unstable_first[k]), **_over_friction(modes, k)})
    return found


def _of_matrices(modes):
    """One entry for each unstable mode of a system of matrices; none without these."""
    if modes is None:
        return []
    found = modes.roots
    return [{"frequency": root.imag / TWO_PI, "growth_rate": root.real, "damping_ratio": -root.real / abs(root),
             "speed": float(found.speed[point]), "friction": float(modes.friction), "residual": float(residual),
             "growth_per_relative_change": _named(modes.term, term.real)}
            for root, point, residual, term in zip(found.unstable_root, found.unstable_operating, found.residual,
                                                   found.per_term, strict=True)]


def _finite_elements(root, reduced, residual):
    """How far the reduced model is from the full matrices, and the residual there; None without these."""
    if residual < 0:
        return None
    return {"residual": float(residual), "reduced_frequency_change": float(reduced.imag / root.imag - 1),
            "reduced_growth_change": float(reduced.real - root.real)}


def _over_friction(modes, index):
    """Critical friction, mechanism, and the modes without friction that it is made of; null where not followed."""
    members = [{"frequency": frequency, "body": body, "nodal_diameters": lines}
               for frequency, body, lines in pair(modes, index)]
    return {"critical_friction": critical_friction(modes, index), "mechanism": mechanism(modes, index),
            "pair": members or None}


def _probability(product):
    """Share of draws with an unstable mode, with 95 % intervals; null without draws."""
    if product is None or not len(product.value):
        return None
    points = [{"pressure": float(p), "speed": float(v), "value": float(share), "interval": list(map(float, interval))}
              for p, v, share, interval in zip(product.pressure, product.speed, product.probability, product.interval,
                                               strict=True)]
    bands = [{"middle": float(middle), "value": float(share), "interval": list(map(float, interval))}
             for middle, share, interval in zip(product.band, product.band_any, product.band_interval, strict=True)]
    return {"value": float(product.overall), "interval": list(map(float, product.overall_interval)),
            "draws": len(product.value), "operating_points": points, "third_octaves": bands,
            "sensitivity": _named(product.source, product.sensitivity)}


def _sensitivities(product):
    """Of each examined mode, what one standard deviation of each value adds to its growth rate; null without modes."""
    if product is None or not len(product.mode):
        return None
    tried = [{"value": str(product.parameter[p]), "now": float(product.value[mode, p]), "then": float(value),
              "mode": int(product.mode[mode]), "growth_rate": root.real} for mode, p, value, root in
             zip(product.remedy_mode, product.remedy_parameter, product.remedy_value, product.remedy_root, strict=True)]
    return {"modes": [{"mode": int(mode), "growth_rate": root.real, "frequency": root.imag / TWO_PI,
                       "growth_per_standard_deviation": _named(product.parameter, change),
                       "growth_per_unit": _named(product.parameter, derivative.real)} for mode, root, change, derivative
                      in zip(product.mode, product.root, product.change, product.derivative, strict=True)],
            "units": dict(zip(map(str, product.parameter), map(str, product.unit), strict=True)), "tried": tried}


def _named(names, values):
    return {str(name): float(value) for name, value in zip(names, values, strict=True)}


def _convergence(refined):
    """What was refined, what became of each unstable mode, and what moved those that did not stay."""
    modes = [{"frequency": root.imag / TWO_PI, "growth_rate": float(root.real),
              "frequency_change": float(new.imag / root.imag - 1), "growth_change": float(new.real - root.real),
              "reduction_change": float(root.real - reduced.real), "found": bool(found), "held": bool(held)}
             for root, reduced, new, found, held in zip(refined.root, refined.reduced_root, refined.refined_root,
                                                        refined.found, refined.held, strict=True)]
    causes = {str(name): [float(each.real) for each in change]
              for name, change in zip(refined.cause, refined.cause_change, strict=True)}
    return {"converged": bool(refined.converged.item()), "pressure": float(refined.pressure),
            "speed": float(refined.speed), "largest_frequency_change": float(refined.frequency_change),
            "largest_growth_change": float(refined.growth_change), "error_factor": float(refined.error_factor),
            "refined": list(map(str, refined.refinement)),
            "not_refined": dict(zip(map(str, refined.left_out), map(str, refined.left_out_reason), strict=True)),
            "degrees_of_freedom": [int(refined.freedoms), int(refined.refined_freedoms)],
            "contacts": [int(refined.contacts), int(refined.refined_contacts)], "modes": modes,
            "added_modes": int(refined.added), "growth_change_by": causes}


def _countermeasures(product):
    """What each variant does to the modes and to the probability of squeal, by its name; null without variants."""
    if product is None or not len(product.variant):
        return None
    variants = {}
    for k, name in enumerate(product.variant):
        states = list(map(str, product.state[product.mode_variant == k]))
        squeal = {"value": float(product.variant_overall[k]), "interval": product.variant_overall_interval[k].tolist(),
                  "change": float(product.overall_change[k]),
                  "change_interval": product.overall_change_interval[k].tolist()} if product.draws else None
        stated = product.cost_known[k] == 1
        variants[str(name)] = {"change": str(product.change[k]), "probability": squeal,
                               "modes": {state: states.count(state) for state in sorted(set(states))},
                               "costs": _named(product.cost_name[stated], product.cost[k][stated])}
    best = best_variant(product)
    return {"best": None if best is None else str(product.variant[best]), "variants": variants}


def _warnings(modes, refined):
    told = []
    if refined is not None and not refined.converged.item():
        told.append(statement(refined))
    if modes is not None and refined is None:
        told.append("convergence was not examined")
    return told + [f"not refined: {WORDS[str(name)]}" for name in (() if refined is None else refined.left_out)]

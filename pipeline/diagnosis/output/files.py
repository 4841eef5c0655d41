"""What a diagnosis writes beside its HDF5: diagnosis.json, the latent force as CSV, and the completed case."""

import copy
import json

import numpy as np

from pipeline.case_models.effect_block import written
from pipeline.contract import documents as yaml
from pipeline.diagnosis.output.combinations import as_rows
from pipeline.diagnosis.problem import split_name
from pipeline.diagnosis.signals.forward_model import NAMES
from pipeline.diagnosis.signals.latent_force_law import LABEL

SCHEMA = "brakechain-diagnosis/1"
#: hypotheses that are listed beside those named
ALTERNATIVES = 5


def companions(product, case):
    """{file name: text}: diagnosis.json, latent_force.csv where a force was found, the case where it is completed."""
    files = {"diagnosis.json": json.dumps(as_json(product), indent=2, ensure_ascii=False) + "\n"}
    if product.latent:
        files["latent_force.csv"] = latent_csv(product)
    if case is not None and _completable(case) and (name := completed_name(product, case.name)):
        files[name] = yaml.yaml_text(completed(product, case))
    return files


def _completable(case):
    """Lists of lines name alternatives to numbers of others, which no case can run."""
    return (case.document.get("diagnosis") or {}).get("forward") != "lines"


def latent_csv(product):
    """The latent force of every run as CSV; its head says that it is a description, not identified physics."""
    rows = [f"# {product.latent_sentence.item()}", "run,time_s,force_N,std_N,displacement_m,velocity_m_per_s"]
    for name, force in product.latent.items():
        columns = (force.time, force.force, force.std, force.displacement, force.velocity)
        rows += [",".join((name, *(f"{value:.9g}" for value in row))) for row in zip(*columns, strict=True)]
    return "\n".join(rows) + "\n"


def completed_name(product, case_name):
    """Name of the file of the completed case; empty where the diagnosis adds nothing that a case can state."""
    verdict = product.verdict.item()
    if verdict == "parameters":
        return f"{case_name}_with_other_values.yaml"
    effects = dict.fromkeys(e for k in _completing(product) for e in str(product.effect[k]).split(" + "))
    stated = effects and NAMES.issuperset(effects)
    return f"{case_name}_with_{'_and_'.join(effects)}.yaml" if stated else ""


def completed(product, case):
    """The document of the case with the fitted values and the named effects, each with its origin."""
    document = copy.deepcopy(case.document)
    corrections, effects = {}, {}
    for k, name in enumerate(product.parameter):
        effect, location, parameter = split_name(str(name))
        value = {"value": _written(product, k), "origin": "inferred",
                 "source": f"diagnosis of {case.name}, +- {product.parameter_std[k]:.2g}"}
        if not parameter:
            corrections[str(name)] = value
        else:
            effects.setdefault(effect, {}).setdefault(location, {})[parameter] = value
    if (document.get("diagnosis") or {}).get("forward") == "friction":
        _correct_rubbing(document, corrections)
    else:
        bench = document.setdefault("bench", {})
        if product.completed_step:
            bench["step"] = {"value": f"{float(product.completed_step)!r} s", "origin": "inferred",
                             "source": f"diagnosis of {case.name}: a longer one changes what the effects predict"}
        bench["corrections"] = {**(bench.get("corrections") or {}), **corrections}
    stated_effects = document["effects"] = document.get("effects") or {}
    for effect, places in effects.items():
        known = stated_effects.get(effect, {})
        stated_effects[effect] = known | {place: {**known.get(place, {}), **values} for place, values in places.items()}
    document["title"] = f"{document.get('title', case.name)}, completed"
    return document


def _correct_rubbing(document, corrections):
    """Write {dotted name: value} into the section micro_friction of a document."""
    for name, value in corrections.items():
        section = document.setdefault("micro_friction", {})
        *steps, last = name.split(".")
        for step in steps:
            section = section.setdefault(step, {})
        section[last] = value


def _nominal(product, name):
    """Whether a value is one of the nominal model: of no effect that the diagnosis adds."""
    effect, location, _ = split_name(name)
    return (effect, location) not in {pair for k in _completing(product) for pair in zip(
        str(product.effect[k]).split(" + "), str(product.place[k]).split(" + "), strict=False)}


def _written(product, k):
    value, unit = float(product.parameter_value[k]), written(str(product.parameter_unit[k]))
    return value if unit == "1" else f"{value!r} {unit}"


def _completing(product):
    """Rows of the hypotheses whose effects the completed model has: those known, and the first named."""
    return [*product.known, *product.named[:1]]


def as_json(product):
    """The verdict for machines; the schema is that of SCHEMA."""
    named = set(_completing(product)) | set(product.named)
    ordered = sorted(range(len(product.hypothesis)), key=lambda k: -product.posterior[k])
    combinations = as_rows(product)
    document = {
        "schema": SCHEMA, "verdict": product.verdict.item(), "reasons": [str(r) for r in product.reason],
        "effects": [_effect(product, k) for k in (*product.known, *product.named)],
        "family": product.family.item(), "grade": _grade(product), "model_error": float(product.model_error),
        "leading": [_effect(product, k, False) | {"takes": float(takes), "stays": float(stays), "values": str(values)}
                    for k, takes, stays, values in zip(product.leading, product.leading_takes, product.leading_stays,
                                                       product.leading_values, strict=True)],
        "leading_set": [combinations[k] for k in product.leading_set],
        "alternatives": [_effect(product, k, False) for k in ordered if k not in named][:ALTERNATIVES],
        "combinations": combinations,
        "not_judged": [_not_judged(product, k) for k in range(len(product.hypothesis))
                       if product.objection[k] and not product.refitted[k]],
        "location": _location(product),
        "parameters": {str(name): _parameter(product, k)
                       for k, name in enumerate(product.parameter) if _nominal(product, str(name))},
        "fit": {part: _fit(product, row, held_out) for row, (part, held_out) in enumerate(
            (("training", 0), ("held_out", 1)))},
        "unexplained_share": float(product.unexplained_share),
        "left": {"noise_floors": float(product.left_floors), "sentence": product.left_sentence.item(),
                 "next_candidate": product.left_candidate.item()},
        "at_other_noise": [
            {"noise": float(level), "verdict": str(verdict), "named": str(named)} for level, verdict, named in zip(
                product.noise_level, product.noise_verdict, product.noise_named, strict=True)],
        "next_experiment": {"conditions": [str(c) for c in product.next_condition],
                            "separates": [str(s) for s in product.next_separates], "value": float(product.next_value)},
    }
    if product.squeal:
        document["saturated_squeal"] = {name: _squeal(check) for name, check in product.squeal.items()}
    return document


def _grade(product):
    """What to make of the verdict: effects that hold "to the noise", "in part", or only "leading"; else empty."""
    if len(product.named):
        return "in part" if product.in_part else "to the noise"
    return "leading" if len(product.leading) or len(product.leading_set) else ""


def _parameter(product, k):
    stated = {"nominal": float(product.parameter_nominal[k]), "value": float(product.parameter_value[k]),
              "std": float(product.parameter_std[k]), "unit": str(product.parameter_unit[k])}
    return stated | ({"meaning": "factor on the value of the model"} if product.parameter_factor[k] else {})


def _squeal(check):
    """Saturated squeal of one run, recorded and simulated; for verification only."""
    return {str(who): {"records": int(check.records[i]), "saturated": int(check.squealing[i]), "features": {
        str(name): {"unit": str(check.unit[k]), "mean": float(check.mean[i, k]), "spread": float(check.spread[i, k])}
        | ({"agrees": bool(check.agrees[i, k])} if i and check.known[0, k] else {})
        for k, name in enumerate(check.feature) if check.known[i, k]}} for i, who in enumerate(check.who)}


def _effect(product, k, with_parameters=True):
    names = str(product.effect[k]).split(" + ")
    known = k in product.known      # it is part of every hypothesis but that nothing is missing
    entry = {"name": names[0], "place": str(product.place[k]), "kind": str(product.kind[k]),
            "posterior": float(1 - product.posterior[0] if known else product.posterior[k])}
    if product.contacts[k]:
        entry["contacts"] = str(product.contacts[k]).split(", ")
    if not product.effect[k]:
        entry["name"] = "nothing missing"
    if product.objection[k]:
        entry["objection"] = str(product.objection[k])
    if product.held_out_error[k]:
        entry["held_out_error"] = float(product.held_out_error[k])
    if with_parameters:
        entry["parameters"] = {
            split_name(str(name))[2]: {"value": float(product.parameter_value[i]),
                                       "std": float(product.parameter_std[i]), "unit": str(product.parameter_unit[i])}
            for i, name in enumerate(product.parameter) if product.parameter_owner[i] == k and split_name(str(name))[2]}
    return entry


def _not_judged(product, k):
    """A candidate that could not be fitted, such as one whose time stepping fails, with the reason."""
    return {"name": str(product.effect[k]), "place": str(product.place[k]), "reason": str(product.objection[k])}


def _location(product):
    """Members of the 95 % set of every axis that was located."""
    return {axis: [_item(located, k) for k in range(len(located.item)) if located.member[k]]
            for axis, located in product.location.items()}


def _item(located, k):
    if located.unit.item():
        return {"from": float(located.low[k]), "to": float(located.high[k]), "unit": located.unit.item()}
    return str(located.item[k])


def _fit(product, row, held_out):
    before, recalibrated, after, noise = (float(v) for v in product.fit[row])
    runs = [name for name, run in product.runs.items() if int(run.held_out) == held_out]
    entry = {"before": before, "recalibrated": recalibrated, "after": after, "noise_floor": noise, "runs": runs}
    return entry | ({"with_latent_force": _with_force(product)} if held_out and product.latent_predicted else {})


def _with_force(product):
    """What the recalibrated nominal model leaves of the held-out runs with the latent force."""
    by_run = {name: float(prediction.error) for name, prediction in product.latent_predicted.items()}
    return {"label": LABEL, "value": float(np.sqrt(np.mean(np.square(list(by_run.values()))))), "by_run": by_run,
            "place": product.latent_place.item(),
            "force": [{"term": str(term), "value": float(value), "unit": str(unit)} for term, value, unit in zip(
                product.latent_term, product.latent_coefficient, product.latent_unit, strict=True)]}

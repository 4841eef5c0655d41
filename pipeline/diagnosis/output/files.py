"""What a diagnosis writes beside its HDF5: diagnosis.json, the latent force as CSV, and the completed case."""

import copy
import json

import numpy as np

from pipeline.case_models.effect_block import written
from pipeline.contract import documents as yaml
from pipeline.diagnosis.problem import split_name
from pipeline.diagnosis.signals.forward_model import NAMES
from pipeline.diagnosis.signals.latent_force_law import LABEL

SCHEMA = "brakechain-diagnosis/1"
#: hypotheses that are listed beside those named
ALTERNATIVES = 5


def companions(product, case):
    """{file name: text}: diagnosis.json, latent_force.csv where a force was found, the case where it is completed."""
    found = {"diagnosis.json": json.dumps(as_json(product), indent=2, ensure_ascii=False) + "\n"}
    if product.latent:
        found["latent_force.csv"] = latent_csv(product)
    if case is not None and _completable(case) and (name := completed_name(product, case.name)):
        found[name] = yaml.yaml_text(completed(product, case))
    return found


def _completable(case):
    """Lists of lines name alternatives to numbers of others, which no case can run."""
    return (case.document.get("diagnosis") or {}).get("forward") != "lines"


def latent_csv(product):
    """The latent force of every run as CSV; its head says that it is a description, not identified physics."""
    rows = [f"# {product.latent_sentence.item()}", "run,time_s,force_N,std_N,displacement_m,velocity_m_per_s"]
    for name, one in product.latent.items():
        columns = (one.time, one.force, one.std, one.displacement, one.velocity)
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
        effect, place, parameter = split_name(str(name))
        value = {"value": _written(product, k), "origin": "inferred",
                 "source": f"diagnosis of {case.name}, +- {product.parameter_std[k]:.2g}"}
        if not parameter:
            corrections[str(name)] = value
        else:
            effects.setdefault(effect, {}).setdefault(place, {})[parameter] = value
    if (document.get("diagnosis") or {}).get("forward") == "friction":
        _correct_rubbing(document, corrections)
    else:
        bench = document.setdefault("bench", {})
        bench["corrections"] = {**(bench.get("corrections") or {}), **corrections}
    own = document["effects"] = document.get("effects") or {}
    for effect, places in effects.items():
        own[effect] = {**own.get(effect, {}), **places}
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
    told = {
        "schema": SCHEMA, "verdict": product.verdict.item(), "reasons": [str(r) for r in product.reason],
        "effects": [_effect(product, k) for k in (*product.known, *product.named)],
        "alternatives": [_effect(product, k, False) for k in ordered if k not in named][:ALTERNATIVES],
        "location": _location(product),
        "parameters": {str(name): {"nominal": float(product.parameter_nominal[k]),
                                   "value": float(product.parameter_value[k]),
                                   "std": float(product.parameter_std[k]), "unit": str(product.parameter_unit[k])}
                       for k, name in enumerate(product.parameter) if not split_name(str(name))[2]},
        "fit": {part: _fit(product, row, held_out) for row, (part, held_out) in enumerate(
            (("training", 0), ("held_out", 1)))},
        "unexplained_share": float(product.unexplained_share),
        "next_experiment": {"conditions": [str(c) for c in product.next_condition],
                            "separates": [str(s) for s in product.next_separates], "value": float(product.next_value)},
    }
    if product.squeal:
        told["saturated_squeal"] = {name: _squeal(one) for name, one in product.squeal.items()}
    return told


def _squeal(one):
    """Saturated squeal of one run, recorded and simulated; for verification only."""
    return {str(who): {"records": int(one.records[i]), "saturated": int(one.squealing[i]), "features": {
        str(name): {"unit": str(one.unit[k]), "mean": float(one.mean[i, k]), "spread": float(one.spread[i, k])}
        | ({"agrees": bool(one.agrees[i, k])} if i and one.known[0, k] else {})
        for k, name in enumerate(one.feature) if one.known[i, k]}} for i, who in enumerate(one.who)}


def _effect(product, k, with_parameters=True):
    names = str(product.effect[k]).split(" + ")
    known = k in product.known      # it is part of every hypothesis but that nothing is missing
    told = {"name": names[0], "place": str(product.place[k]), "kind": str(product.kind[k]),
            "posterior": float(1 - product.posterior[0] if known else product.posterior[k])}
    if not product.effect[k]:
        told["name"] = "nothing missing"
    if with_parameters:
        told["parameters"] = {
            split_name(str(name))[2]: {"value": float(product.parameter_value[i]),
                                       "std": float(product.parameter_std[i]), "unit": str(product.parameter_unit[i])}
            for i, name in enumerate(product.parameter) if product.parameter_owner[i] == k and split_name(str(name))[2]}
    return told


def _location(product):
    """Members of the 95 % set of every axis that was located."""
    return {axis: [_item(found, k) for k in range(len(found.item)) if found.member[k]]
            for axis, found in product.location.items()}


def _item(found, k):
    if found.unit.item():
        return {"from": float(found.low[k]), "to": float(found.high[k]), "unit": found.unit.item()}
    return str(found.item[k])


def _fit(product, row, held_out):
    before, recalibrated, after, noise = (float(v) for v in product.fit[row])
    runs = [name for name, run in product.runs.items() if int(run.held_out) == held_out]
    told = {"before": before, "recalibrated": recalibrated, "after": after, "noise_floor": noise, "runs": runs}
    return told | ({"with_latent_force": _with_force(product)} if held_out and product.latent_predicted else {})


def _with_force(product):
    """What the recalibrated nominal model leaves of the held-out runs with the latent force."""
    by_run = {name: float(one.error) for name, one in product.latent_predicted.items()}
    return {"label": LABEL, "value": float(np.sqrt(np.mean(np.square(list(by_run.values()))))), "by_run": by_run,
            "place": product.latent_place.item(),
            "force": [{"term": str(term), "value": float(value), "unit": str(unit)} for term, value, unit in zip(
                product.latent_term, product.latent_coefficient, product.latent_unit, strict=True)]}

"""The case that a modal test completes: its values as measured, and a brake with them."""

import copy

import numpy as np

from pipeline.case_models.bodies.declared_values import named
from pipeline.contract import documents as yaml

#: sections of the brake that hold its bodies and joints: those of ``structure`` under the same names
STRUCTURE = ("disc", "pad", "caliper", "bracket", "piston", "joints")
#: share of measured modes with a pair beyond doubt that must be exceeded for values to be handed on
_ENOUGH = 0.5


def completed(product, case):
    """The case with the values that the test asks for, with their standard deviations, and a brake with them.

    Nothing where no more than half of the measured modes have a pair beyond doubt: it may be of something else.
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

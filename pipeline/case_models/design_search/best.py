"""The best design of a search: as one more countermeasure, and as a piece of YAML."""

import json

from pipeline.case_models.countermeasures.declared import Variant, costs
from pipeline.case_models.design_search.declared import columns
from pipeline.contract import ConfigError
from pipeline.contract.documents import parse_value, yaml_text

#: its name among the countermeasures
BEST = "best_design"


def best_changes(product):
    """{'stage.key': value} of the best design; empty where no brake is better than the case."""
    if product.best <= 0:
        return {}
    return {str(name): parse_value(str(written)) for name, written, own in
            zip(product.parameter, product.written[int(product.best)], product.case_value, strict=True)
            if str(written) != str(own)}


def as_text(value):
    """A value of a case as text that YAML reads back."""
    return str(value) if isinstance(value, str) else json.dumps(value, default=str)


def fragment(product, name):
    """The best design as YAML for a case that is based on the case called ``name``."""
    document = {}
    for key, value in best_changes(product).items():
        node, *steps = document, *key.split(".")
        for step in steps[:-1]:
            node = node.setdefault(step, {})
        node[steps[-1]] = {"value": value, "origin": "tuned", "source": f"design_search of {name}"}
    best = int(product.best)
    return (f"# Best of {int(product.computed)} brakes that design_search tried: objective"
            f" {product.objective[best]:.4g} 1/s, {product.objective[0]:.4g} 1/s in {name}.\n"
            f"# Paste it into a case, or write 'based_on: {name}.yaml' above it.\n{yaml_text(document)}")


def searched(product):
    """{BEST: Variant} of a product DesignSearch or None; empty where nothing better than the case was found."""
    changed = {} if product is None else best_changes(product)
    if not changed:
        return {}
    cost = {str(name): f"{value:.4g} {unit}".strip() for name, unit, value in
            zip(product.cost_name, product.cost_unit, product.best_cost, strict=True)}
    return {BEST: Variant(change=changed, cost=cost, note=f"best of {int(product.computed)} brakes of a search")}


def check_beside(sections):
    """ConfigError where declared variants leave the best design of a search no name, or no unit of a cost."""
    search, variants = sections.get("design_search"), sections["countermeasures"].variants
    if search is None or not search.space:
        return
    if BEST in variants:
        raise ConfigError(f"countermeasures.variants.{BEST}", "another name", repr(BEST),
                          "the best design of design_search is called so")
    costs({**variants, BEST: Variant(cost={name: f"0 {unit}" for name, (unit, _) in columns(search).items()})})

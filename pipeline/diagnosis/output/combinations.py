"""Combinations of effects that a diagnosis tried together, as fields of its product and for machines."""

#: of a combination that was not refitted: another one is as probable or more, or does without a member of it
NOT_REFITTED = "not refitted: its evidence did not ask for it"


def combinations(diagnosis):
    """Fields of the product Diagnosis over the Combinations of the inference's one."""
    tried = diagnosis.combinations
    return {"combination": [" + ".join(c.effects) for c in tried], "combination_gain": [c.gain for c in tried],
            "combination_refitted": [int(c.objective is not None) for c in tried],
            "combination_objective": [c.objective or 0.0 for c in tried],
            "combination_held_out": [c.held_out or 0.0 for c in tried],
            "combination_left": [c.left or 0.0 for c in tried],
            "combination_values": ["; ".join(map(_value, c.values)) for c in tried],
            "combination_outcome": [c.outcome or NOT_REFITTED for c in tried]}


def _value(of):
    name, value, unit = of
    return f"{name.replace('@', ' at ')} {value:.4g}{'' if unit == '1' else f' {unit}'}"


def as_rows(product):
    """[{...}] of the combinations in a product Diagnosis, for diagnosis.json."""
    return [_row(product, k) for k in range(len(product.combination))]


def _row(product, k):
    refitted, held_out = product.combination_refitted[k], float(product.combination_held_out[k])
    return {"effects": str(product.combination[k]).split(" + "), "evidence_gain": float(product.combination_gain[k]),
            "objective": float(product.combination_objective[k]) if refitted else None,
            "held_out_error": held_out or None,
            "leaves": float(product.combination_left[k]) if refitted else None,
            "values": str(product.combination_values[k]), "outcome": str(product.combination_outcome[k])}

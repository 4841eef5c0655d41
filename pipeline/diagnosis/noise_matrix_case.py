"""The case that asks why a bench squeals otherwise than a noise matrix predicts: hypotheses weighed on its drags.

All drags that are conditions of the schedule take part, not only those that differ: silence is evidence too.
"""

import copy

import numpy as np

from pipeline.contract import documents as yaml

#: section that describes the brake -> chain that weighs hypotheses on records, and the setting with its pressures
_CHAINS = {"structure": ("disc_squeal_records", "pressures"), "lumped": ("lumped_squeal_records", "load_factors")}
#: settings of noise_matrix that line_evidence has as well
_SHARED = ("sources", "pressure_factor", "seed")


def companions(product, case):
    """{file name: text} of the case; none where nothing differs, or no drag was recorded."""
    drags = asked(product)
    apart = product.condition_difference.any() or product.band_difference.any() or product.all_difference
    if case is None or not apart or not len(drags):
        return {}
    return {f"{case.name}_why.yaml": yaml.yaml_text(document(product, case.document, case.name))}


def asked(product):
    """Indices (r,) of the runs that are drags of the schedule."""
    matched = np.flatnonzero(product.run_condition >= 0)
    return matched[product.kind[product.run_condition[matched]] == "drag"]


def document(product, stated, name):
    """The document of the case for a product NoiseMatrix of the case ``stated``, called ``name``."""
    made = {key: copy.deepcopy(part) for key, part in stated.items() if key not in ("noise_matrix", "comparison")}
    kind = next(kind for kind in _CHAINS if kind in made)
    chain, pressures = _CHAINS[kind]
    drags, given = asked(product), stated.get("noise_matrix", {})
    loads = np.unique(product.pad_pressure[product.run_condition[drags]])
    made["chain"] = chain
    made["title"] = f"{stated.get('title', name)}: why does the bench differ?"
    made["description"] = f"Hypotheses weighed on the recorded drags of the noise matrix of {name}."
    made[kind] = {**made[kind], pressures: [f"{float(p)!r} Pa" for p in loads]}
    made["line_evidence"] = {
        "runs": [str(run) for run in product.run[drags]], "pressure_within": 0.2,
        "low": f"{float(product.limits[0])!r} Hz", "high": f"{float(product.limits[1])!r} Hz",
        **{key: given[key] for key in _SHARED if key in given}}
    return made

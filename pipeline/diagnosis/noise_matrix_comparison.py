"""Predicted and measured occurrence of squeal: under which conditions and in which bands do they differ?

One family of tests: every condition with recorded stops, every band in which either is noisy, and all stops together.
Each asks whether so many noisy stops of one brake are likely where brakes scatter as declared (``occurrence_rates``);
Holm's p-values pay for their number.
"""

import numpy as np

from pipeline.inference.search.localisation import holm
from pipeline.physics.stability.occurrence_rates import rate

#: product fields of what is compared, by their dimension
GROUPS = ("condition", "band", "all")


def comparison(noisy, stops, heard, level):
    """Fields of the comparison of draws ``noisy`` (brakes, repeats, c, b) with the bench.

    ``stops`` (c,): recorded stops of each condition; ``heard`` (c, b + 1): those of them that squeal in each band, and
    in any. ``level``: family-wise level of a difference.
    """
    bands = noisy.shape[3]
    anywhere = np.concatenate([noisy, noisy.any(axis=3, keepdims=True)], axis=3)
    total = int(stops.sum())
    weight = stops / total if total else np.zeros(len(stops))
    shares = np.tensordot(anywhere, weight, (2, 0))                         # (brakes, repeats, b + 1)
    tests = {"condition": [(rate(anywhere[:, :, k, bands]), int(stops[k]), int(heard[k, bands]))
                           for k in range(len(stops))],
             "band": [(rate(shares[:, :, b]), total, int(heard[:, b].sum())) for b in range(bands)],
             "all": [(rate(shares[:, :, bands]), total, int(heard[:, bands].sum()))]}
    flat = [(name, k, *test) for name in GROUPS for k, test in enumerate(tests[name]) if _asked(name, *test)]
    corrected = dict(zip([f[:2] for f in flat], holm(np.array([r.p_value(h, n) for *_, r, n, h in flat])),
                         strict=True)) if flat else {}
    fields = {"tests": len(flat)}
    for name in GROUPS:
        rows = [_row(*test, corrected.get((name, k)), len(flat), level) for k, test in enumerate(tests[name])]
        for column, values in zip(("expected", "p_value", "least_p", "difference"), zip(*rows, strict=True),
                                  strict=True):
            fields[f"{name}_{column}"] = values[0] if name == "all" else np.array(values)
    return fields


def _asked(name, predicted, stops, heard):
    """Whether a test is made: of bands only where either is noisy."""
    return stops > 0 and (name != "band" or predicted.share > 0 or heard > 0)


def _row(predicted, stops, heard, p_value, tests, level):
    """(expected noisy stops, family-wise p-value, the smallest one possible, 1 too much, -1 too little, 0 neither)."""
    if p_value is None:
        return predicted.share * stops, 1.0, 1.0, 0
    sign = 0 if p_value > level else int(np.sign(predicted.share * stops - heard))
    return predicted.share * stops, float(p_value), min(1.0, tests * predicted.least(stops)), sign

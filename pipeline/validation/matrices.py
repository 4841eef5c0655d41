"""Our numbers for systems of matrices: unstable modes at each speed, by frequency."""

import numpy as np

from pipeline.validation import ours

#: fact key or pattern -> product field
FIELDS = {"turns_*": "matrix_modes.roots.unstable_root"}
TWO_PI = 2.0 * np.pi
#: a speed is that of a fact when both agree to this
_SAME = 1e-6


def matrix_rows(products, facts, known):
    """Rows of ``products`` (name -> product or None): turns_N_frequency_K, turns_N_growth_K and turns_N_unstable."""
    modes = products.get("matrix_modes")
    if modes is None:
        return {}
    rows = {}
    for number, speed in enumerate(modes.roots.speed):
        turns = speed / TWO_PI
        if abs(turns - round(turns)) > _SAME * turns:
            continue
        roots = modes.roots.unstable_root[modes.roots.unstable_operating == number]
        rows[f"turns_{turns:.0f}_unstable"] = ours(len(roots), "all roots near the imaginary axis")
        for k, root in enumerate(roots[np.argsort(roots.imag)], 1):
            rows[f"turns_{turns:.0f}_frequency_{k}"] = ours(root.imag / TWO_PI, "without reduction")
            rows[f"turns_{turns:.0f}_growth_{k}"] = ours(root.real, "without reduction")
    return rows

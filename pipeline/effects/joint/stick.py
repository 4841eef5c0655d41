"""The elastic way before dry friction of a joint slides: as short as the step of a bench allows."""

import numpy as np

#: squared steps times stiffness over mass: a quarter of the limit at which a step is refused, 0.1 x 6
_SHARE = 0.15


def stick_stiffness(bench, row):
    """Stiffness in N/m along ``row`` (n,) that the step of the bench resolves; the mass is that felt along the row."""
    mobility = row @ np.linalg.solve(bench.model.mass, row)
    return _SHARE / (mobility * bench.step**2)

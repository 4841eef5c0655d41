"""Motion of the centre of gravity of a reduced body, in the axes of its contact."""

import numpy as np

from pipeline.contract.errors import ConfigError

#: largest error with which a rigid translation may be represented, relative (surface shapes are single precision)
REPRESENTATION = 1e-3


def gravity_rows(mass, recovery, directions):
    """(3, n) rows: displacement of the centre of gravity of one body along ``directions`` (3, 3), row by row.

    ``mass`` (n, n) is the reduced mass matrix and ``recovery`` (visible, 3, n) gives the displacement of its surface.
    A rigid translation e has the coordinates r with recovery r = e, and the centre of gravity moves by
    r^T M q / (r^T M r). Raises ConfigError if the coordinates do not contain rigid translations.
    """
    surface = recovery.reshape(-1, recovery.shape[-1]).astype(float)
    rows = []
    for direction in np.asarray(directions, dtype=float):
        wanted = np.tile(direction, len(recovery))
        rigid = np.linalg.lstsq(surface, wanted, rcond=1e-6)[0]
        error = np.linalg.norm(surface @ rigid - wanted) / np.linalg.norm(wanted)
        if not error < REPRESENTATION:
            raise ConfigError("pad motion", "reduced coordinates that contain rigid translations of the pad",
                              f"an error of {error:.3g}", "keep rigid motions in the reduction")
        rows.append(rigid @ mass / (rigid @ mass @ rigid))
    return np.array(rows)


def sliding_axes(position):
    """(3, 3) unit vectors along sliding, axial and radial at the mean angle of ``position`` (c, 3)."""
    x, y, _ = np.mean(position, axis=0)
    radius = np.hypot(x, y)
    return np.array([[-y / radius, x / radius, 0.0], [0.0, 0.0, 1.0], [x / radius, y / radius, 0.0]])

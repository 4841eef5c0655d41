"""Mean depth worn off a face, from height maps of one place before and after.

An instrument shows heights but for tilt and offset. Where both faces lay deep together nothing was touched: the change
there is a plane, and no wear.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: share of the face, the deepest, that counts as untouched
UNTOUCHED = 0.3
#: rms change of untouched nodes over the rms height of the face from which on both maps show different areas; of
#: unrelated maps of one roughness it is about 1.1, of a face worn flat 0.5
UNRELATED = 0.75


def worn_depth(new, worn, against=None, stroke=0):
    """(mean depth, its standard error) in m of two height maps (ny, nx) in m of the same nodes, outwards.

    ``against``: the new face that passes over it, as mounted (outwards of its own body), up to ``stroke`` nodes along x
    to either side; without it the deepest nodes of the face itself count as untouched, some of which may be worn. The
    error is that of the pixels' noise, by what is left about the plane of the untouched nodes. Raises ConfigError for
    maps of other shapes, and for maps that do not overlap: what was not touched must be the same in both.
    """
    if new.shape != worn.shape:
        raise ConfigError("worn topography", f"a map of {new.shape} nodes, as the new one", str(worn.shape),
                          "record both with the same pixels")
    height = without_plane(new)
    if against is not None:
        height = height + scipy.ndimage.maximum_filter1d(without_plane(against), 2 * stroke + 1, axis=1, mode="wrap")
    deep = height < np.quantile(height, UNTOUCHED)
    left = without_plane(new - worn, deep)
    if left[deep].std() > UNRELATED * without_plane(new).std():
        raise ConfigError("worn topography", "untouched depths that both maps show alike",
                          f"a difference of {left[deep].std():.3g} m rms, as of maps that do not overlap",
                          "record the same area before and after, or align the maps")
    basis = _planes(new.shape)
    weight = np.full(new.shape, 1 / new.size)       # of every node in the mean, the plane through some of them included
    weight[deep] -= basis[deep] @ np.linalg.solve(basis[deep].T @ basis[deep], basis.mean(axis=(0, 1)))
    return float(left.mean()), float(left[deep].std(ddof=3) * np.sqrt(np.sum(weight**2)))


def without_plane(heights, nodes=None):
    """Heights (ny, nx) less the plane of least squares through ``nodes`` (a mask; default all)."""
    basis = _planes(heights.shape)
    kept = np.ones(heights.shape, bool) if nodes is None else nodes
    plane, *_ = np.linalg.lstsq(basis[kept], heights[kept], rcond=None)
    return heights - basis @ plane


def _planes(shape):
    """Offset and both tilts (ny, nx, 3) of a map."""
    grids = np.meshgrid(*(np.linspace(-0.5, 0.5, n) for n in shape), indexing="ij")
    return np.stack([np.ones(shape), *grids], axis=-1)

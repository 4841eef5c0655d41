"""Where the elements of a lining are particles: spheres at random, or a segmented image of the surface."""

import numpy as np

from pipeline.contract.errors import ConfigError

#: most particles that are placed
_MOST = 200_000


def spheres(shape, spacing, depth, share, diameter, seed):
    """True (layers, ny, nx) for elements inside spheres of one ``diameter`` in m, which fill a ``share`` of the volume.

    Their centres are a Poisson process over the periodic patch and the depth (the Boolean model: spheres may overlap,
    share = 1 - exp(-number volume); Chiu et al., Stochastic Geometry, 2013, chapter 3). ``shape`` (ny, nx), ``spacing``
    (dy, dx) and boundaries ``depth`` (layers + 1,) as of ``layered_compliance``. An element is what its centre is in.
    ConfigError for spheres smaller than an element of the surface.
    """
    if diameter < 2 * max(spacing):
        raise ConfigError("inclusions: size", f"at least two nodes, {2 * max(spacing):.3g} m", f"{diameter:.3g} m",
                          "state larger particles, or more nodes")
    random, radius = np.random.default_rng(seed), 0.5 * diameter
    edges = np.array(shape) * spacing
    volume = edges.prod() * (depth[-1] + diameter)
    mean = -np.log1p(-share) * volume / (np.pi * diameter**3 / 6)
    if mean > _MOST:
        raise ConfigError("inclusions", f"at most {_MOST} particles", f"{mean:.3g}", "state larger ones, or fewer")
    place = random.uniform((-radius, 0.0, 0.0), (depth[-1] + radius, *edges), (random.poisson(mean), 3))
    middle = 0.5 * (depth[1:] + depth[:-1])
    inside = np.zeros((len(middle), *shape), bool)
    y, x = ((np.arange(n) + 0.5) * d for n, d in zip(shape, spacing, strict=True))
    for z0, y0, x0 in place:
        for layer in np.flatnonzero(abs(middle - z0) < radius):
            reach = radius**2 - (middle[layer] - z0) ** 2
            off = _periodic(y - y0, edges[0])[:, None] ** 2 + _periodic(x - x0, edges[1]) ** 2
            inside[layer] |= off < reach
    return inside


def _periodic(distance, period):
    return distance - period * np.round(distance / period)


def of_image(image, shape, layers, deep):
    """True (layers, ny, nx) for elements of particles: those that are bright, above half of the range, in an ``image``
    (ky, kx) of the surface, down to the layer number ``deep``; it is stretched over the patch."""
    grey = np.asarray(image, float)
    if grey.ndim != 2 or not np.isfinite(grey).all() or np.ptp(grey) == 0:
        raise ConfigError("inclusions: image", "grey values of two phases, (ny, nx)", f"shape {grey.shape}, range"
                          f" {np.ptp(grey) if grey.size else 0:g}", "segment it: particles bright, resin dark")
    rows, columns = ((np.arange(n) * k) // n for n, k in zip(shape, grey.shape, strict=True))
    bright = grey[np.ix_(rows, columns)] > 0.5 * (grey.min() + grey.max())
    inside = np.zeros((layers, *shape), bool)
    inside[:deep] = bright
    return inside

"""Square patches of a scan: where they lie, and how they are made periodic. Maps are (ny, nx), spacing is (dy, dx)."""

from itertools import product

import numpy as np

from pipeline.contract.errors import ConfigError

#: share of its length over which a patch of a scan fades into what follows beyond it
OVERLAP = 0.1


def crops(shape, spacing, length, count, where):
    """Places [(y, x)] of ``count`` patches of ``length`` m side by side in a scan; of a single one, the middle.

    Each is where the patch begins over where it may begin, from 0 to 1. ConfigError at ``where`` for more patches than
    there is room for.
    """
    rows, columns = (1, 1) if count == 1 else (
        int(n * d / (length * (1 + OVERLAP))) for n, d in zip(shape, spacing, strict=True))
    if count > max(rows * columns, 1):
        raise ConfigError(where, f"at most {max(rows * columns, 1)}, as many patches of {length:.3g} m as lie side by"
                          " side in the scan", str(count), "lower surface.pairs, or shorten patch_length")
    return list(product(*([0.5] if n == 1 else np.arange(n) / (n - 1) for n in (rows, columns))))[:count]


def window(shape, spacing, length, overlap=OVERLAP, place=(0.5, 0.5)):
    """(first sample, samples of the patch, samples beyond it) of a patch along y and x, see ``periodic_patch``."""
    counts = []
    for axis in (0, 1):
        kept = round(length / spacing[axis])
        margin = round(overlap * kept)
        if kept + margin > shape[axis]:
            raise ConfigError("surface patch", f"at most {shape[axis] * spacing[axis] / (1 + overlap):.4g} m",
                              f"{length:.4g} m", "shorten patch_length or take a larger scan")
        counts.append((int(place[axis] * (shape[axis] - kept - margin)), kept, margin))
    return counts


def periodic_patch(heights, spacing, length, overlap=OVERLAP, place=(0.5, 0.5)):
    """Square patch of ``length`` m made periodic: its margins fade into what follows beyond the patch.

    ``overlap`` is the faded share of the length; weights keep the variance of uncorrelated margins. ``place`` (y, x):
    where it begins over where it may begin. Returns a map on the pixels of the scan. Raises ConfigError when the scan
    is smaller than length * (1 + overlap).
    """
    for axis, (start, kept, margin) in enumerate(window(heights.shape, spacing, length, overlap, place)):
        body, beyond = np.split(np.moveaxis(heights, axis, 0)[start:start + kept + margin], [kept])
        angle = (np.pi / 2.0 * (np.arange(margin) + 0.5) / max(margin, 1))[:, None]
        faded = np.sin(angle) * body[:margin] + np.cos(angle) * beyond
        heights = np.moveaxis(np.concatenate([faded, body[margin:]]), 0, axis)
    return heights

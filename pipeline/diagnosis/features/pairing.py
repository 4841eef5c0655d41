"""Which eigenvalue of a model a recorded pole belongs to, and what of their distance counts."""

import numpy as np
import scipy

from pipeline.diagnosis.rules import DEFAULTS
from pipeline.physics.signals.pole_identification import likeness


def assigned(seen, root, shape, rules=DEFAULTS.poles):
    """Index (p,) of the root (r,) that explains each of the Poles ``seen``, by distance and shape.

    Each root explains one; a peak that none is left for, as where the model lacks a mode, falls to the likeliest.
    Eigenvalues that cross on the way to their peaks are paired by mode shape; a distance of several times the prior
    error counts less and less, so that a peak that is no mode does not move all others by one.
    """
    apart = abs(np.subtract.outer(seen.root, root)) / (rules.near * abs(seen.root))[:, None]
    cost = apart / np.sqrt(1 + (apart / rules.far) ** 2) + 1 - likeness(seen.shape, shape)
    index = cost.argmin(axis=1)
    peaks, roots = scipy.optimize.linear_sum_assignment(cost)
    index[peaks] = roots
    return index


def merged(seen, root, index, resolved):
    """What (p,) the roots of these indices (p,) of peaks ``seen`` look like beside those that no peak is left for.

    Two roots that a record cannot tell apart show as one peak between them: it is taken to lie where it was seen.
    """
    merged_roots, rest = root[index], np.delete(root, index)
    for k, (peak, first) in enumerate(zip(seen, root[index], strict=True)):
        toward = rest[abs(rest - first) < resolved] - first
        share = np.clip(np.real((peak - first) * toward.conj()) / np.maximum(abs(toward) ** 2, 1e-300), 0, 1)
        between = np.append(first, first + share * toward)
        merged_roots[k] = between[np.argmin(abs(between - peak))]
    return merged_roots


def nearer(seen, root, rules=DEFAULTS.poles):
    """Roots (p,) drawn towards those ``seen``: as they are where close, never farther than ``reach`` of one.

    A peak that the model does not have is far from any root; how far says nothing.
    """
    apart = root - seen
    return seen + apart / np.sqrt(1 + abs(apart / (rules.reach * seen)) ** 2)

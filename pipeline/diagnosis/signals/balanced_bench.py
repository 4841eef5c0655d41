"""The bench of a balance of forces: it steps nothing, so that neither a step nor masses that it lacks are asked for.

Sizes of priors come from nominal runs, which are simulated. Their step is the interval of the samples, or shorter
where modes ask for it; a coordinate without a mass, or with next to none, has one that is too small to be felt: it
vibrates ``_FASTER`` times as fast as it is sampled.
"""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.case_models.effect_block import with_bare

#: rate of the vibration of a coordinate without a mass, over the rate of its samples
_FASTER = 10.0
#: share of a damping's force that inertia may have at that rate
_DAMPED = 0.01
#: steps in a period of the highest mode
_STEPS = 4.0


def balanced_bench(bench, recorded):
    """The Bench for the balances of {name: Recorded}."""
    rate = max(record.run.sample_rate for record in recorded.values())
    return with_bare(bench, lambda each: _balanced(each, rate))


def _balanced(bench, rate):
    model = _with_masses(bench.model, 2 * np.pi * _FASTER * rate)
    mass, _, stiffness = model.supported()
    highest = np.sqrt(max(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)[-1], 0.0)) / (2 * np.pi)
    return replace(bench, model=model, step=1 / max(rate, _STEPS * highest))


def _with_masses(model, fastest):
    """The model whose coordinates vibrate at ``fastest`` rad/s at most: those without a mass, or with next to none,
    have the mass for it."""
    _, damping, stiffness = model.supported()
    carried = np.abs(np.diag(stiffness)) + _DAMPED * fastest * np.abs(np.diag(damping))
    carried = np.where(carried > 0, carried, carried.max() or 1.0)
    lacking = np.maximum(carried / fastest**2 - np.diag(model.mass), 0.0)
    return replace(model, mass=model.mass + np.diag(lacking)) if lacking.any() else model

"""Before the bench: which recordings will be able to name which effect, and the cheapest set that names all wanted.

The power of records over an effect of given size is d = sqrt(g'C^-1 g): the whitened change g that it makes, less what
the nominal parameters hide within their priors, C = I + J J'. Its square adds over records that share no parameter.
"""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.inference.fitting.fit_state import orthogonal


def power(direction, jacobian):
    """d = sqrt(g'C^-1 g) of a whitened effect ``direction`` (m,): what of it no parameter hides; about 4 names it."""
    return float(np.sqrt(max(direction @ orthogonal(direction, jacobian), 0.0)))


def power_table(directions, jacobians):
    """d (record, effect) of each record alone: ``directions`` [[(m,) per effect]], ``jacobians`` [(m, k)]."""
    return np.array([[power(g, j) for g in row] for row, j in zip(directions, jacobians, strict=True)])


def combined_power(directions, jacobians, chosen):
    """d (effect,) of the ``chosen`` records (indices) together, which share their nominal parameters."""
    if not len(chosen):
        return np.zeros(len(directions[0]))
    jacobian = np.concatenate([jacobians[i] for i in chosen])
    return np.array([power(np.concatenate([directions[i][e] for i in chosen]), jacobian)
                     for e in range(len(directions[0]))])


def cheapest(directions, jacobians, cost, wanted, needed=4.0):
    """Indices of records that together name every effect of ``wanted`` (d at least ``needed``), greedily by cost.

    Each step takes the record that gains most of the missing power per cost; records that turned out to be idle are
    dropped at the end. Raises ConfigError naming the effects that all records together cannot name.
    """
    reachable = combined_power(directions, jacobians, range(len(cost)))[wanted]
    if (reachable < needed).any():
        lacking = [int(w) for w, d in zip(wanted, reachable, strict=True) if d < needed]
        raise ConfigError("plan", f"records that can name effects {lacking}",
                          f"d of at most {reachable.min():.2g} where {needed:g} is needed", "add records or sensors")
    chosen = []
    while not _covered(directions, jacobians, chosen, wanted, needed):
        rest = [i for i in range(len(cost)) if i not in chosen]
        chosen.append(max(rest, key=lambda i: _step_value(directions, jacobians, chosen, i, wanted, needed) / cost[i]))
    for i in sorted(chosen, key=lambda i: -cost[i]):
        fewer = [c for c in chosen if c != i]
        chosen = fewer if _covered(directions, jacobians, fewer, wanted, needed) else chosen
    return tuple(sorted(chosen))


def _covered(directions, jacobians, chosen, wanted, needed):
    return bool((combined_power(directions, jacobians, chosen)[wanted] >= needed).all())


def _step_value(directions, jacobians, chosen, index, wanted, needed):
    before = np.minimum(combined_power(directions, jacobians, chosen)[wanted], needed) ** 2
    after = np.minimum(combined_power(directions, jacobians, [*chosen, index])[wanted], needed) ** 2
    return float((after - before).sum())

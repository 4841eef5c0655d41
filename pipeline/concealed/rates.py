"""Rates of a trial with their intervals."""

import math


def wilson(hits, count, z=1.96):
    """(low, high) of a rate: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209."""
    if not count:
        return 0.0, 1.0
    rate, spread = hits / count, z**2 / count
    centre, half = rate + spread / 2, z * math.sqrt(rate * (1 - rate) / count + spread / (4 * count))
    return max(0.0, (centre - half) / (1 + spread)), min(1.0, (centre + half) / (1 + spread))


def line(name, hits):
    """One line of a table: ``hits`` [bool] of so many, as a rate with its 95 % interval."""
    low, high = wilson(sum(hits), len(hits))
    return f"{name:<38} {sum(hits):>4} of {len(hits):<4} {sum(hits) / len(hits):>6.1%}   95 %: {low:.1%} to {high:.1%}"

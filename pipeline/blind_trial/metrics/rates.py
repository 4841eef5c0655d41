"""Rates of a trial with their intervals, and how far stated probabilities hold."""

import scipy

#: edges of the bins of stated probabilities
EDGES = (0.0, 0.5, 0.85, 0.95, 0.99, 1.0)


def rate(hits):
    """{hits, count, low, high} of [bool], with its 95 % interval (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209)."""
    successes, count = sum(map(bool, hits)), len(hits)
    low, high = 0.0, 1.0
    if count:
        low, high = map(float, scipy.stats.binomtest(successes, count).proportion_ci(0.95, "wilson"))
    return {"hits": successes, "count": count, "low": low, "high": high}


def line(name, numbers):
    """One line of a table of a ``rate``."""
    return (f"{name:<53} {numbers['hits']:>4} of {numbers['count']:<4} {numbers['hits'] / numbers['count']:>6.1%}"
            f"   95 %: {numbers['low']:.1%} to {numbers['high']:.1%}")


def calibration(claims):
    """{brier, bins} of [(stated probability, whether it is so)]; bins with their mean probability and their rate.

    Brier score: mean (p - outcome)^2, G. W. Brier, Mon. Weather Rev. 78 (1950) 1.
    """
    if not claims:
        return {"count": 0}
    bins = []
    for low, high in zip(EDGES[:-1], EDGES[1:], strict=True):
        members = [(p, so) for p, so in claims if low <= p < high or p == high == EDGES[-1]]
        if members:
            bins.append({"low": low, "high": high, "stated": sum(p for p, _ in members) / len(members),
                         "so": rate([so for _, so in members])})
    return {"count": len(claims), "brier": sum((p - so) ** 2 for p, so in claims) / len(claims), "bins": bins}

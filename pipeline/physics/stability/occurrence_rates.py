"""Share of noisy stops over brakes that scatter, and whether the stops of one brake differ from it by more than chance.

Of B brakes with R stops each, y_br in [0, 1] is whether a stop is noisy, or the noisy share of several. One way ANOVA
splits its variance into that between brakes and that between stops of a brake; rho, the correlation between two stops
of one brake, is the part of the former. The noisy stops of another brake are beta-binomial: its own share is Beta
distributed about the mean p with the variance rho p (1 - p), to which the error of p adds.
"""

from dataclasses import dataclass

import numpy as np
import scipy

_NORMAL_95 = 1.959963984540054
#: largest correlation of a Beta distribution that is still computed
_MOST = 0.999


@dataclass(frozen=True)
class Rate:
    """``share`` of noisy stops, ``correlation`` of two stops of one brake, ``effective`` number of independent draws
    that the share is worth."""

    share: float
    correlation: float
    effective: float

    def interval(self):
        """(low, high): 95 % Wilson interval of the share (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209)."""
        if not self.effective:
            return 0.0, 1.0
        p, n, z = self.share, self.effective, _NORMAL_95
        middle = (p + z**2 / (2 * n)) / (1 + z**2 / n)
        half = z / (1 + z**2 / n) * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
        low, high = float(middle - half), float(middle + half)
        return (0.0 if p == 0 else max(low, 0.0)), (1.0 if p == 1 else min(high, 1.0))

    def distribution(self, stops):
        """(stops + 1,) probabilities of the numbers of noisy ones among ``stops`` stops of another brake."""
        betaln = scipy.special.betaln
        share = (self.share * self.effective + 0.5) / (self.effective + 1)
        correlation = np.clip(self.correlation + (1 - self.correlation) / (self.effective + 1), 1 - _MOST, _MOST)
        size = (1 - correlation) / correlation
        a, b, noisy = share * size, (1 - share) * size, np.arange(stops + 1)
        ways = -np.log1p(stops) - betaln(stops - noisy + 1, noisy + 1)
        return np.exp(ways + betaln(noisy + a, stops - noisy + b) - betaln(a, b))

    def p_value(self, noisy, stops):
        """Two-sided p-value of ``noisy`` among ``stops`` stops of another brake: twice the smaller tail.

        Where all draws are noisy, or none is, it can only be less, or more: one tail.
        """
        law = self.distribution(stops)
        below, above = law[:noisy + 1].sum(), law[noisy:].sum()
        if self.share in (0.0, 1.0):
            return float(min(1.0, above if self.share == 0 else below))
        return float(min(1.0, 2 * min(below, above)))

    def least(self, stops):
        """Smallest p-value that so many stops can have: that of all of them, or of none, being noisy."""
        return min(self.p_value(0, stops), self.p_value(stops, stops))


def rate(noisy):
    """Rate of ``noisy`` (b, r) in [0, 1]: r stops of each of b brakes.

    Of one stop each, all variance counts as between brakes; so it does where all stops agree.
    """
    noisy = np.asarray(noisy, float)
    brakes, repeats = noisy.shape
    if not brakes:
        return Rate(0.0, _MOST, 0.0)
    share = float(noisy.mean())
    spread = share * (1 - share)
    if spread <= 0 or brakes < 2:
        return Rate(share, _MOST, float(brakes))
    between = noisy.mean(axis=1).var(ddof=1)
    within = noisy.var(axis=1, ddof=1).mean() if repeats > 1 else 0.0
    correlation = float(np.clip((between - within / repeats) / spread, 0.0, 1.0))
    error = noisy.mean(axis=1).var() / brakes
    return Rate(share, correlation, float(min(spread / error, brakes * repeats)) if error > 0 else
                float(brakes * repeats))

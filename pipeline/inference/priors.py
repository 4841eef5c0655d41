"""Priors of parameters, and the latent coordinate in which each of them is a standard normal.

    value(u) = quantile(Phi(u)),   u ~ N(0, 1):

bounds hold for every u, and the prior's term of a least-squares problem is |u|^2 whatever its family.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: latent values stay within this; beyond, a probability of 1e-15 is left
LATENT_LIMIT = 8.0
_LOG_ROOT = 0.5 * np.log(2 * np.pi)


class _Prior:
    """What all families share; each gives value(latent), latent(value), log_density, scale and support."""

    def slope(self, latent):
        """Change of the value per latent unit, by central differences."""
        return (self.value(latent + 1e-4) - self.value(latent - 1e-4)) / 2e-4

    def quantile(self, share):
        """The value below which ``share`` of the prior lies."""
        return self.value(scipy.special.ndtri(share))

    def sample(self, generator, size=None):
        """Draws with a numpy Generator."""
        return self.value(generator.standard_normal(size))

    def _check(self, good, expected):
        if not good:
            raise ConfigError(f"prior {self}", expected)


@dataclass(frozen=True)
class Normal(_Prior):
    """Either sign, symmetric about ``mean``."""

    mean: float
    std: float

    def __post_init__(self):
        self._check(self.std > 0, "a positive standard deviation")

    @property
    def scale(self):
        return self.std

    @property
    def support(self):
        return -np.inf, np.inf

    def log_density(self, value):
        return -0.5 * ((value - self.mean) / self.std) ** 2 - np.log(self.std) - _LOG_ROOT

    def value(self, latent):
        return self.mean + self.std * latent

    def latent(self, value):
        return _limited((value - self.mean) / self.std)


@dataclass(frozen=True)
class LogNormal(_Prior):
    """Of the sign of its ``median``; ``spread`` is the standard deviation of the logarithm (0.1: about 10 %)."""

    median: float
    spread: float

    def __post_init__(self):
        self._check(self.median != 0 and self.spread > 0, "a median other than 0 and a positive spread")

    @property
    def scale(self):
        return abs(self.median) * self.spread

    @property
    def support(self):
        return (0.0, np.inf) if self.median > 0 else (-np.inf, 0.0)

    def log_density(self, value):
        with np.errstate(divide="ignore"):
            size = np.maximum(value / self.median, 0.0)
            return -0.5 * (np.log(size) / self.spread) ** 2 - np.log(size * self.scale) - _LOG_ROOT

    def value(self, latent):
        return self.median * np.exp(self.spread * latent)

    def latent(self, value):
        with np.errstate(divide="ignore"):
            return _limited(np.log(np.maximum(value / self.median, 0.0)) / self.spread)


@dataclass(frozen=True)
class HalfNormal(_Prior):
    """Zero or more: a size whose sign physics fixes; density largest at zero, root mean square ``scale``."""

    scale: float

    def __post_init__(self):
        self._check(self.scale > 0, "a positive scale")

    @property
    def support(self):
        return 0.0, np.inf

    def log_density(self, value):
        inside = np.log(2) - 0.5 * (value / self.scale) ** 2 - np.log(self.scale) - _LOG_ROOT
        return np.where(np.asarray(value) < 0, -np.inf, inside)[()]

    def value(self, latent):
        return -self.scale * scipy.special.ndtri(0.5 * scipy.special.ndtr(-np.asarray(latent, float)))[()]

    def latent(self, value):
        return _limited(-scipy.special.ndtri(2 * scipy.special.ndtr(-np.maximum(value, 0.0) / self.scale)))


@dataclass(frozen=True)
class Uniform(_Prior):
    """Between ``low`` and ``high``."""

    low: float
    high: float

    def __post_init__(self):
        self._check(self.high > self.low, "low below high")

    @property
    def scale(self):
        return (self.high - self.low) / np.sqrt(12)

    @property
    def support(self):
        return self.low, self.high

    def log_density(self, value):
        inside = (np.asarray(value) >= self.low) & (np.asarray(value) <= self.high)
        return np.where(inside, -np.log(self.high - self.low), -np.inf)[()]

    def value(self, latent):
        return self.low + (self.high - self.low) * scipy.special.ndtr(latent)

    def latent(self, value):
        return _limited(scipy.special.ndtri(np.clip((value - self.low) / (self.high - self.low), 0.0, 1.0)))


@dataclass(frozen=True)
class Factors(_Prior):
    """One of a few discrete factors ``each``, all as likely, known to a relative ``spread``.

    No smooth path leads from one to another, or to a null between them: fits begin at each of them.
    """

    each: tuple
    spread: float

    def __post_init__(self):
        self._check(all(self.each) and self.spread > 0, "factors other than 0 and a positive spread")

    @property
    def scale(self):
        return self.spread * max(map(abs, self.each))

    @property
    def support(self):
        return -np.inf, np.inf

    @property
    def alternatives(self):
        """Latent coordinates (k,) of the factors themselves."""
        return scipy.special.ndtri((np.arange(len(self.each)) + 0.5) / len(self.each))

    def log_density(self, value):
        each = np.array(self.each)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = np.log(value / each) / self.spread
        near = np.where(np.isfinite(off), np.exp(-0.5 * off**2) / (abs(each) * self.spread * np.sqrt(2 * np.pi)), 0.0)
        return np.log(near.mean())

    def value(self, latent):
        share = scipy.special.ndtr(latent) * len(self.each)
        index = np.minimum(share.astype(int) if np.ndim(share) else int(share), len(self.each) - 1)
        within = latent if len(self.each) == 1 else _limited(scipy.special.ndtri(share - index))
        return np.array(self.each)[index] * np.exp(self.spread * within)

    def latent(self, value):
        alike = [k for k, factor in enumerate(self.each) if factor * value > 0]
        if not alike:
            return -LATENT_LIMIT
        offs = {k: np.log(value / self.each[k]) / self.spread for k in alike}
        nearest = min(offs, key=lambda k: abs(offs[k]))
        within = scipy.special.ndtr(_limited(offs[nearest]))
        return _limited(scipy.special.ndtri((nearest + within) / len(self.each)))


@dataclass(frozen=True)
class Parameter:
    """A number of a model that data may change.

    ``nominal`` is its value before the data; ``null`` the value at which the effect that owns it vanishes exactly,
    None for a nominal parameter or one that only shapes an effect. Both in ``unit``, SI. ``run``: name of the run whose
    prediction alone it changes, as its start state does; empty: it may change all. ``threshold``: whether it says from
    where on an effect acts, as a gap does, so that slopes at one value say little of others. ``stated``: whether the
    case states its prior. ``of``: name of the parameter of all runs from whose value that of its own run differs by it:
    by this factor where it cannot be negative, else by as much.
    """

    name: str
    unit: str
    nominal: float
    prior: object
    null: float | None = None
    run: str = ""
    threshold: bool = False
    within: tuple = (-np.inf, np.inf)
    stated: bool = False
    of: str = ""

    def __post_init__(self):
        low, high = self.prior.support
        for what, value in (("nominal", self.nominal), ("null", self.null)):
            if value is not None and not low <= value <= high:
                raise ConfigError(f"parameter {self.name}: {what}", f"a value between {low:g} and {high:g}",
                                  f"{value:g} ({self.prior})", "change the value or its prior")

    def widened(self, factor):
        """The Parameter of a size with a prior ``factor`` times as wide; itself where it is none, where its prior is
        stated, and where that is no normal one about the null."""
        prior = self.prior
        about_null = isinstance(prior, HalfNormal) or isinstance(prior, Normal) and prior.mean == self.null
        if self.null is None or self.stated or not about_null:
            return self
        wide = HalfNormal(factor * prior.scale) if isinstance(prior, HalfNormal) else replace(prior,
                                                                                              std=factor * prior.std)
        return replace(self, prior=wide)

    @property
    def discrete(self):
        """Whether it is one of a few values, to which no smooth path leads from its null."""
        return isinstance(self.prior, Factors)

    @property
    def sign(self):
        """+1 or -1 where the effect has one sign (its null is an end of the support), 0 where it may have both."""
        low, high = self.prior.support
        return 0 if self.null is None else int(self.null == low) - int(self.null == high)


def _limited(latent):
    return np.clip(latent, -LATENT_LIMIT, LATENT_LIMIT)

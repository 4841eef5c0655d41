"""Values of a brake that may be off, by section and name as in ``disc.young``, with their priors.

The logarithms of the values are normal about those of what is stated, with their spreads and correlations:
ln v = ln v0 + S R^(1/2) u with u ~ N(0, I), S the spreads and R the correlations, those that an earlier update left.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError, Section, option
from pipeline.contract.settings import leaves

#: most by which an eigenvalue of stated correlations may lie below 0, by rounding
_ROUNDING = 1e-4
#: sections that hold stiffnesses beside other numbers, and settings of bodies that leave frequencies alone
JOINED, _DAMPING = ("joints", "pressed"), ("loss_factor", "damping_ratio")
#: settings of linings that a brake at the temperature and the pressure of its statement does not ask for
_ELSEWHERE = ("lining_softening", "lining_pressure", "lining_pressure_exponent")


class Value(Section):
    """A value that may be off."""

    spread: float = option(..., "standard deviation of its logarithm: 0.05 = about 5 %", gt=0, le=1)
    correlation: dict[str, float] = option({}, "correlation with other values, as the update of a part leaves it")


@dataclass(frozen=True)
class Declared:
    """Values (p,) by ``names``, what is ``stated`` in SI ``units``, ``spread`` of their logarithms, and the ``root``
    (p, p) of their correlations."""

    names: tuple
    stated: np.ndarray
    units: np.ndarray
    spread: np.ndarray
    root: np.ndarray

    def values(self, latent):
        """Values (p,) in SI units at ``latent`` (p,)."""
        return self.stated * np.exp(self.spread * (self.root @ np.broadcast_to(latent, self.stated.shape)))

    def laid_over(self, sections, values):
        """{section: settings}: ``sections`` with ``values`` (p,) in SI units."""
        changes = {}
        for name, value in zip(self.names, values.tolist(), strict=True):
            section, key = name.split(".")
            changes.setdefault(section, {})[key] = value
        return sections | {name: sections[name].model_copy(update=each) for name, each in changes.items()}

    def spread_of(self, covariance):
        """(standard deviation (p,) of the logarithms, their correlation (p, p)) of a ``covariance`` (p, p) of u."""
        whole = self.root @ covariance @ self.root.T
        size = np.sqrt(np.diag(whole))
        return self.spread * size, whole / np.outer(size, size)


def known_values(sections):
    """{name: (value, unit)} of what ``sections`` {section: settings} state above 0 and natural frequencies depend on:
    values of bodies, stiffnesses of joints."""
    found = {f"{section}.{leaf.key}": (leaf.value, leaf.unit) for section, settings in sections.items()
             for leaf in leaves(settings) if isinstance(leaf.value, float) and leaf.value > 0}
    return {name: each for name, each in found.items()
            if (name.endswith("stiffness") if name.split(".")[0] in JOINED
                else not name.endswith(_DAMPING + _ELSEWHERE))}


def named(values, part=None):
    """{name: Value} of ``values`` whose names without a section are those of ``part``, where one is given."""
    return {name if "." in name or part is None else f"{part}.{name}": value for name, value in values.items()}


def refuse_unknown(values, known, where):
    """ConfigError for names of ``values`` {name: Value}, and for correlations with others, that are not ``known``."""
    for name, value in values.items():
        for each in (name, *named(value.correlation, name.split(".")[0])):
            if each not in known:
                here = [k for k in known if k.split(".")[0] == each.split(".")[0]] or list(known)
                raise ConfigError(f"{where}.values", f"values above 0: {', '.join(here)}", each)
        if any(abs(size) > 1 for size in value.correlation.values()):
            raise ConfigError(f"{where}.values.{name}.correlation", "sizes from -1 to 1",
                              ", ".join(f"{size:g}" for size in value.correlation.values()))


def declared(values, known, where):
    """Declared of ``values`` {name: Value}, all ``known``. Raises ConfigError for correlations that contradict."""
    names = tuple(values)
    stated, units = (np.array(each) for each in zip(*(known[name] for name in names), strict=True))
    return Declared(names, stated, units, np.array([value.spread for value in values.values()]),
                    _root(names, values, where))


def _root(names, values, where):
    """Root (p, p) of the correlations that are stated between ``names``."""
    whole = np.eye(len(names))
    for i, name in enumerate(names):
        for other, size in named(values[name].correlation, name.split(".")[0]).items():
            if other in names:
                whole[i, names.index(other)] = whole[names.index(other), i] = size
    size, vector = np.linalg.eigh(whole)
    if size.min() < -_ROUNDING:
        raise ConfigError(f"{where}.values", "correlations that can hold together",
                          f"an eigenvalue of {size.min():.2g}", "take them all from one completed case")
    return vector * np.sqrt(np.maximum(size, 0.0)) @ vector.T

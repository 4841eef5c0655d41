"""A design space as a box: points of it, what they change in the case, and what that costs.

A point is a tuple with one entry for each value of the space: a number in SI between two ends, or an index into a list.
Ranges are searched as shares u of the way from the lower end to the upper one, of logarithms where the case says so.
"""

import itertools
import math
import re
from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.design_search.declared import columns, ends, numbers
from pipeline.contract.errors import ConfigError
from pipeline.contract.units import to_si

#: digits of a value that is tried
_DIGITS = 6
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


@dataclass(frozen=True)
class Value:
    """One value of a space: its setting, SI unit, ends or ``choices``; ``own``: that of the case, as an entry of a
    point, None where the space does not hold it; ``given``: that as settings hold it; ``start``: from where its cost
    counts, a share or an index; ``spelt``: a unit in which it is written, and its size in SI."""

    name: str
    unit: str
    low: float
    high: float
    log: bool
    choices: tuple
    own: float | int | None
    given: object
    start: float
    spelt: tuple = ("", 1.0)

    def at(self, share):
        """The number at a share of the range, rounded."""
        number = self.low * (self.high / self.low) ** share if self.log else \
            self.low + share * (self.high - self.low)
        if self.own is not None and math.isclose(number, self.own, rel_tol=10.0**(1 - _DIGITS)):
            return self.own         # the case as it is, whose digits may be more
        return float(f"{min(max(number, self.low), self.high):.{_DIGITS}g}")

    def share(self, number):
        """Share of the range at which a number lies, between 0 and 1."""
        if self.log:
            return min(max(math.log(max(number, self.low) / self.low) / math.log(self.high / self.low), 0.0), 1.0)
        return min(max((number - self.low) / (self.high - self.low), 0.0), 1.0)

    def scale(self, number):
        """Change of the number by a change of the share."""
        return number * math.log(self.high / self.low) if self.log else self.high - self.low

    def written(self, entry):
        """An entry of a point as a case gives it."""
        if self.choices:
            return self.choices[entry]
        unit, size = self.spelt
        return f"{entry / size:.{_DIGITS}g} {unit}" if unit else entry

    @property
    def case(self):
        """(entry as a number, as a case would give it) of the case itself; index -1 where a list does not hold it."""
        if not self.choices:
            return float(self.given), self.written(self.given)
        return (-1.0, self.given) if self.own is None else (float(self.own), self.written(self.own))


@dataclass(frozen=True)
class Space:
    """Values of a design space, and costs: ``columns`` {name: (unit, (p,) cost of the whole range of each value)};
    ``worth`` (p,) the same, weighted, in 1/s of growth rate."""

    values: tuple
    columns: dict
    worth: np.ndarray

    @property
    def ranges(self):
        """Indices of the values between two ends."""
        return [k for k, value in enumerate(self.values) if not value.choices]

    @property
    def lists(self):
        """Indices of the values of a list."""
        return [k for k, value in enumerate(self.values) if value.choices]

    @property
    def own(self):
        """The point of the case; None where the space does not hold it."""
        point = tuple(value.own for value in self.values)
        return None if None in point else point

    def combinations(self):
        """Number of combinations of the lists."""
        return math.prod(len(self.values[k].choices) for k in self.lists)

    def every_combination(self):
        """All points of a space of nothing but lists."""
        return list(itertools.product(*(range(len(value.choices)) for value in self.values)))

    def shares(self, point):
        """(r,) shares of the ranges at a point."""
        return np.array([self.values[k].share(point[k]) for k in self.ranges])

    def at(self, shares, point):
        """The point with its ranges at ``shares`` (r,), its lists as in ``point``."""
        entries = list(point)
        for k, share in zip(self.ranges, shares, strict=True):
            entries[k] = self.values[k].at(float(share))
        return tuple(entries)

    def moved(self, point):
        """(p,) by how much of its range each value differs from that of the case; of lists 0 or 1."""
        return np.array([float(entry != value.start) if value.choices else abs(value.share(entry) - value.start)
                         for value, entry in zip(self.values, point, strict=True)])

    def cost(self, point):
        """Weighted cost of a point, in 1/s."""
        return float(self.worth @ self.moved(point))

    def cost_slopes(self, point):
        """(r,) change of the weighted cost by the shares of the ranges."""
        return np.array([self.worth[k] * np.sign(self.values[k].share(point[k]) - self.values[k].start)
                         for k in self.ranges])

    def costs(self, point):
        """{column: (unit, cost)} of a point."""
        return {name: (unit, float(each @ self.moved(point))) for name, (unit, each) in self.columns.items()}

    def changes(self, point):
        """{'stage.key': value} of a point, as a YAML gives it."""
        return {value.name: value.written(entry) for value, entry in zip(self.values, point, strict=True)}


def space_of(settings, every):
    """The Space that the ``settings`` of design_search declare; ``every``: values of the case, as of ``stated``."""
    known = numbers(every)
    values = [_list(name, given, *every.get(name, (None, ""))) if given.values else
              _range(name, given, *known[name]) for name, given in settings.space.items()]
    costs = {column: (unit, np.array([of.get(value.name, 0.0) for value in values]))
             for column, (unit, of) in columns(settings).items()}
    worth = sum((settings.weight.get(column, 0.0) * each for column, (_, each) in costs.items()),
                np.zeros(len(values)))
    return Space(tuple(values), costs, worth)


def _range(name, given, own, unit):
    low, high = ends(name, given, unit)
    value = Value(name, unit, low, high, given.log, (), float(own) if low <= own <= high else None, own, 0.0)
    return replace(value, start=value.share(own), spelt=_spelt(getattr(given, "from"), unit))


def _spelt(written, unit):
    """(unit, its size in SI) in which a case states a value: ('MN/m', 1e6) of '100 MN/m'."""
    if unit in ("", "1"):
        return "", 1.0
    name = _NUMBER.sub("", str(written), count=1).strip()
    size = to_si(f"1 {name}", unit, "")
    return (name, size) if math.isclose(to_si(f"2 {name}", unit, ""), 2 * size) else (unit, 1.0)      # not degrees C


def _list(name, given, own, unit):
    alike = [k for k, written in enumerate(given.values) if _same(written, own, unit)]
    index = alike[0] if alike else None
    return Value(name, unit, 0.0, 0.0, False, tuple(given.values), index, own, -1.0 if index is None else float(index))


def _same(written, own, unit):
    if isinstance(own, float):
        try:
            return math.isclose(to_si(written, unit or "1", ""), own, rel_tol=1e-9, abs_tol=0.0)
        except ConfigError:
            return False
    return written == own

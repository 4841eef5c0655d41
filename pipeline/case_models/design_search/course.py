"""What a search knows and says: what brakes come to, the rules of the search, and how it went."""

from dataclasses import dataclass, field

#: why starts end that could go on, and the search of lists alone
SETTLED, SPENT, ALL = ("a brake without unstable modes was found", "the budget was used up",
                       "every combination was tried")


@dataclass(frozen=True)
class Evaluation:
    """What a brake comes to, 1/s: its ``growth``, its ``cost``, and ``slopes`` {value: change of the growth by its
    share} where they are known without more brakes."""

    growth: float
    cost: float = 0.0
    slopes: dict = field(default_factory=dict)

    @property
    def objective(self):
        return self.growth + self.cost


@dataclass(frozen=True)
class Rules:
    """``budget``: brakes that may be computed; ``step`` of differences, in shares of a range; ``tolerance``: a start
    ends when a step lowers the objective by less, in shares of ``scale`` (1/s), the objective of the case."""

    budget: int
    step: float = 0.02
    tolerance: float = 1e-3
    scale: float = 1.0


@dataclass(frozen=True)
class Asked:
    """Which start asked for a brake first, as what, in which round."""

    start: int
    role: str
    round: int


@dataclass(frozen=True)
class Course:
    """How a search went: ``asked`` {point: Asked} in order, ``known`` {point: Evaluation} of those that are computed
    and of the case, ``firsts`` (points) of the starts, ``ended`` of each why, and whether it is ``complete``: nothing
    more is asked for."""

    asked: dict
    known: dict
    firsts: tuple
    ended: tuple
    complete: bool

    def lowest(self, start):
        """The point with the smallest objective among those of a start; None where none is computed."""
        points = [p for p in self.known if p in self.asked and self.asked[p].start == start]
        points += [p for p in (self.firsts[start],) if p in self.known]
        return min(points, key=lambda point: self.known[point].objective, default=None)

"""Published facts: numbers and observations of a paper, each with tolerance, source and doubt.

A fact is never deleted, only doubted. The format is documented at the head of each file in data/reference.
"""

from collections import Counter
from functools import lru_cache
from typing import Literal

from pydantic import Field, model_validator

from pipeline.contract.documents import read_yaml, state
from pipeline.contract.errors import ConfigError
from pipeline.contract.settings import Section, fill


class Published(Section):
    """One published fact: a value with its tolerance, or a statement, perhaps with bounds that it implies."""

    key: str = Field(pattern=r"^[a-z][a-z0-9_]*$")
    part: str = Field(min_length=1)
    role: Literal["input", "simulation", "test", "derived", "condition", "closed_form"]
    quantity: str = Field(min_length=1)
    value: float | None = None
    unit: str = "1"
    tolerance: float | None = Field(None, ge=0)
    why: str = ""
    statement: str = ""
    lower: float | None = None
    upper: float | None = None
    source: str = Field(min_length=1)
    doubt: str = ""
    read_as: float | None = None
    diameters: int | None = Field(None, ge=0)
    single: bool | None = None

    @model_validator(mode="after")
    def _whole(self):
        if self.value is None and not self.statement:
            raise ValueError("expected a value or a statement, found neither")
        if (self.value is None) != (self.tolerance is None):
            raise ValueError("expected value and tolerance together, found one of them")
        if (self.tolerance is not None or self.bounded) and not self.why:
            raise ValueError("expected 'why' beside a tolerance or a bound, found none")
        if self.value is not None and self.bounded:
            raise ValueError("expected a tolerance about a value or bounds of a statement, found both")
        if self.read_as is not None and not self.doubt:
            raise ValueError("expected 'doubt' beside 'read_as', found none")
        return self

    @property
    def bounded(self):
        """True for a statement that puts bounds on a number."""
        return self.lower is not None or self.upper is not None

    @property
    def comparable(self):
        """True where a number of ours can meet or miss the fact."""
        return self.value is not None or self.bounded

    def met_by(self, number):
        """Does ``number``, in the unit of the fact, lie within its tolerance or bounds?"""
        if self.value is not None:
            expected = self.value if self.read_as is None else self.read_as
            return abs(number - expected) <= self.tolerance
        above = self.lower is None or number >= self.lower
        return above and (self.upper is None or number <= self.upper)


def load(path):
    """The facts of the file at ``path``, in its order.

    Raises ConfigError with file, number and key of a fact that is not well formed, or given twice.
    """
    return _facts(path, state(path))


@lru_cache(4)
def _facts(path, _):
    """The facts of a file in one state: every variant of a case is checked against them."""
    records = read_yaml(path)
    if not isinstance(records, list):
        raise ConfigError(path, "a list of facts", type(records).__name__, "see data/reference/disc_brake.yaml")
    facts = []
    for number, record in enumerate(records, 1):
        name = f" ({record['key']})" if isinstance(record, dict) and "key" in record else ""
        facts.append(fill(Published, record, f"{path}: fact {number}{name}"))
    twice = [key for key, count in Counter(f.key for f in facts).items() if count > 1]
    if twice:
        raise ConfigError(path, "each key once", f"'{twice[0]}' again", "rename one of the two")
    return tuple(facts)

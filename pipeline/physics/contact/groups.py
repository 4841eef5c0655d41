"""Laws that differ between contacts: of the normal contact or of friction, one for each group.

    Grouped((Penalty(1e6), Penalty(4e6)), (0, 0, 1))        the third contact is stiffer

Where all contacts share a law it stands for itself. Arrays (c,) of a law speak of all contacts of the model, whichever
of them obey it.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError


@dataclass(frozen=True)
class Grouped:
    """Contact i obeys ``laws[of[i]]``; ``of`` is (c,)."""

    laws: tuple
    of: np.ndarray

    def __post_init__(self):
        of = np.array(self.of, int)
        object.__setattr__(self, "of", of)
        if not (of.ndim == 1 and np.array_equal(np.unique(of), np.arange(len(self.laws)))):
            raise ConfigError("laws of contact groups", f"every one of {len(self.laws)} laws at some contact",
                              str(of))


def parts(law, count):
    """[(law, indices (k,) of the contacts that obey it)] of a law of ``count`` contacts, Grouped or not."""
    if not isinstance(law, Grouped):
        return [(law, np.arange(count))]
    if len(law.of) != count:
        raise ConfigError("laws of contact groups", f"one law for each of {count} contacts", f"{len(law.of)}")
    return [(each, np.flatnonzero(law.of == k)) for k, each in enumerate(law.laws)]


def read(law, name, count, default=None):
    """Values (c,) of the field ``name`` at each contact; ``default`` for laws without it."""
    values = np.empty(count)
    for each, members in parts(law, count):
        values[members] = np.broadcast_to(np.asarray(getattr(each, name, default), float), count)[members]
    return values


def alike(first, other, count):
    """Whether two laws of ``count`` contacts, Grouped or not, say the same of every contact."""
    def each(law):
        whole = {i: law_of for law_of, members in parts(law, count) for i in members}
        return [whole[i] for i in range(count)]

    return all(a is b or (type(a) is type(b) and all(map(np.array_equal, vars(a).values(), vars(b).values())))
               for a, b in zip(each(first), each(other), strict=True))


def changed(law, count, chosen, change):
    """The law with ``change(law)`` at the contacts ``chosen`` (indices), elsewhere as it is."""
    table, of = [], np.empty(count, int)
    for each, indices in parts(law, count):
        inside = np.isin(indices, chosen)
        for part, members in ((each, indices[~inside]), (change(each) if inside.any() else each, indices[inside])):
            if len(members):
                known = [k for k, other in enumerate(table) if other is part]
                of[members] = known[0] if known else len(table)
                table += () if known else (part,)
    return table[0] if len(table) == 1 else Grouped(tuple(table), of)


def with_field(law, **fields):
    """The law with these fields in all groups."""
    if isinstance(law, Grouped):
        return replace(law, laws=tuple(replace(each, **fields) for each in law.laws))
    return replace(law, **fields)

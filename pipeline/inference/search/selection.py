"""The set of laws that was selected, the combinations that were tried for it, and what comes near to it."""

from dataclasses import dataclass

import numpy as np

#: share of the best candidate's gain at which another one tells that its place matters
_FELT = 0.05


@dataclass(frozen=True)
class Combination:
    """A combination of candidates that was tried: their ``effects`` (name, ...) and the ``gain`` of its evidence.

    ``gain``: ln Z over the nominal model along measured motions or linearised, multiplicity paid for. ``objective`` of
    its refit, ``held_out`` error there in noise floors and the share ``left`` of the excess error, ``held_out_left`` on
    held-out runs, None where it was not refitted; ``excluded``: whether priors exclude its values; ``values``
    ((parameter, value, unit), ...) of its laws there. ``outcome``: in words.
    """

    effects: tuple
    gain: float
    objective: float | None = None
    held_out: float | None = None
    outcome: str = ""
    left: float | None = None
    values: tuple = ()
    held_out_left: float | None = None
    excluded: bool = False


@dataclass(frozen=True)
class Selection:
    """``members``: indices of the candidates of the best set, the least necessary last; ``tried`` (Combination, ...).

    ``wider``: the same of the best set whose members need not give a share that an error of the others cannot.
    ``nominal`` (k,): latent values of the nominal parameters beside them; ``values`` {index: (j,)}: those of members.
    ``judged``: indices of the candidates whose part measured motions can show; ``left``: noise powers that the best
    set leaves along them.
    """

    members: tuple
    wider: tuple
    tried: tuple
    nominal: np.ndarray
    values: dict
    judged: frozenset
    left: float

    def start(self, members):
        """Latent values of the nominal parameters and of ``members``, in that order."""
        return np.concatenate([self.nominal, *(self.values[i] for i in members)])


def sets_and_parts(*members):
    """[(index, ...)]: each of the sets ``members``, followed by what is left without its last ones, none twice."""
    smaller = [each[:count] for each in members for count in range(len(each), 1, -1)]
    return list({frozenset(each): each for each in smaller}.values())


def merged(first, others):
    """Combinations of ``first``, then those of ``others`` that are not among them."""
    there = {frozenset(c.effects) for c in first}
    return (*first, *(c for c in others if frozenset(c.effects) not in there))


def where_felt(elaborate, simple, screen, refits):
    """Those of the ``elaborate`` candidates that act where a simple one matters: it scores, or its refit explains, a
    share of what the best does."""
    gains = np.maximum(screen.score, 0.0) ** 2
    explained = {i: max(r.fit.betters(refits.calibration.null), 0.0) for i, r in refits.results.items() if r.fit}
    most, best = gains.max(initial=0.0), max(explained.values(), default=0.0)
    felt = set()
    for i, candidate in enumerate(simple):
        if gains[i] >= _FELT * most or explained.get(i, -1.0) >= _FELT * best:
            felt |= candidate.places
    return tuple(c for c in elaborate if c.places & felt)

"""Which channels of a rig are its answers, which act on it, and which a first case leaves out: proposals."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError

#: most coordinates that a proposed model has
_MOST = 4
#: correlation beyond which one channel copies another
_COPY = 0.99999
#: what acts on a rig, the most direct first
_DIRECT = ("torque", "force", "stress", "current", "voltage")


@dataclass(frozen=True)
class Roles:
    """``responses`` [Signal], one a coordinate; ``drives`` [(Signal, index of its coordinate)]; ``base``: the Signal of
    a base that moves, or None; ``left_out`` {column: why}; ``guessed``: whether no name or unit told them apart."""

    responses: list
    drives: list
    base: object
    left_out: dict
    guessed: bool = False

    @property
    def order(self):
        """Derivative of a displacement that the responses are: 0, 1 or 2."""
        return max(s.meaning.order for s in self.responses)

    @property
    def balance(self):
        """Whether a balance of forces can be made: displacements at every coordinate, and forces."""
        return self.order == 0 and bool(self.drives) and self.base is None


def roles(signals):
    """Roles of [Signal]. Raises ConfigError where none can be a motion."""
    left_out = {s.column: "it never changes" for s in signals if s.dead}
    live = [s for s in signals if not s.dead]
    left_out |= _copies(live)
    live = [s for s in live if s.column not in left_out]
    moving = [s for s in live if s.meaning.rank is not None]
    base = next((s for s in moving if s.meaning.base), None)
    responses = _best([s for s in moving if not (s.meaning.asked or s.meaning.base)])
    drives, guessed = [s for s in live if s.meaning.drives], not responses
    if guessed:
        responses, drives = _guessed(live)
    driven = _matched(responses, drives)
    used = {s.column for s in (*responses, *(s for s, _ in driven))} | ({base.column} if base else set())
    left_out |= {s.column: _why(s, responses) for s in live if s.column not in used}
    return Roles(responses, driven, base, left_out, guessed)


def _copies(live):
    """{column: why} of channels that follow an earlier one of their measure but for noise."""
    lost = {}
    for k, late in enumerate(live):
        for early in live[:k]:
            if (early.column not in lost and late.meaning.measures == early.meaning.measures
                    and early.rate == late.rate and _alike(early, late) > _COPY):
                lost[late.column] = f"it copies {early.column}"
                break
    return lost


def _alike(one, other):
    run = next((name for name in one.pieces if name in other.pieces), None)
    if run is None or len(one.pieces[run]) != len(other.pieces[run]):
        return 0.0
    both = np.isfinite(one.pieces[run]) & np.isfinite(other.pieces[run])
    a, b = one.pieces[run][both], other.pieces[run][both]
    return 0.0 if len(a) < 2 or not (np.ptp(a) and np.ptp(b)) else float(np.corrcoef(a, b)[0, 1])


def _best(moving):
    """One channel a coordinate: positions before velocities before accelerations, unfiltered ones before filtered."""
    if not moving:
        return []
    least = min(s.meaning.order for s in moving)
    chosen = {}
    for s in sorted((s for s in moving if s.meaning.order == least),
                    key=lambda s: (s.meaning.filtered, s.meaning.rank)):
        chosen.setdefault(s.meaning.index or s.column, s)
    if len(chosen) > 1 and len({s.meaning.index for s in chosen.values()}) == 1:
        chosen = {s.column: s for s in chosen.values() if not s.meaning.filtered} or chosen
    return list(chosen.values())[:_MOST]


def _guessed(live):
    """(responses, drives) where nothing tells a motion: of channels that nothing tells the first acts, the last
    answers."""
    unknown = [s for s in live if not s.meaning.drives or s.meaning.measures == "voltage"]
    if not unknown:
        raise ConfigError("channels", "one that shows a motion: displacement, angle, velocity or acceleration",
                          ", ".join(f"{s.column} ({s.meaning.measures})" for s in live) or "none that changes",
                          "name it, or its unit, in the file; velocity steps under a load cell: bench.courses in"
                          " docs/what_to_record.md")
    first, *rest = sorted(unknown, key=lambda s: s.column)
    drives = [s for s in live if s.meaning.drives and s not in unknown]
    return ([rest[-1]], [first]) if rest and not drives else ([rest[-1] if rest else first], drives)


def _matched(responses, drives):
    """[(Signal, index of its coordinate)]: of each coordinate the most direct one, measured before commanded."""
    order = {s.column: (s.meaning.asked, _DIRECT.index(s.meaning.measures) if s.meaning.measures in _DIRECT else 9,
                        s.column.lower().startswith("normal"), s.meaning.filtered) for s in drives}
    ranked = sorted(drives, key=lambda s: order[s.column])
    indices = [s.meaning.index for s in responses]
    matched = []
    for k, index in enumerate(indices):
        of_it = [s for s in ranked if index and s.meaning.index == index]
        if not of_it and len(responses) == 1:
            of_it = ranked
        if of_it:
            matched.append((of_it[0], k))
    return matched or ([(ranked[0], 0)] if ranked else [])


def _why(signal, responses):
    meaning = signal.meaning
    if meaning.asked:
        return "what was asked for, not what was measured"
    if meaning.measures == "velocity" and any(s.meaning.rank < meaning.rank for s in responses):
        return "speed of what a position shows; add it if a sensor of its own measured it"
    if meaning.filtered:
        return "a filtered copy"
    return f"it shows {meaning.measures or 'nothing that its name or unit tells'}; not needed for a first case"

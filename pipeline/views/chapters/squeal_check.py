"""Tables of saturated squeal: features of what was recorded beside those of simulated repeats."""

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number

#: rows of all tables together that are shown unfolded
_ROWS = 14


def squeal_tables(product):
    """Tables of the product Diagnosis: who squeals at each recorded point, and what the saturated stretches show."""
    if not product.squeal:
        return ()
    who = tuple(dict.fromkeys(str(w) for one in product.squeal.values() for w in one.who))
    rows = tuple((run, *(_states(one, w) for w in who), one.sentence.item()) for run, one in product.squeal.items())
    squealing = Table(("run", *who, "in words"), rows, "Saturated squeal: records and simulated repeats that reach it",
                      wide=(1 + len(who),))
    features = tuple((run, f"{name} / {unit}", *(_value(one, w, k) for w in who), _agreement(one, k))
                     for run, one in product.squeal.items()
                     for k, (name, unit) in enumerate(zip(one.feature, one.unit, strict=True)) if one.known[0, k])
    shown = Table(("run", "feature", *who, "agrees within the spread"), features,
                  "Features of saturated stretches, mean ± spread: for verification only, never by waveform",
                  tuple(range(2, 2 + len(who))), folded=len(features) > _ROWS)
    return (squealing, shown) if features else (squealing,)


def _row(one, who):
    names = [str(w) for w in one.who]
    return names.index(who) if who in names else None


def _states(one, who):
    i = _row(one, who)
    return "not simulated" if i is None else f"{one.squealing[i]} of {one.records[i]}"


def _value(one, who, k):
    i = _row(one, who)
    return f"{number(one.mean[i, k], 3)} ± {number(one.spread[i, k], 2)}" if i is not None and one.known[i, k] else "—"


def _agreement(one, k):
    """Which models agree with the recording in feature ``k``."""
    return ", ".join(f"{w}: {'yes' if one.agrees[i, k] else 'no'}" for i, w in enumerate(one.who)
                     if i and one.known[i, k]) or "—"

"""Tables of saturated squeal: features of the recordings beside those of simulated repeats."""

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number

#: rows of all tables together that are shown unfolded
_ROWS = 14
#: scatter over the mean from which agreement tells little
_WIDE = 0.1


def squeal_tables(product):
    """Tables of the product Diagnosis: which models squeal at each recorded point, and features of saturated squeal."""
    if not product.squeal:
        return ()
    who = tuple(dict.fromkeys(str(w) for check in product.squeal.values() for w in check.who))
    rows = tuple((run, *(_states(check, w) for w in who), check.sentence.item())
                 for run, check in product.squeal.items())
    squealing = Table(("run", *who, "in words"), rows, "Saturated squeal: recordings and simulated repeats that reach"
                                                       " it",
                      wide=(1 + len(who),))
    features = tuple((run, f"{name} / {unit}", *(_value(check, w, k) for w in who), _agreement(check, k))
                     for run, check in product.squeal.items()
                     for k, (name, unit) in enumerate(zip(check.feature, check.unit, strict=True)) if check.known[0, k])
    shown = Table(("run", "feature", *who, "agrees within the scatter"), features,
                  "Features of saturated segments, mean ± standard deviation: for verification only, never by waveform",
                  tuple(range(2, 2 + len(who))), folded=len(features) > _ROWS)
    return (squealing, shown) if features else (squealing,)


def squeal_note(product):
    """What saturated squeal says of the last model that was simulated, and what it cannot say; '' where none was."""
    checks = [(check, i) for check in product.squeal.values() if (i := len(check.who) - 1)]
    compared = [(check, i, k) for check, i in checks for k in range(len(check.feature)) if check.known[[0, i], k].all()]
    if not compared:
        return ""
    differ = sum(not check.agrees[i, k] for check, i, k in compared)
    wide = sum(max(check.spread[0, k], check.spread[i, k]) > _WIDE * abs(check.mean[0, k]) for check, i, k in compared)
    return (f"Saturated squeal: {differ} of {len(compared)} features differ between the recordings and the"
            f" {checks[-1][0].who[-1]} model; {wide} scatter by more than {_WIDE:.0%} and would agree with much else."
            " What limits the amplitude (contacts that open, friction that turns back) takes no part in the growth:"
            " features that differ say that the model lacks it, and nothing against its poles.")


def _row(check, who):
    names = [str(w) for w in check.who]
    return names.index(who) if who in names else None


def _states(check, who):
    i = _row(check, who)
    return "not simulated" if i is None else f"{check.squealing[i]} of {check.records[i]}"


def _value(check, who, k):
    i = _row(check, who)
    if i is None or not check.known[i, k]:
        return "—"
    return f"{number(check.mean[i, k], 3)} ± {number(check.spread[i, k], 2)}"


def _agreement(check, k):
    """Which models agree with the recording in feature ``k``."""
    return ", ".join(f"{w}: {'yes' if check.agrees[i, k] else 'no'}" for i, w in enumerate(check.who)
                     if i and check.known[i, k]) or "—"

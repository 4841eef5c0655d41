"""Errors of the nominal, the recalibrated and the completed model on the recordings, and what they make of squeal.

Errors of samples count as fractions of the standard deviation of the recordings. Features (poles, ratios of sensors)
have no such deviation: their errors are counted in their noise.
"""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number, percent

_GROWTH, _FREQUENCY = "growth rate", "frequency"
#: rows of the table of stops that are shown unfolded
_ROWS = 12


def in_noise(product):
    """Whether errors of the product Diagnosis count in noise: every run holds one number a channel."""
    return all(run.measured.shape[1] == 1 for run in product.runs.values())


def differs(product):
    """Sentence: how far the nominal model is off."""
    held_out, silent = _judging(product)
    nominal, recalibrated, _, noise = _errors(product, held_out)
    if in_noise(product):
        runs = "On held-out runs" if held_out else "On fitted runs"
        judged = "Held-out runs cannot judge the nominal model, which is within their noise. " if silent else ""
        return (f"{judged}{runs} the error of the nominal model is {_times(nominal, 2)} of the features,"
                f" {number(recalibrated, 2)} times after its parameters are refitted.")
    subject = "On held-out runs the" if held_out else "The"
    return (f"{subject} error of the nominal model is {percent(nominal, 2)} of the standard deviation of the"
            f" recordings, {percent(recalibrated, 2)} after its parameters are refitted; noise alone would leave"
            f" {percent(noise, 2)}.")


def changes(product):
    """Sentence: what the fitted values or the named effects improve; '' where nothing is named."""
    held_out, _ = _judging(product)
    nominal, recalibrated, completed, noise = _errors(product, held_out)
    runs = "the held-out runs" if held_out else "the fitted runs"
    shown = _times if in_noise(product) else percent
    beside = "" if in_noise(product) else f"noise {percent(noise, 2)}"
    if product.verdict.item() == "parameters":
        return f"With the fitted values the model predicts {runs} within {shown(recalibrated, 2)}" \
               f" (nominal {shown(nominal, 2)}{f', {beside}' if beside else ''})."
    if not len(product.named):
        return ""
    return (f"The completed model predicts {runs} within {shown(completed, 2)} (without the effect, refitted:"
            f" {shown(recalibrated, 2)}{f'; {beside}' if beside else ''}); {percent(product.unexplained_share, 2)} of"
            " the excess error remains unexplained.")


def _judging(product):
    """(whether held-out runs judge the models, whether there are some that cannot): where features of all of them are
    as the nominal model has them, within their noise, and those of fitted runs are not."""
    if not any(r.held_out for r in product.runs.values()):
        return False, False
    silent = in_noise(product) and _errors(product, True)[0] <= 1 < _errors(product, False)[0]
    return not silent, bool(silent)


def error_table(product):
    """Table of the errors of every run."""
    kinds = ((0, "all fitted"), (1, "all held out"))
    runs = list(product.runs.values())
    if in_noise(product):
        rows = [(name, "held out" if run.held_out else "fitted", *(number(e, 3) for e in _over_noise([run])))
                for name, run in product.runs.items()]
        rows += [(title, "", *(number(e, 3) for e in _errors(product, held_out)[:3])) for held_out, title in kinds
                 if any(bool(r.held_out) == bool(held_out) for r in runs)]
        return Table(("run", "", "nominal", "recalibrated", "completed"), tuple(rows),
                     "Error over noise: 1 is noise alone", numeric=(2, 3, 4))
    rows = [(name, "held out" if run.held_out else "fitted", *(percent(e, 3) for e in run.error))
            for name, run in product.runs.items()]
    rows += [(title, "", *(percent(e, 3) for e in product.fit[row])) for row, title in kinds if product.fit[row].any()]
    head = ("run", "", "nominal", "recalibrated", "completed", "noise alone")
    return Table(head, tuple(rows), "Error over standard deviation", numeric=(2, 3, 4, 5))


def held_out_stops(product):
    """Sentences: growth rate and frequency of the squeal of held-out stops, measured and as the models have them; ''
    without any."""
    sentences = []
    for name, run in product.runs.items():
        squeal = _squeal(product, run)
        if not run.held_out or squeal is None:
            continue
        growth, frequency = squeal
        measured = _pair(run.measured, growth, frequency, run.noise)
        models = [f"{_pair(getattr(run, model), growth, frequency)} {model}" for model in _models(product)]
        sentences.append(f"{name} squeals with {measured} measured; {', '.join(models)}.")
    return " ".join(sentences)


def stop_table(product):
    """Table of all stops that squeal: growth rate and frequency, measured and as the models have them; None without."""
    rows = []
    for name, run in product.runs.items():
        squeal = _squeal(product, run)
        for k, unit in zip(squeal or (), ("1/s", "Hz"), strict=False):
            rows.append((name, "held out" if run.held_out else "fitted", f"{_what(product, k)} / {unit}",
                         f"{_known(run.measured[k, 0], run.noise[k])} ± {number(run.noise[k], 2)}",
                         *(_known(getattr(run, model)[k, 0], run.noise[k]) for model in _models(product, "nominal"))))
    if not rows:
        return None
    head = ("stop", "", "squeal", "measured", *_models(product, "nominal"))
    return Table(head, tuple(rows), "Onset of squeal: the growing mode, mean of the stops at each operating point",
                 tuple(range(3, len(head))), folded=len(rows) > _ROWS)


def _models(product, *before):
    """Models that are compared: the completed one where an effect is named or known."""
    return (*before, "recalibrated", *["completed"] * bool(len(product.named) + len(product.known)))


def _squeal(product, run):
    """Indices (growth rate, frequency) of the first pole of a run that grows, or None."""
    names = [str(c) for c in product.channel]
    for k, name in enumerate(names):
        if name.startswith("pole") and name.endswith(_GROWTH) and run.valid[k, 0] and run.measured[k, 0] > 0:
            return k, names.index(name.replace(_GROWTH, _FREQUENCY))
    return None


def _what(product, k):
    return _GROWTH if str(product.channel[k]).endswith(_GROWTH) else _FREQUENCY


def _pair(values, growth, frequency, noise=None):
    """'189 ± 2 1/s at 1191.2 Hz'."""
    spread = "" if noise is None else f" ± {number(noise[growth], 2)}"
    rate = number(values[growth, 0], 3) if noise is None else _known(values[growth, 0], noise[growth])
    return f"{rate}{spread}\u202f1/s at {values[frequency, 0]:.1f}\u202fHz"


def _known(value, std):
    """Value to the decimal of its error."""
    decimals = int(np.clip(1 - np.floor(np.log10(std)), 0, 4)) if std > 0 else 2
    return f"{value:.{decimals}f}"


def _errors(product, held_out):
    """(4,) errors with nominal values, recalibrated, completed, and of noise, of the runs held out or fitted."""
    if not in_noise(product):
        return product.fit[1 if held_out else 0]
    return np.append(_over_noise([r for r in product.runs.values() if bool(r.held_out) == bool(held_out)]), 1.0)


def _over_noise(runs):
    """(3,) root mean square errors of all features of runs, each over its noise."""
    left = [((run.measured - getattr(run, model))[:, 0] / run.noise)[run.valid[:, 0] > 0]
            for model in ("nominal", "recalibrated", "completed") for run in runs]
    return np.sqrt(np.mean(np.concatenate(left).reshape(3, -1) ** 2, axis=1))


def _times(value, digits):
    return f"{number(value, digits)} times the noise"

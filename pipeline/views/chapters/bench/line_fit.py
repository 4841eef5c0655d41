"""Parts of the chapter on heard lines: the fit before and after, and what grows in the bench's cycle of pressure."""

import numpy as np

from pipeline.views.chapters.chapter import Figure, Table
from pipeline.views.figures.bench import line_fit as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity, span

_TWO_PI = 2 * np.pi
_DECIBEL = 20 / np.log(10)
#: swelling modes that are listed for each cycle
_MOST = 4
#: frequencies that a sentence lists
_LISTED = 5


def figure(product, names):
    """Heard lines beside the tones before and after."""
    after = pictures.pair(product)[1][0]
    return Figure(pictures.before_after(product, names),
                  "Tones of every draw, one row each, draws of larger evidence higher up and darker: the one-way"
                  f" reference, and {names[after]}, the best hypothesis with a flexible disc.")


def written(product):
    """Whether a completed case lies beside the report, and why not."""
    if str(product.verdict) == "flexible":
        return ("The completed case, the same brake with its disc flexible in the loop and the values of the most"
                " probable draw, lies beside this report (…_two_way.yaml).")
    whole = {disc: _log_mean(product.evidence[product.disc == disc]) for disc in ("flexible", "rigid", "none")}
    beside = [f"{number(np.exp(whole['flexible'] - whole[disc]), 2)} times as probable as {words}"
              for disc, words in (("rigid", "a rigid one"), ("none", "lines that nothing explains"))]
    return ("No completed two-way case is written, because the disc would have to be named: over all its hypotheses, a"
            f" flexible disc is {' and '.join(beside)}; tenfold against both, beyond the standard error, is asked for.")


def _log_mean(values):
    """ln of the mean of exp(values)."""
    return np.logaddexp.reduce(values) - np.log(len(values))


def fit(product, names):
    """Table of the nearest tone to every line, before and after."""
    rows = []
    for k, line in enumerate(product.line):
        tests = ", ".join(str(t) for t, there in zip(product.test, product.heard_in[k], strict=True) if there)
        cells = [_nearest(product, row, line) for row, _ in pictures.pair(product)]
        rows.append((quantity(line, "Hz"), tests, *cells))
    head = ("heard", "in", *(f"nearest tone, {names[row]}" for row, _ in pictures.pair(product)))
    return Table(head, tuple(rows), "Heard lines and the nearest predicted tone: median and 80 % range over the draws,"
                 " weighted by their evidence; share of draws with one within the error of the model", (2, 3))


def _nearest(product, row, line):
    """'16.4 kHz (15.9 to 16.8), 23 %' of the tones of one hypothesis."""
    members = product.tone_hypothesis == row
    draws, frequency = product.tone_draw[members].astype(int), product.tone[members]
    each = [frequency[draws == d] for d in np.unique(draws)]
    nearest = np.array([f[np.argmin(abs(f - line))] for f in each])
    if not len(nearest):
        return "no tone"
    weight = product.weight[row][np.unique(draws)]
    order = np.argsort(nearest)
    if not weight.sum() > 0:
        return "no tone"
    reached = np.cumsum(weight[order]) / weight.sum()
    low, middle, high = (nearest[order][np.searchsorted(reached, q)] for q in (0.1, 0.5, 0.9))
    met = weight[abs(nearest - line) <= product.model_error * line].sum()
    return f"{quantity(middle, 'Hz', 3)} ({number(low / 1e3, 3)} to {number(high / 1e3, 3)} kHz), {percent(met, 2)}"


def cycle(product, names):
    """(sentence, figures, tables) of the cycle of pressure; ('', (), ()) where none was run."""
    if not len(product.cycle_time):
        return "", (), ()
    titles = [_title(product, k, names) for k in range(len(product.cycle_draw))]
    picture = Figure(pictures.cycle(product, titles),
                     f"Modes that grow in steady sliding at each instant of the cycle, {plural(len(titles), 'run')} of"
                     " it; heard lines in green.")
    return _heard_in_cycle(product, names), (picture,), (_swellings(product, titles), _still(product, titles))


def _title(product, k, names):
    values = "nominal values" if product.cycle_draw[k] < 0 else f"best draw, {names[int(product.cycle_hypothesis[k])]}"
    return f"{values}, {number(product.cycle_temperature[k] - 273, 3)} °C"


def _heard_in_cycle(product, names):
    """Which modes have time to become audible, and whether any of them is a line."""
    loud = product.swell > product.cycle_audible
    near = np.array([abs(product.line - f).min() <= product.model_error * f for f in product.swell_frequency], bool)
    period = product.cycle_time[0] + product.cycle_time[-1]
    begin = (f"In the cycle of pressure ({span(product.cycle_pressure, 'Pa')} within {quantity(period, 's', 3)}, at"
             f" constant power) an unstable mode must rise by {number(product.cycle_audible * _DECIBEL, 2)} dB while it"
             " grows:")
    nominal, best = (np.isin(product.swell_cycle, np.flatnonzero((product.cycle_draw < 0) == of)) for of in
                     (True, False))
    parts = [f"with {words}, {_frequencies(product, chosen & loud)}" for words, chosen in
             (("nominal values", nominal), ("those of the best draw", best))]
    end = (f" Near the heard lines: {_frequencies(product, near & loud)}." if (near & loud).any() else
           " None of the modes near the heard lines has time." if near.any() else " None of them is near a heard line.")
    return f"{begin} {'; '.join(parts)}.{end}"


def _frequencies(product, chosen):
    """Distinct frequencies of the chosen swellings, those that rise most."""
    distinct = []
    for f in product.swell_frequency[chosen][np.argsort(-product.swell[chosen])]:
        if all(abs(f - other) > product.model_error * f for other in distinct):
            distinct.append(f)
    more = f" and {len(distinct) - _LISTED} others" if len(distinct) > _LISTED else ""
    return f"{quantity(np.sort(distinct[:_LISTED]), 'Hz', 3)}{more}" if distinct else "none"


def _swellings(product, titles):
    step = product.cycle_time[1] - product.cycle_time[0]
    rows = []
    for k, title in enumerate(titles):
        members = np.flatnonzero(product.swell_cycle == k)
        for s in members[np.argsort(-product.swell[members])][:_MOST]:
            rows.append((title, quantity(product.swell_frequency[s], "Hz"), number(product.swell_growth[s], 3),
                         quantity(product.swell_phases[s] * step, "s", 3), number(product.swell[s] * _DECIBEL, 3),
                         "yes" if product.swell[s] > product.cycle_audible else "no"))
        if not len(members):
            rows.append((title, "no mode grows", "", "", "", ""))
    return Table(("cycle with", "mode", "largest growth rate / 1/s", "time in which it grows", "rise / dB", "audible"),
                 tuple(rows), "Modes that grow in the cycle, and how far", (1, 2, 3, 4))


def _still(product, titles):
    rows = []
    for k, title in enumerate(titles):
        for p, pressure in enumerate(product.still_pressure):
            root = product.still_root[(product.still_root_cycle == k) & (product.still_root_pressure == p)]
            modes = ", ".join(f"{quantity(abs(s.imag) / _TWO_PI, 'Hz', 3)} ({number(s.real, 2)} 1/s)" for s in root)
            rows.append((title, quantity(pressure, "Pa", 3), modes or "none"))
    head = ("values", "pressure", "growing modes")
    return Table(head, tuple(rows), "At constant load, where nothing was heard", (1,))

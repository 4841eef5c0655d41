"""Chapter: which explanation of a squeal makes the heard lines most probable, and what it would take."""

import numpy as np

from pipeline.views.chapters.bench import line_fit
from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import line_evidence as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

#: deviation of ranks above which a value counts as different near the lines
_DIFFERS = 3.0


def chapter(product, look):
    """Chapter of the product LineEvidence."""
    names = [in_words(h) for h in product.hypothesis]
    lines = ", ".join(quantity(f, "Hz") for f in product.line)
    see = (f"Heard: {lines}, and no other line between {quantity(product.band[0], 'Hz')} and"
           f" {quantity(product.band[1], 'Hz')}; {_tests(product)}. {product.value.shape[1]} draws of the"
           f" scatter of each hypothesis predict tones, each within {percent(product.model_error)} (one standard"
           " deviation).")
    said, figures, cycle_tables = line_fit.cycle(product, names)
    tables = (_weights(product, names), line_fit.fit(product, names), *_values(product, names), *cycle_tables,
              _confusion(product, names))
    sentences = (_verdict(product), statement(product), line_fit.written(product), needed(product), said)
    return Chapter("line_evidence", "What made it squeal?", see, " ".join(filter(None, sentences)),
                   (*_figures(product, names), *figures), tables, limits(product))


def _tests(product):
    """The tests of the bench in words."""
    silent = [str(t) for t, there in zip(product.test, product.heard_in.any(axis=0), strict=True) if not there]
    quiet = f"silence in {', '.join(silent)}" if silent else "no test was silent"
    return f"{plural(len(product.test), 'test')} ({', '.join(map(str, product.test))}), {quiet}"


def headline(product):
    """(sentence, tone) of the first screen."""
    return _verdict(product).rstrip("."), "squeal" if str(product.verdict) == "flexible" else "warning"


def note(product):
    """(question, answer) pairs that the first screen shows."""
    return (("What made it squeal", statement(product)), ("Completed case", line_fit.written(product)),
            ("What it would take", needed(product)))


def key_figure(product):
    """The Bayes factors, for the first screen."""
    return _figures(product, [in_words(h) for h in product.hypothesis])[0]


def in_words(name):
    """Name of a hypothesis in plain words."""
    return str(name).replace("_", " ")


def statement(product):
    """The Bayes factors, whether they decide, and what none of the tones explains."""
    names = [in_words(h) for h in product.hypothesis]
    flexible, rigid = (pictures.best(product, disc) for disc in ("flexible", "rigid"))
    total = f"{_power(product.flexible)} (ln {_pm(product.flexible, product.flexible_error)})"
    first = (f"A disc that is flexible in the loop makes what was heard {total} times as probable as a rigid one, over"
             f" all hypotheses of either kind; {names[flexible]} against {names[rigid]}:"
             f" {_power(product.evidence[flexible] - product.evidence[rigid])} times.")
    nothing = product.evidence[-1] - product.evidence[:-1].max()
    best = names[int(np.argmax(product.evidence[:-1]))]
    if nothing > 0:
        return (f"{first} Neither explains it: that all lines come from something else is {_power(nothing)} times as"
                f" probable as under {best}, the best of them.")
    return f"{first} {best.capitalize()} is {_power(-nothing)} times as probable as lines that no hypothesis explains."


def _verdict(product):
    """What the lines decide, in one sentence."""
    return {"flexible": "The heard lines speak for a disc that is flexible in the loop.",
            "rigid": "The heard lines speak for pads on a disc that does not move, against a flexible one.",
            "none": "No tone of this brake, with a flexible disc or a rigid one, explains the heard lines.",
            }.get(str(product.verdict), "The heard lines do not decide whether the disc is flexible in the loop.")


def needed(product):
    """What the draws with tones at the lines have in common, of the hypothesis with most of them."""
    lines = [quantity(f, "Hz") for f in product.line]
    row = _closest(product)
    name = in_words(product.hypothesis[row])
    shares = ", ".join(f"{line} in {percent(product.near[row, k])}" for k, line in enumerate(lines))
    largest = ", ".join(f"{quantity(product.line_growth[row, :, k].max(), '1/s', 3)} at {line}"
                        for k, line in enumerate(lines))
    said = (f"Modes of the whole brake within {percent(product.model_error)} of the lines grow most often under {name}:"
            f" {shares} of its draws, all lines in {percent(product.near[row, -1])}; their largest growth rates are"
            f" {largest}.")
    if not product.heard_in.any(axis=0).all():
        said += f" It makes the silence of the silent tests {percent(product.silence[row], 2)} probable."
    targets = [*lines, "all lines"]
    changed = [f"{targets[t]} needs {_needs(product, row, t)}" for t in range(len(targets)) if _needs(product, row, t)]
    return f"{said} What differs in those draws: {'; '.join(changed)}." if changed else said


def _closest(product):
    """Row of the hypothesis without multiples, and with a flexible disc, whose draws are most often near a line."""
    near = product.near.sum(axis=1) + product.near[:, -1]
    saturated = np.array(["saturated" in str(h) for h in product.hypothesis])
    return int(np.argmax(np.where((product.disc == "flexible") & ~saturated, near, -1)))


def _needs(product, row, target):
    """Values that differ in the draws near a target, in words; empty without."""
    shift, middle = product.target_shift[row, target], product.target_quantile[row, target, :, 1]
    changed = [k for k in np.argsort(-abs(shift)) if abs(shift[k]) > _DIFFERS]
    return ", ".join(f"{column(product.column[k])} of {number(middle[k], 2)} (all draws:"
                     f" {number(product.all_quantile[row, k, 1], 2)})" for k in changed[:4])


def column(name):
    """A drawn value in plain words."""
    kind, _, part = str(name).partition(":")
    return f"{kind.replace('_', ' ')} ({part.replace('_', ' ')})" if part else kind.replace("_", " ")


def limits(product):
    """What the evidence can and cannot carry."""
    silent = (~product.heard_in.any(axis=0)).sum()
    wrong = product.simulated[product.disc == "rigid"] > np.log(10)
    missed = product.simulated[product.disc == "flexible"] < -np.log(10)
    return (
        f"Calibration: of lists simulated with a rigid disc {percent(wrong.mean(), 2)} favour the flexible one more"
        f" than tenfold; of those with a flexible disc {percent(missed.mean(), 2)} favour the rigid one so. Lists are"
        " simulated by one half of the draws and weighed by the other.",
        f"{plural(len(product.line), 'heard line')} and {plural(silent, 'silent test')} are all the data. The factors"
        " hold for this brake and its declared scatter: what is not measured of it is assumed.",
        "A tone is an unstable mode of steady sliding at one load; which of several unstable modes is heard is left"
        " open by the drawn share of heard tones. Temperatures act through the friction of the model only.")


def _figures(product, names):
    return (
        Figure(pictures.factors(product, names),
               f"Bayes factor of each hypothesis against {names[int(product.reference)]}, with standard error. Blue:"
               " flexible disc, red: rigid, grey: unexplained lines; within the grey band less than tenfold."),
        line_fit.figure(product, names),
        Figure(pictures.tones(product, names), "Tones that the best hypothesis of either disc predicts in the tests"
               " with lines, per draw; heard lines in green."),
        Figure(pictures.simulated(product), "Calibration: Bayes factors of lists simulated with either disc, and that"
               " of the heard lines."))


def _weights(product, names):
    rows = []
    for k in np.argsort(-product.evidence, kind="stable"):
        share = product.near[k]
        rows.append((names[k], str(product.disc[k]), _pm(product.factor[k], product.factor_error[k]),
                     number(product.lines_alone[k] - product.lines_alone[int(product.reference)], 3),
                     percent(product.silence[k], 2), number(product.carried[k], 2),
                     ", ".join(percent(s, 2) for s in share)))
    return Table(("hypothesis", "disc", "ln Bayes factor", "of the lines alone", "silence", "draws that carry it",
                  "draws with a tone at each line, at all"), tuple(rows), "Hypotheses by evidence", (2, 3, 4, 5, 6))


def _values(product, names):
    """Table of what differs in draws near the lines; none where there are too few."""
    row = _closest(product)
    targets = [*(quantity(f, "Hz") for f in product.line), "all lines"]
    rows = [(targets[t], column(product.column[k]), _three(product.target_quantile[row, t, k]),
             _three(product.all_quantile[row, k]), number(product.target_shift[row, t, k], 2))
            for t in range(len(targets)) for k in np.argsort(-abs(product.target_shift[row, t]))[:5]
            if product.target_shift[row, t, k]]
    head = ("tone at", "value", "10, 50, 90 % in those draws", "in all draws", "deviation / sigma")
    return (Table(head, tuple(rows), f"What tones at the lines would need: {names[row]}", (2, 3, 4)),) if rows else ()


def _confusion(product, names):
    rows = [(names[k], *(percent(share, 2) for share in row)) for k, row in enumerate(product.confusion)]
    return Table(("simulated", *names, "none"), tuple(rows), "Calibration: share of simulated lists for which each"
                 " hypothesis is named, ten times as probable as every other", tuple(range(1, len(names) + 2)),
                 folded=True)


def _three(values):
    return ", ".join(number(v, 2) for v in values)


def _pm(value, error):
    return f"{number(value, 3)} ± {number(error, 2)}"


def _power(logarithm):
    """exp of it, in two digits."""
    return number(np.exp(logarithm), 2)

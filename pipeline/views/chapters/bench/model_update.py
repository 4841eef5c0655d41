"""Chapter: values of a body, or of a brake with its joints, that a modal test asks for."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import model_update as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

#: share of its prior's standard deviation above which a value counts as not told
_UNTOLD = 0.8
#: standard deviations of its prior by which a value may move unremarked; share of modes with a clear pair to exceed
_FAR, _ENOUGH = 3.0, 0.5
#: error of the model from which its bodies are others than those tested
_WRONG = 0.02
#: values that a sentence lists, those that moved most
_MANY = 6
#: correlation of two values from which only their combination is told
_TOGETHER = 0.95


def chapter(product, look):
    """Chapter of the product ModelUpdate."""
    shapes = (f"by frequency and by their shapes at {plural(_places(product), 'point')}" if len(product.place)
              else "by frequency alone, as no point of the test is stated")
    what = "assembled brake at rest" if _assembled(product) else f"freely hung {product.body}"
    see = f"Modes of run {product.run} paired with those of the {what} {shapes}."
    said = (headline(product)[0] + ".", strange(product), values(product), doubts(product), left(product))
    return Chapter("model_update", "The model updated by the modal test", see, " ".join(filter(None, said)),
                   (key_figure(product),), (_values(product), _modes(product), *_points(product)), limits(product))


def key_figure(product):
    """The figure of the first screen."""
    return Figure(pictures.deviations(product), "Natural frequencies of the model beside those measured, as stated"
                  " (grey) and updated (blue); open marks: pairs in doubt, which do not count.")


def headline(product):
    """(sentence, tone) of the first screen."""
    clear = int(product.clear.sum())
    before, after = (percent(_off(product, f), 2) for f in (product.frequency_before, product.frequency))
    return (f"{clear} of {plural(len(product.clear), 'measured mode')} paired beyond doubt; the model is off by"
            f" {before} as stated, by {after} updated",
            "warning" if _few(product) or product.model_error > _WRONG else "quiet")


def note(product):
    """(question, answer) pairs of the first screen."""
    doubt = " ".join(filter(None, (strange(product), doubts(product))))
    return (("What to change", values(product)), ("In doubt", doubt), ("What is left", left(product)))


def strange(product):
    """Whether the test may be of something else than the model."""
    moved = abs(np.log(product.after / product.before)) > _FAR * product.before_spread
    names = [str(name) for name in product.parameter[moved]]
    other = "brake" if _assembled(product) else product.body
    few = ("No more than half of the measured modes are modes of this model beyond doubt: the test may be of another"
           f" {other}, and no completed case is written.") if _few(product) else ""
    far = f"More than {_FAR:g} standard deviations from what was stated: {', '.join(names)}." if names else ""
    wrong = (f"No values of these bring the frequencies of the model within {percent(_WRONG, 1)}: sizes, materials or"
             " joints that count as known are others in the test.") if product.model_error > _WRONG else ""
    return " ".join(filter(None, (few, wrong, far)))


def _few(product):
    return product.clear.mean() <= _ENOUGH


def _assembled(product):
    return str(product.body) == "assembly"


def values(product):
    """The values before and after, and what the test does not tell."""
    parts = [f"{name} {before} to {after} ± {spread}" for name, before, after, spread in zip(
        product.parameter, *_written(product), strict=True)]
    moved = abs(np.log(product.after / product.before)) / product.before_spread
    first = sorted(np.argsort(-moved, kind="stable")[:_MANY])
    parts = [parts[k] for k in first] + ["others in the table"] * (len(parts) > _MANY)
    untold = [str(n) for n, a, b in zip(product.parameter, product.after_spread, product.before_spread, strict=True)
              if a > _UNTOLD * b]
    told = "; ".join(parts) + "."
    if untold:
        told += f" The test hardly tells {', '.join(untold)}: what was stated decides."
    return told + _together(product)


def _places(product):
    """Number of measured points, whatever their directions."""
    return len({str(place).partition(" direction ")[0] for place in product.place})


def _together(product):
    first, second = np.triu_indices(len(product.parameter), 1)
    pairs = [f"{product.parameter[i]} and {product.parameter[j]}" for i, j in zip(first, second, strict=True)
             if abs(product.correlation[i, j]) > _TOGETHER]
    return f" Of {', of '.join(pairs)} the test tells little more than one combination." if pairs else ""


def doubts(product):
    """Measured modes without a pair, and those that two modes of the model explain nearly as well."""
    none, either = product.pair < 0, (product.pair >= 0) & (product.clear == 0)
    said = [(f"no mode of the model: {_frequencies(product, none)}", none.any()),
            (f"one of two modes of the model: {_frequencies(product, either)}", either.any())]
    told = "; ".join(text for text, there in said if there)
    return told[:1].upper() + told[1:] + "." if told else ""


def left(product):
    """The error of the model that no value mends, and the points that disagree."""
    low, high = (product.model_error * np.exp(k * 2 * product.model_error_spread) for k in (-1, 1))
    told = (f"{percent(float(product.model_error), 2)} of the frequencies ({percent(low, 1)} to {percent(high, 1)}) is"
            " error of the model that none of these values mends.")
    worst = int(np.argmin(product.agreement)) if len(product.agreement) else -1
    if worst >= 0 and product.agreement[worst] < 0.8:
        told += (f" Point {product.place[worst]} shows other shapes than the model (correlation of"
                 f" {number(product.agreement[worst], 2)}, COMAC {number(product.agreement[worst] ** 2, 2)}): check its"
                 " place, sign and sensor.")
    return told


def limits(product):
    """What the update assumes."""
    mesh = ("The error of the mesh counts in the intervals as other meshes show it, with an order of 2. A joint between"
            " small spots takes up what the mesh lacks there." if product.mesh_checked
            else "Errors of a coarse mesh pull values one way, and only a finer mesh shows by how much.")
    joined = ("Joints are linear springs. Pads under a force stick to the disc; their pressure is distributed as the"
              " values stated ask for, and damping is not updated.",) if _assembled(product) else ()
    return ("Errors of the model count as independent from mode to mode.", mesh, *joined)


def _written(product):
    """Values before and after with their units, and their spread after."""
    units = [str(unit) for unit in product.unit]
    before, after = ([quantity(value, unit, 4) if unit not in ("", "1") else number(value, 4)
                      for value, unit in zip(each, units, strict=True)] for each in (product.before, product.after))
    return before, after, [percent(spread, 2) for spread in product.after_spread]


def _off(product, frequency):
    clear = product.clear > 0
    return float(np.sqrt(np.mean((frequency[product.pair[clear]] / product.measured_frequency[clear] - 1) ** 2)))


def _frequencies(product, chosen):
    return ", ".join(f"{number(f, 5)} Hz" for f in product.measured_frequency[chosen])


def _values(product):
    before, after, spread = _written(product)
    stated = [percent(each, 2) for each in product.before_spread]
    mesh = [percent(each, 2) if product.mesh_checked else "not estimated" for each in product.mesh_spread]
    rows = tuple(zip(map(str, product.parameter), before, stated, after, spread, mesh, strict=True))
    return Table(("value", "stated", "±", "updated", "±", "of it by the mesh"), rows, "Values before and after",
                 numeric=(1, 2, 3, 4, 5))


def _modes(product):
    rows = []
    for t, group in enumerate(product.pair):
        frequency = f"{number(product.measured_frequency[t], 6)} ± {number(product.measured_std[t], 2)}"
        if group < 0:
            rows.append((frequency, "", "", "", "", "no mode of the model"))
            continue
        off = [f"{100 * (f[group] / product.measured_frequency[t] - 1):+.2f}" for f in (product.frequency_before,
                                                                                     product.frequency)]
        rows.append((frequency, number(product.frequency[group], 6), *off,
                     number(product.likeness[t, group], 3) if len(product.place) else "", _kind(product, t, group)))
    pair = "pair, by the body that moves most" if _assembled(product) else "pair"
    return Table(("measured / Hz", "model / Hz", "before / %", "after / %", "MAC", pair), tuple(rows),
                 "Modes measured and computed", numeric=(0, 1, 2, 3, 4), folded=len(rows) > 20)


def _kind(product, t, group):
    kind = f"{plural(int(product.diameters[group]), 'nodal diameter')}" if product.diameters[group] >= 0 else "clear"
    if _assembled(product):
        kind = f"{product.mover[group]} {percent(product.mover_share[group], 2)}"
    if product.clear[t]:
        return kind
    rival = product.rival[t]
    other = f"{number(product.frequency[rival], 5)} Hz" if rival >= 0 else "none"
    return f"in doubt: or {other}"


def _points(product):
    if not len(product.place):
        return ()
    rows = tuple((str(place), str(reference), number(agreement, 3), number(agreement**2, 3),
                  number(1e3 * distance, 2))
                 for place, reference, agreement, distance in zip(product.place, product.reference, product.agreement,
                                                                  product.distance, strict=True))
    return (Table(("response", "reference", "correlation", "COMAC", "node off by / mm"), rows, "Points",
                  numeric=(2, 3, 4), folded=True),)

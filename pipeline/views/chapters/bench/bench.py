"""Chapter: sensor signals of the bench, predicted and recorded."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench.diagnosis import measured_and_predicted
from pipeline.views.figures.number_format import number, percent, plural, quantity

#: runs that are plotted
MOST = 4


def chapter(product, look):
    """Chapter of the product Bench."""
    errors = [float(e) for run in product.runs.values() for e, valid in zip(run.error, run.valid, strict=True)
              if valid.any()]
    features = all(run.measured.shape[1] == 1 for run in product.runs.values())
    drawn = [] if features else list(product.runs.items())[:MOST]
    figures = tuple(Figure(measured_and_predicted(run, product.channel, product.unit),
                           f"Run {name}: measured, and predicted by the nominal model.") for name, run in drawn)
    shown, of = (number, "noise") if features else (percent, "standard deviation")
    rows = tuple((name, str(product.channel[k]), shown(run.error[k], 3),
                  quantity(run.root_mean_square[k], str(product.unit[k]), 3))
                 for name, run in product.runs.items() for k in range(len(run.error))
                 if run.valid[k].any())
    table = Table(("run", "channel", f"error over {of}", "root mean square error"), rows,
                  "Predicted minus measured", (2, 3), folded=len(rows) > 12)
    return Chapter(
        "bench", "Bench: predicted and measured",
        f"{plural(len(product.runs), 'run')}, {_compared(product, features)}.", _sentence(errors, features), figures,
        tuple(filter(None, (_onsets(product), table))))


def _compared(product, features):
    """What is compared: channels by their names, features by their kinds."""
    if features:
        return f"{plural(len(product.channel), 'feature')}: poles, ratios of sensors, orders"
    return f"{plural(len(product.channel), 'channel')}: {', '.join(map(str, product.channel))}"


def _sentence(errors, features):
    """How far the nominal model is off."""
    few = len(set(errors)) == 1
    if features:
        sizes = number(errors[0], 2) if few else f"{number(min(errors), 2)} to {number(max(errors), 2)}"
        return f"The error of the nominal model is {sizes} times the noise of the features."
    sizes = percent(errors[0], 2) if few else f"{percent(min(errors), 2)} to {percent(max(errors), 2)}"
    return f"The error of the nominal model is {sizes} of the standard deviation of the recording{'' if few else 's'}."


def _onsets(product):
    """Table of the stops that squeal, each by itself; None without."""
    rows = []
    for point in product.stops.values():
        for k, stop in enumerate(point.stop):
            rows.append((str(stop), str(point.reason[k]), "", "", "") if point.reason[k] else (
                str(stop), f"{number(point.growth_rate[k], 4)} ± {number(point.std[k], 2)}",
                number(point.frequency[k], 5), f"{point.begin[k]:.3f} to {point.end[k]:.3f}",
                number(point.grown[k], 2)))
    head = ("stop", "growth rate / 1/s", "frequency / Hz", "window / s", "growth in powers of e")
    return Table(head, tuple(rows), "Onsets of squeal, between noise floor and saturation", (1, 2, 3, 4),
                 folded=len(rows) > 24) if rows else None

"""Chapter: sensor signals of the bench, predicted and recorded."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench.diagnosis import measured_and_predicted
from pipeline.views.figures.number_format import percent, plural, quantity

#: runs that are plotted
MOST = 4


def chapter(product, look):
    """Chapter of the product Bench."""
    errors = [float(e) for run in product.runs.values() for e in run.error]
    figures = tuple(Figure(measured_and_predicted(run, product.channel, product.unit),
                           f"Run {name}: measured, and predicted by the nominal model.")
                    for name, run in list(product.runs.items())[:MOST])
    rows = tuple((name, str(product.channel[k]), percent(run.error[k], 3),
                  quantity(run.root_mean_square[k], str(product.unit[k]), 3))
                 for name, run in product.runs.items() for k in range(len(run.error)))
    table = Table(("run", "channel", "error over standard deviation", "root mean square error"), rows,
                  "Predicted minus measured", (2, 3), folded=len(rows) > 12)
    return Chapter(
        "bench", "Bench: predicted and measured",
        f"{plural(len(product.runs), 'run')}, {plural(len(product.channel), 'channel')}:"
        f" {', '.join(map(str, product.channel))}.",
        f"The error of the nominal model is {percent(min(errors), 2)} to {percent(max(errors), 2)} of the standard"
        " deviation of the recordings." if len(set(errors)) > 1 else
        f"The error of the nominal model is {percent(errors[0], 2)} of the standard deviation of the recording.",
        figures, (table,))

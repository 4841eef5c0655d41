"""Pictures of a model updated by a modal test: how far its frequencies are off, before and after."""

from pipeline.views.figures.style import COLOURS, FAINT, INK, drawing, svg


def deviations(product):
    """SVG: frequencies of the model over those measured, before and after the update, of clear pairs and of others."""
    paired = product.pair >= 0
    group, measured = product.pair[paired], product.measured_frequency[paired]
    clear = product.clear[paired] > 0
    with drawing() as figure:
        axes = figure.subplots()
        for values, colour, marker, label in ((product.frequency_before, FAINT, "s", "as stated"),
                                              (product.frequency, COLOURS[0], "o", "updated")):
            off = 100 * (values[group] / measured - 1)
            axes.plot(measured[clear] / 1e3, off[clear], marker, color=colour, label=label)
            axes.plot(measured[~clear] / 1e3, off[~clear], marker, color=colour, mfc="none")
        axes.axhline(0, color=INK, lw=0.8)
        axes.set(xlabel="measured frequency / kHz", ylabel="model over measurement - 1 / %")
        axes.legend(loc="best")
        return svg(figure)

"""Pictures of limit cycles: levels over time, and the spectrum of the loudest one."""

import numpy as np

from pipeline.views.figures.style import BLUE, COLOURS, INK, LINES, drawing, legend, svg

#: reference of velocity levels, m/s, ISO 1683
REFERENCE = 1e-9
#: dB below the strongest line that a spectrum shows
RANGE = 60.0


def levels(cycle):
    """SVG: velocity level of all sensors together over time, one line an operating point, loudest first."""
    total = decibel(np.sqrt((cycle.level**2).mean(axis=1)))
    middle = (np.arange(total.shape[1]) + 0.5) * float(cycle.window)
    with drawing(3.6, top=0.95) as figure:
        axes = figure.subplots()
        for k, row in enumerate(np.argsort(-total[:, -1], kind="stable")[:6]):
            name = f"{cycle.pressure[row] / 1e6:.3g} MPa, {cycle.speed[row]:.4g} rad/s"
            axes.plot(1e3 * middle, total[row], color=COLOURS[k], ls=LINES[k], marker="o", ms=3, label=name)
        axes.set(xlabel="time from half the reach of the contact law / ms", ylabel="level re 1 nm/s / dB")
        legend(axes, 2)
        return svg(figure)


def spectrum(cycle, operating):
    """SVG: amplitude spectrum at the loudest sensor of one operating point, with multiples of its strongest line."""
    sensor = int(np.argmax(cycle.level[operating, :, -1]))
    level, frequency = decibel(cycle.spectrum[operating, sensor]), cycle.frequency
    shown = frequency <= 22e3
    with drawing() as figure:
        axes = figure.subplots()
        axes.plot(frequency[shown] / 1e3, level[shown], color=BLUE, lw=0.8)
        line, top = cycle.cycle_frequency[operating], level[shown].max()
        for order in range(1, int(frequency[shown][-1] / line) + 1):
            axes.axvline(order * line / 1e3, color=INK, lw=0.5, ls=":")
        axes.set(xlabel="frequency / kHz", ylabel="amplitude re 1 nm/s / dB", xlim=(0, frequency[shown][-1] / 1e3),
                 ylim=(top - RANGE, top + 3))
        return svg(figure)


def decibel(velocity):
    """Level in dB re 1 nm/s."""
    return 20 * np.log10(np.maximum(velocity, 1e-3 * REFERENCE) / REFERENCE)

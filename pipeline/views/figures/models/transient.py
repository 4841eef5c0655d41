"""Pictures of a transient: velocity over time, phase portrait, status band, force and slip, spectrum with harmonics."""

import numpy as np

from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    FAINT,
    GREEN,
    INK,
    LINES,
    ORANGE,
    RED,
    drawing,
    envelope,
    legend,
    png,
)

#: colours of the status 0, 1, 2
STATUS = (("open", FAINT), ("sticking", BLUE), ("sliding", ORANGE))
#: periods of the dominant frequency in a close-up
PERIODS = 6
#: most steps between labels of a short time axis, whose numbers are long
TICKS = 6


def velocities(transient, operating, dpi):
    """PNG of the velocity of up to four sensors over the whole time; grey: the evaluated window."""
    with drawing(3.4, top=0.55) as figure:
        axes = figure.subplots()
        for sensor, name in enumerate(transient.sensor_name[:4]):
            time, shown = envelope(transient.time, transient.velocity[operating, sensor].astype(float))
            axes.plot(1e3 * time, 1e3 * shown, color=COLOURS[sensor], ls=LINES[sensor], lw=0.8, label=name)
        end = transient.time[-1]
        axes.axvspan(1e3 * (end - float(transient.window)), 1e3 * end, color=FAINT, alpha=0.2, lw=0)
        axes.set(xlabel="time / ms", ylabel="velocity / mm/s", xlim=(0, 1e3 * end))
        legend(axes, columns=2)
        return png(figure, dpi)


def phase_portrait(transient, operating, sensor, dpi):
    """PNG of velocity over displacement at one sensor, in the window."""
    late = transient.time >= transient.time[-1] - float(transient.window)
    displacement = transient.displacement[operating, sensor, late].astype(float)
    speed = transient.velocity[operating, sensor, late].astype(float)
    with drawing() as figure:
        axes = figure.subplots()
        axes.plot(1e6 * (displacement - displacement.mean()), 1e3 * speed, color=BLUE, lw=0.5)
        axes.set(xlabel="displacement about its mean / µm", ylabel="velocity / mm/s")
        return png(figure, dpi)


def status_band(transient, operating, dpi):
    """PNG of the status of up to 40 contacts in the close look: one band a contact."""
    shown = close_look(transient, operating)
    status = transient.status[operating][:40, shown]
    from matplotlib.colors import ListedColormap

    with drawing(1.4 + 0.22 * min(len(status), 12), top=0.45) as figure:
        axes = figure.subplots()
        span = 1e3 * transient.time[shown][[0, -1]]
        axes.imshow(status, aspect="auto", interpolation="nearest", vmin=0, vmax=2, origin="lower",
                    extent=(*span, -0.5, len(status) - 0.5), cmap=ListedColormap([colour for _, colour in STATUS]))
        for name, colour in STATUS:
            axes.plot([], [], color=colour, lw=6, label=name)
        axes.set_yticks(range(len(status)), [str(k + 1) for k in range(len(status))])
        axes.set(xlabel="time / ms", ylabel="contact")
        axes.locator_params(axis="x", nbins=TICKS)
        axes.grid(False)
        legend(axes)
        return png(figure, dpi)


def force_and_slip(transient, operating, contact, dpi):
    """PNG of normal force, friction force and slip velocity of one contact in the close look."""
    shown = close_look(transient, operating)
    time = 1e3 * transient.time[shown]
    with drawing(4.4, top=0.4) as figure:
        above, below = figure.subplots(2, 1, sharex=True)
        above.plot(time, transient.normal_force[operating, contact, shown], color=BLUE, lw=1.0, label="normal")
        above.plot(time, transient.friction_force[operating, contact, shown], color=RED, lw=1.0, ls="--",
                   label="friction")
        above.set(ylabel="force / N")
        legend(above)
        below.plot(time, 1e3 * transient.slip[operating, contact, shown], color=GREEN, lw=1.0)
        below.set(xlabel="time / ms", ylabel="slip / mm/s", xlim=time[[0, -1]])
        below.locator_params(axis="x", nbins=TICKS)
        return png(figure, dpi)


def spectrum(transient, operating, sensor, dpi):
    """PNG of the level spectrum of one sensor in the window, re its highest line; dotted: harmonics of the cycle."""
    density = np.maximum(transient.velocity_spectrum[operating, sensor], 1e-300)
    level = 10 * np.log10(density / density.max())
    base = transient.cycle_frequency[operating, sensor]
    order = np.arange(1, transient.harmonic_amplitude.shape[2] + 1)
    top = min(transient.frequency[-1], (order[-1] + 1) * base) if base > 0 else transient.frequency[-1]
    with drawing() as figure:
        axes = figure.subplots()
        for k in order[order * base <= top] if base > 0 else ():
            axes.axvline(k * base / 1e3, color=INK, lw=0.7, ls=":")
        axes.plot(transient.frequency / 1e3, level, color=BLUE, lw=0.8)
        axes.set(xlabel="frequency / kHz", ylabel="level re highest line / dB", xlim=(0, top / 1e3), ylim=(-100, 5))
        return png(figure, dpi)


def close_look(transient, operating):
    """Slice of the samples of a few periods of the fastest sensor about the largest slip in the window.

    The whole window if nothing moves; intermittent motion is thus shown during a burst.
    """
    frequency = transient.cycle_frequency[operating].max(initial=0.0)
    time, window = transient.time, float(transient.window)
    length = min(PERIODS / frequency if frequency > 0 else np.inf, window)
    late = int(np.searchsorted(time, time[-1] - window))
    slip = abs(transient.slip[operating, :, late:])
    peak = time[late + int(np.argmax(slip.max(axis=0)))] if slip.size else time[-1]
    begin = np.clip(peak - length / 2, time[-1] - window, time[-1] - length)
    return slice(*np.searchsorted(time, [begin, begin + length * (1 + 1e-9)]))

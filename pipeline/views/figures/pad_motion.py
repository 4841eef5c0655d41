"""Pictures of the multibody run: pad motion, patch forces, growth over operating points, stability map."""

import numpy as np

from pipeline.views.figures.number_format import number
from pipeline.views.figures.style import (
    COLOURS,
    INK,
    LINES,
    SIGNED,
    colour_bar,
    drawing,
    envelope,
    legend,
    png,
    symmetric,
    tiles,
)


def pad_motion(multibody, operating, dpi):
    """PNG of the displacement of both pads along sliding, in µm about their mean, over time.

    The axis fits the motion after the first sixth of the time: the start reaches farther.
    """
    settled = 1e6 * multibody.pad_motion[operating, :, 0]
    settled = (settled - settled[:, settled.shape[1] // 2:].mean(axis=1, keepdims=True))[:, settled.shape[1] // 6:]
    low, high = settled.min(), settled.max()
    rim = 0.15 * max(high - low, 1e-6)
    with drawing() as figure:
        axes = figure.subplots()
        for pad, name in enumerate(multibody.pad_name):
            motion = 1e6 * multibody.pad_motion[operating, pad, 0]
            time, shown = envelope(multibody.time, motion - motion[len(motion) // 2:].mean())
            axes.plot(1e3 * time, shown, color=COLOURS[pad], ls=LINES[pad], lw=0.9, label=f"{name} pad")
        axes.set(xlabel="time / ms", ylabel="displacement along sliding / µm", xlim=1e3 * multibody.time[[0, -1]],
                 ylim=(low - rim, high + rim))
        legend(axes)
        return png(figure, dpi)


def patch_forces(multibody, operating, pad, dpi):
    """PNG of the normal force of the four sub-discs on one pad, in kN over time."""
    with drawing(3.4, top=0.55) as figure:
        axes = figure.subplots()
        for patch, force in enumerate(multibody.patch_force[operating, pad]):
            time, shown = envelope(multibody.time, force / 1e3)
            axes.plot(1e3 * time, shown, color=COLOURS[patch % 6], ls=LINES[patch % 6], lw=1.0,
                      label=f"sub-disc {patch + 1}")
        axes.set(xlabel="time / ms", ylabel="normal force / kN", xlim=1e3 * multibody.time[[0, -1]], ylim=(0, None))
        legend(axes, columns=2)
        return png(figure, dpi)


def growth(multibody, dpi):
    """PNG of the growth rate of the pad oscillation at each operating point, with its standard error and frequency."""
    texts = [f"{number(g, 3)} ± {number(s, 2)} 1/s\n{number(f, 3)} Hz" + ("" if sure else "\nundecided")
             for g, s, sure, f in zip(multibody.growth_rate, multibody.growth_rate_std, multibody.growth_decided,
                                      multibody.oscillation_frequency, strict=True)]
    with drawing(3.0, bar=True) as figure:
        tiles(figure.subplots(), multibody.pressure, multibody.speed, multibody.growth_rate, texts,
              "growth rate / 1/s", **symmetric(multibody.growth_rate))
        return png(figure, dpi)


def stability_map(multibody, operating, dpi):
    """PNG of the largest growth rate over the factors on caliper and abutment stiffness; star = this case."""
    from matplotlib.colors import SymLogNorm

    values = multibody.stability[operating]
    largest = max(np.abs(multibody.stability).max(), 1e-6)
    norm = SymLogNorm(linthresh=0.03 * largest, vmin=-largest, vmax=largest)
    ticks = largest * np.array([-1.0, -0.1, 0.0, 0.1, 1.0])
    with drawing(bar=True) as figure:
        axes = figure.subplots()
        mesh = axes.pcolormesh(multibody.abutment_factor, multibody.caliper_factor, values, cmap=SIGNED, norm=norm,
                               shading="nearest")
        if values.min() < 0.0 < values.max() and min(values.shape) > 1:
            axes.contour(multibody.abutment_factor, multibody.caliper_factor, values, levels=[0.0], colors=INK)
        axes.plot(1.0, 1.0, marker="*", ms=13, color="white", mec=INK)
        axes.set(xscale="log", yscale="log", xlabel="factor on abutment stiffness",
                 ylabel="factor on caliper stiffness")
        for axis, factors in ((axes.xaxis, multibody.abutment_factor), (axes.yaxis, multibody.caliper_factor)):
            axis.set_ticks(factors, [f"{f:.3g}" for f in factors])
            axis.set_minor_locator(_none())
        axes.grid(False)
        colour_bar(axes, mesh, "largest growth rate / 1/s").set_ticks(ticks, labels=[number(t, 2) for t in ticks])
        return png(figure, dpi)


def _none():
    from matplotlib.ticker import NullLocator

    return NullLocator()

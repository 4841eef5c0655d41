"""Chapters: coalescing modes of the two beams, and the scatter of their motion."""

import numpy as np

from pipeline.views import beam_on_beam as pictures
from pipeline.views.chapter import Chapter, Figure, Table
from pipeline.views.readable import number, percent, plural, quantity, span


def beams(product, modes, look):
    """Chapter of the product BeamOnBeam; ``modes`` are its ComplexModes, or None."""
    figures = [Figure(pictures.frequencies_over_friction(product, modes, look.dpi),
                      "Modes of sliding over friction (the picture of Figure 3, computed here).")]
    if modes is not None:
        figures.append(Figure(pictures.complex_plane(modes, look.dpi),
                              "Roots between 2 and 3.5 kHz over friction, with damping (the picture of Figure 4)."))
    onsets = tuple((quantity(f, "Hz"), number(mu, 3)) for f, mu in
                   zip(product.onset_frequency, product.onset_friction, strict=True))
    other = "Timoshenko beams" if str(product.element) == "plane" else "plane elements"
    return Chapter(
        "beam_on_beam", "Two beams that touch",
        f"Both beams as {product.element} elements, {plural(len(product.mode_frequency), 'mode')} in all. Each"
        " frequency is a mode of sliding at one friction coefficient; where that curve has a maximum two modes meet.",
        f"Modes coalesce at {', '.join(f'{f} (friction {mu})' for f, mu in onsets) or 'no friction'}. By {other}:"
        f" {_others(product)}.", tuple(figures),
        (Table(("frequency", "friction"), onsets, "Coalescences, without damping", (0, 1)),
         Table(("mode", "frequency"), tuple((str(k), quantity(f, "Hz")) for k, f in
                                            enumerate(product.closed_frequency, 1)),
               "Modes without friction that move the contact along its normal", (0, 1), folded=True)))


def _others(product):
    found = zip(product.check_onset_frequency, product.check_onset_friction, strict=True)
    return ", ".join(f"{quantity(f, 'Hz')} ({number(mu, 3)})" for f, mu in found) or "none"


def scatter(product, look):
    """Chapter of the product MotionScatter."""
    runs = len(product.seed)
    vibrates = product.vibrating_share
    return Chapter(
        "motion_scatter", "What a chaotic motion keeps",
        f"The same motion, {plural(runs, 'time')}: formulations, steps and seeds differ. Waveforms cannot be compared;"
        " lines, peaks and shares can, as ranges.",
        f"Strongest line {span(product.fundamental, 'Hz')}, largest force {span(product.peak_force, 'N')}, largest slip"
        f" {span(product.peak_slip, 'm/s')}; it vibrates {percent(vibrates.min(), 2)} to {percent(vibrates.max(), 2)}"
        f" of the time, in bursts of {span(product.burst_length, 's')} between pauses of"
        f" {span(product.pause_length, 's')}. Between 250 and 650 Hz the highest line lies"
        f" {number(-np.median(product.low_level), 2)} dB below the strongest (median).",
        (Figure(pictures.scatter(product, look.dpi), "Strongest line, largest force and largest slip of each run."),
         Figure(pictures.status_shares(product, look.dpi),
                "Shares of open, sticking and sliding contact in each run; dotted: one tenth.")),
        (_runs(product),))


def _runs(product):
    rows = []
    for k in range(len(product.seed)):
        level, height = product.harmonic_level[k], product.harmonic_height[k]
        rows.append((product.formulation[k], quantity(product.step[k], "s", 2), str(product.seed[k]),
                     quantity(product.fundamental[k], "Hz"), f"{number(level[1], 2)} ({number(height[1], 2)})",
                     f"{number(level[2], 2)} ({number(height[2], 2)})", quantity(product.peak_force[k], "N", 3),
                     quantity(product.peak_slip[k], "m/s", 3),
                     " / ".join(percent(s, 2) for s in product.status_share[k]), percent(product.vibrating_share[k], 2)))
    head = ("formulation", "step", "seed", "line", "2f / dB (above floor)", "3f / dB (above floor)", "force", "slip",
            "open / stick / slip", "vibrates")
    return Table(head, tuple(rows), "All runs", tuple(range(1, 10)), folded=len(rows) > 8)

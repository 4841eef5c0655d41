"""Chapters: coalescing modes of the two beams, and the scatter of their motion."""

from fnmatch import fnmatchcase

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.models import beam_on_beam as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity, span


def beams(product, modes, comparison, look):
    """Chapter of the product BeamOnBeam; ``modes`` are its ComplexModes, ``comparison`` its Comparison, or None."""
    printed = (_published(comparison, "coalescence_*_friction"),
               _published(comparison, "coalescence_low", "coalescence_middle", "coalescence_high"))
    figures = [Figure(pictures.frequencies_over_friction(product, modes, printed, look.dpi),
                      "Frequencies of the sliding modes over friction (compare Figure 3 of the paper); grey: complex"
                      f" modes with damping{_stars(printed[0])}.")]
    if modes is not None:
        frictionless = _published(comparison, "mode_*")
        figures.append(Figure(pictures.complex_plane(modes, frictionless, look.dpi),
                              "Roots between 2 and 3.5 kHz over friction, with damping (compare Figure 4 of the"
                              f" paper){_stars(frictionless)}."))
    onsets = tuple((quantity(f, "Hz"), number(mu, 3)) for f, mu in
                   zip(product.onset_frequency, product.onset_friction, strict=True))
    other = "Timoshenko beams" if str(product.element) == "plane" else "plane elements"
    return Chapter(
        "beam_on_beam", "Two beams in contact",
        f"Both beams as {product.element} elements, {plural(len(product.mode_frequency), 'mode')} in all. Each"
        " frequency is a sliding mode at one friction coefficient; two modes coalesce at a maximum of that curve.",
        f"Modes coalesce at {', '.join(f'{f} (friction {mu})' for f, mu in onsets) or 'no friction coefficient'}. By"
        f" {other}: {_others(product)}.", tuple(figures),
        (Table(("frequency", "friction"), onsets, "Coalescences, without damping", (0, 1)),
         Table(("mode", "frequency"), tuple((str(k), quantity(f, "Hz")) for k, f in
                                            enumerate(product.closed_frequency, 1)),
               "Modes without friction that move the contact along its normal", (0, 1), folded=True),
         *_findings(product)))


def _published(comparison, *keys):
    """Values of the paper, in the unit of their rows, of the facts with one of ``keys`` (or patterns of keys)."""
    if comparison is None:
        return []
    return [comparison.published[k] for k, key in enumerate(map(str, comparison.key))
            if comparison.published_known[k] and any(fnmatchcase(key, pattern) for pattern in keys)]


def _stars(values):
    return "; stars: numbers in the text of the paper" if len(values) else ""


def _findings(product):
    if len(product.finding):
        rows = tuple(zip(map(str, product.finding), map(str, product.finding_text), strict=True))
        yield Table(("question", "result"), rows, "Results of the search for one geometry", wide=(1,))


def _others(product):
    onsets = zip(product.check_onset_frequency, product.check_onset_friction, strict=True)
    return ", ".join(f"{quantity(f, 'Hz')} ({number(mu, 3)})" for f, mu in onsets) or "none"


def scatter(product, comparison, look):
    """Chapter of the product MotionScatter; ``comparison`` is its Comparison, or None."""
    printed = (np.divide(_published(comparison, "simulated_fundamental"), 1e3),
               _published(comparison, "force_named"), _published(comparison, "slip_named"))
    runs = len(product.seed)
    vibrates = product.vibrating_share
    return Chapter(
        "motion_scatter", "Reproducible features of a chaotic motion",
        f"{plural(runs, 'run')} of the same motion with different formulations, time steps and seeds. Waveforms cannot"
        " be compared; spectral lines, peaks and fractions of time can, as ranges. The energy balance closes within"
        f" {percent(product.imbalance.max(), 2)}.",
        f"Strongest line {span(product.fundamental, 'Hz')}, largest force {span(product.peak_force, 'N')}, largest slip"
        f" {span(product.peak_slip, 'm/s')}; the beams vibrate {percent(vibrates.min(), 2)} to"
        f" {percent(vibrates.max(), 2)} of the time, in bursts of {span(product.burst_length, 's')} between pauses of"
        f" {span(product.pause_length, 's')}. The highest line between 250 and 650 Hz is"
        f" {number(-np.median(product.low_level), 2)} dB below the strongest (median).",
        (Figure(pictures.scatter(product, printed, look.dpi), "Strongest line, largest force and largest slip of each"
                f" run{'; dotted: numbers in the text of the paper' if len(printed[1]) else ''}."),
         Figure(pictures.status_shares(product, look.dpi),
                "Fractions of time with open, sticking and sliding contact in each run; dotted: one tenth.")),
        (_runs(product),))


def _runs(product):
    rows = []
    for k in range(len(product.seed)):
        level, height = product.harmonic_level[k], product.harmonic_height[k]
        rows.append((product.formulation[k], quantity(product.step[k], "s", 2), str(product.seed[k]),
                     quantity(product.fundamental[k], "Hz"), f"{number(level[1], 2)} ({number(height[1], 2)})",
                     f"{number(level[2], 2)} ({number(height[2], 2)})", quantity(product.peak_force[k], "N", 3),
                     quantity(product.peak_slip[k], "m/s", 3),
                     " / ".join(percent(s, 2) for s in product.status_share[k]),
                     percent(product.vibrating_share[k], 2)))
    head = ("formulation", "step", "seed", "line", "2f / dB (above floor)", "3f / dB (above floor)", "force", "slip",
            "open / stick / slip", "vibrates")
    return Table(head, tuple(rows), "All runs", tuple(range(1, 10)), folded=len(rows) > 8)


def geometry(product, look):
    """Chapter of the product BeamGeometry."""
    onsets = ", ".join(f"{quantity(f, 'Hz')} ({number(mu, 3)})" for f, mu in
                       zip(product.onset_frequency, product.onset_friction, strict=True))
    inside = (product.motion >= product.lower) & (product.motion <= product.upper)
    silent = product.damping_low_level < -6.0
    return Chapter(
        "beam_geometry", "One geometry for all published numbers",
        f"{int(product.evaluations)} geometries were evaluated. The cost is"
        " the sum of squared distances from the tolerance bands of the published numbers: 0 means that all are met."
        f" Rigid supports reach {number(product.rigid_cost.min(), 3)} on the linear facts, compliant supports"
        f" {number(product.yielding_cost, 3)}, the best geometry {number(product.linear_cost, 3)}, with its motion"
        f" {number(product.cost, 3)}.",
        f"The best geometry coalesces at {onsets}; {percent(inside.mean(), 3)} of the values of its motions lie"
        f" inside the bands. {_why_unheard(product, silent)}",
        (Figure(pictures.spread(product, look.dpi),
                "Parameters left open by the linear facts: 5 to 95 % of the admissible geometries; a wide bar marks a"
                " parameter that they do not determine."),),
        (_judged(product), _damping(product), _rigid(product)))


def _why_unheard(product, silent):
    """Result of the damping sweep for the unstable mode near 400 Hz."""
    grows = product.low_growth > 0
    if np.any(silent & grows):
        k = int(np.flatnonzero(silent & grows)[0])
        return (f"The mode near 400 Hz is unstable but not observed from a damping per mass of"
                f" {quantity(product.damping[k], '1/s', 3)} on: its growth rate is"
                f" {quantity(product.low_growth[k], '1/s', 3)}, against"
                f" {quantity(product.middle_growth[k], '1/s', 3)} of the faster mode, whose stick and lift-off cycle"
                " suppresses it.")
    if np.any(silent):
        return "The mode near 400 Hz is absent only where damping stabilises it."
    return "The mode near 400 Hz is observed at every damping value tried."


def _judged(product):
    rows = []
    for k, name in enumerate(product.quantity_name):
        values = product.motion[:, k]
        ends = [number(v, 3) if abs(v) < 1e8 else "none" for v in (product.lower[k], product.upper[k])]
        met = np.mean((values >= product.lower[k]) & (values <= product.upper[k]))
        rows.append((str(name).replace("_", " "), " to ".join(ends), span(values, "1"), percent(met, 3)))
    return Table(("quantity (SI, dB)", "band", "ours", "runs inside"), tuple(rows),
                 "Motions of the best geometry against their bands", (1, 2, 3))


def _damping(product):
    rows = [(quantity(d, "1/s", 3), quantity(low, "1/s", 3), quantity(middle, "1/s", 3), number(level, 3),
             quantity(line, "Hz"), percent(vibrating, 2))
            for d, low, middle, level, line, vibrating in
            zip(product.damping, product.low_growth, product.middle_growth, product.damping_low_level,
                product.damping_fundamental, product.damping_vibrating, strict=True)]
    head = ("damping per mass", "growth near 400 Hz", "growth near 2.8 kHz", "highest low line / dB", "strongest line",
            "vibrates")
    return Table(head, tuple(rows), "Mode near 400 Hz: growth and motion over damping",
                 tuple(range(6)))


def _rigid(product):
    rows = [(f"{number(np.degrees(tilt), 3)}°", number(cost, 3),
             ", ".join(f"{name} {number(value, 4)}" for name, value in
                       zip(product.rigid_parameter, vector, strict=True)))
            for tilt, cost, vector in zip(product.rigid_tilt, product.rigid_cost, product.rigid_best, strict=True)]
    return Table(("tilt", "linear cost", "geometry"), tuple(rows), "Rigid supports, linear facts alone", (0, 1),
                 wide=(2,))

"""Our numbers for the facts of the beam on beam, from the products that a case has."""

import numpy as np

from pipeline.validation import ours

#: fact key or pattern -> product field
FIELDS = {
    "coalescence_count": "beam_on_beam.onset_friction", "coalescence_*_friction": "beam_on_beam.onset_friction",
    "coalescence_*": "beam_on_beam.onset_frequency", "mode_*": "beam_on_beam.closed_frequency",
    "unstable_at_friction": "complex_modes.unstable_root", "simulated_fundamental": "motion_scatter.fundamental",
    "measured_*": "motion_scatter.fundamental", "peak_force": "motion_scatter.peak_force",
    "peak_slip": "motion_scatter.peak_slip", "share_*": "motion_scatter.status_share",
    "intermittency": "motion_scatter.vibrating_share", "second_harmonic": "motion_scatter.harmonic_height",
    "third_harmonic": "motion_scatter.harmonic_height", "no_low_line": "motion_scatter.low_level",
}

#: names of the three coalescences, in rising order
_COALESCENCES = ("low", "middle", "high")
#: how a number is interpreted where the paper leaves it open
_READ_AS = {"peak_force": "; means over the sampling interval, since single-step forces on hard contacts are unbounded"}
#: a coalescence further than this factor from its fact is not the same
_FARTHEST = 1.25


def beam_on_beam_rows(products, facts, known):
    """Rows of all ``products`` (name -> product or None); ``known`` = published values in SI by key."""
    rows = {}
    for name, write in _ROWS.items():
        if products.get(name) is not None:
            rows |= write(products[name], known)
    return rows


def coalescence_rows(beams, known):
    """Where modes coalesce without damping, each published one with the nearest of ours."""
    rows = {}
    for name in _COALESCENCES:
        wanted = known.get(f"coalescence_{name}")
        apart = np.abs(np.log(beams.onset_frequency / wanted)) if wanted else np.empty(0)
        near = int(np.argmin(apart)) if apart.size and apart.min() < np.log(_FARTHEST) else None
        note = f"{beams.element} elements, without damping; nearest coalescence"
        lacking = "no modes coalesce near it"
        for key, values in ((f"coalescence_{name}", beams.onset_frequency),
                            (f"coalescence_{name}_friction", beams.onset_friction)):
            rows[key] = ours(None if near is None else values[near], note, lacking)
    plotted = beams.onset_friction < known.get("friction_drawn", 0.5)
    rows["coalescence_count"] = ours(np.sum(plotted), "maxima of friction over frequency in the range of the paper")
    for number in (5, 6):
        enough = len(beams.closed_frequency) >= number
        rows[f"mode_{number}"] = ours(beams.closed_frequency[number - 1] if enough else None,
                                      "modes that move the contact along its normal, counted from the lowest",
                                      f"fewer than {number} modes")
    return rows


def stability_rows(modes, known):
    """Unstable modes of the first operating point."""
    limit = 2 * np.pi * 10e3
    below = (modes.unstable_operating == 0) & (abs(modes.unstable_root) < limit)
    listed = ", ".join(f"{abs(r.imag) / 2 / np.pi:.0f} Hz ({r.real:.0f} 1/s)" for r in modes.unstable_root[below])
    return {"unstable_at_friction": ours(np.sum(below), f"below 10 kHz, with damping: {listed or 'none'}")}


def motion_rows(scatter, known):
    """Medians over the runs, with their ranges: the motion is chaotic."""
    values_of = {
        "simulated_fundamental": scatter.fundamental, "measured_fundamental": scatter.fundamental,
        "measured_second": 2 * scatter.fundamental, "measured_third": 3 * scatter.fundamental,
        "peak_force": scatter.peak_force, "peak_slip": scatter.peak_slip, "share_open": scatter.status_share[:, 0],
        "share_stick": scatter.status_share[:, 1], "share_slip": scatter.status_share[:, 2],
        "intermittency": scatter.vibrating_share, "second_harmonic": scatter.harmonic_height[:, 1],
        "third_harmonic": scatter.harmonic_height[:, 2], "no_low_line": scatter.low_level}
    return {key: ours(np.median(values), f"median of {len(values)} runs over formulation, step and seed; range"
                      f" {values.min():.4g} to {values.max():.4g} (SI){_READ_AS.get(key, '')}")
            for key, values in values_of.items()}


_ROWS = {"beam_on_beam": coalescence_rows, "complex_modes": stability_rows, "motion_scatter": motion_rows}

"""Our numbers for the closed forms of lumped systems, from complex modes and transients."""

import numpy as np

from pipeline.validation import ours, ratio

#: fact key or pattern -> product field
FIELDS = {"onset_friction": "complex_modes.root", "onset_frequency": "complex_modes.root",
          "operating_growth": "complex_modes.operating_root", "frequency_*": "complex_modes.real_frequency",
          "cycle_period": "transient.displacement", "cycle_displacement": "transient.displacement",
          "backward_speed": "transient.velocity", "stick_share": "transient.status",
          "growth_rate": "transient.growth_rate", "amplitude_over_load": "transient.cycle_amplitude"}

_STICKS = 1
#: growth below this fraction of the largest root is rounding
_NEUTRAL = 1e-8


def lumped_rows(products, facts, known):
    """Rows of all ``products`` (name -> product or None): thresholds and roots, then cycles of the first sensor."""
    modes, transient = products.get("complex_modes"), products.get("transient")
    rows = {}
    if modes is not None:
        rows |= _threshold(modes)
    if transient is not None:
        rows |= _cycle(transient) | _growth(transient)
    return rows


def _threshold(modes):
    """Onset of instability in the sweep, and the roots beside it."""
    roots, step = modes.root[0], np.diff(modes.friction).max()
    grows = roots.real.max(axis=1) > _NEUTRAL * abs(roots).max()
    first = int(np.argmax(grows))
    within = grows.any() and first > 0
    onset = (modes.friction[first] + modes.friction[first - 1]) / 2 if within else np.nan
    leading = roots[first, roots[first].real.argmax()]
    frequency, lacking = modes.real_frequency[0], "no onset within the sweep"
    rows = {
        "onset_friction": ours(onset, f"middle of the sweep step ({step:.2g}) in which growth begins",
                               lacking),
        "onset_frequency": ours(abs(leading.imag) / (2 * np.pi) if within else np.nan,
                                "first growing root of the sweep", lacking),
        "operating_growth": ours(modes.operating_root[0].real.max(), "largest real part, first operating point"),
    }
    return rows | {f"frequency_{k + 1}": ours(value, "without friction and damping")
                   for k, value in enumerate(frequency)}


def _cycle(transient):
    """Period, amplitude, speed and sticking of the first sensor and contact at the first operating point."""
    late = transient.time >= transient.time[-1] - transient.window
    position, time = transient.displacement[0, 0, late].astype(float), transient.time[late]
    middle = (position.max() + position.min()) / 2
    rising = np.flatnonzero((position[:-1] < middle) & (position[1:] >= middle))
    rise = position[rising + 1] - position[rising]
    crossed = time[rising] + (middle - position[rising]) / rise * np.diff(time)[rising]
    settled = bool(transient.settled[0, 0]) and len(crossed) > 1
    whole = (time >= crossed[0]) & (time < crossed[-1]) if settled else np.ones(len(time), bool)
    note, lacking = f"last {transient.window:g} s, first sensor", "the motion has not settled in its window"
    sticking = (transient.status[0, 0, late][whole] == _STICKS).mean() if transient.status.shape[1] else np.nan
    values = {"cycle_period": (crossed[-1] - crossed[0]) / (len(crossed) - 1) if settled else np.nan,
              "cycle_displacement": np.ptp(position) / 2, "backward_speed": -transient.velocity[0, 0, late].min(),
              "stick_share": sticking}
    return {key: ours(value if settled else np.nan, note, lacking) for key, value in values.items()}


def _growth(transient):
    """Growth rate of the small motion, and how the limit cycle scales with the load."""
    first, last = transient.cycle_amplitude[[0, -1], 0]
    loads = ratio(transient.pressure[-1], transient.pressure[0])
    settled = transient.settled[[0, -1], 0].all()
    grew = bool(transient.grew[0, 0])
    return {"growth_rate": ours(transient.growth_rate[0, 0] if grew else np.nan,
                                f"fitted to the envelope, +- {transient.growth_rate_std[0, 0]:.2g} 1/s",
                                "no growth from small motion"),
            "amplitude_over_load": ours(ratio(last, first) / loads if settled and loads != 1 else np.nan,
                                        "ratio of cycles over ratio of loads, highest and lowest load factor")}

"""Our numbers for the closed forms of lumped systems, from complex modes and transients."""

import numpy as np

from pipeline.validation import ours, ratio

_STICKS = 1
#: growth below this share of the largest root is rounding
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
    found = grows.any() and first > 0
    onset = (modes.friction[first] + modes.friction[first - 1]) / 2 if found else np.nan
    leading = roots[first, roots[first].real.argmax()]
    frequency, lacking = modes.real_frequency[0], "no onset within the sweep"
    rows = {
        "onset_friction": ours(onset, f"middle of the step of the sweep ({step:.2g}) in which growth begins",
                               lacking),
        "onset_frequency": ours(abs(leading.imag) / (2 * np.pi) if found else np.nan,
                                "first growing root of the sweep", lacking),
        "operating_growth": ours(modes.operating_root[0].real.max(), "largest real part, first operating point"),
    }
    return rows | {f"frequency_{k + 1}": ours(value, "without friction and damping")
                   for k, value in enumerate(frequency)}


def _cycle(transient):
    """Period, amplitude, speed and sticking of the first sensor and contact at the first operating point."""
    late = transient.time >= transient.time[-1] - transient.window
    place, time = transient.displacement[0, 0, late].astype(float), transient.time[late]
    middle = (place.max() + place.min()) / 2
    rising = np.flatnonzero((place[:-1] < middle) & (place[1:] >= middle))
    crossed = time[rising] + (middle - place[rising]) / (place[rising + 1] - place[rising]) * np.diff(time)[rising]
    settled = bool(transient.settled[0, 0]) and len(crossed) > 1
    whole = (time >= crossed[0]) & (time < crossed[-1]) if settled else np.ones(len(time), bool)
    told, lacking = f"last {transient.window:g} s, first sensor", "the motion has not settled in its window"
    sticking = (transient.status[0, 0, late][whole] == _STICKS).mean() if transient.status.shape[1] else np.nan
    values = {"cycle_period": (crossed[-1] - crossed[0]) / (len(crossed) - 1) if settled else np.nan,
              "cycle_displacement": np.ptp(place) / 2, "backward_speed": -transient.velocity[0, 0, late].min(),
              "stick_share": sticking}
    return {key: ours(value if settled else np.nan, told, lacking) for key, value in values.items()}


def _growth(transient):
    """Growth of the small motion, and how the cycle follows the load."""
    first, last = transient.cycle_amplitude[[0, -1], 0]
    loads = ratio(transient.pressure[-1], transient.pressure[0])
    settled = transient.settled[[0, -1], 0].all()
    grew = bool(transient.grew[0, 0])
    return {"growth_rate": ours(transient.growth_rate[0, 0] if grew else np.nan,
                                f"fitted to the envelope, +- {transient.growth_rate_std[0, 0]:.2g} 1/s",
                                "no growth from small motion"),
            "amplitude_over_load": ours(ratio(last, first) / loads if settled and loads != 1 else np.nan,
                                        "ratio of cycles over ratio of loads, highest and lowest load factor")}

"""Pad motion and patch forces as the paper's section 3.2 states them."""

import numpy as np

from pipeline.validation import correlation, index_of, ours, ratio

#: fact key or pattern -> product field
FIELDS = {
    "pressure_lowest": "multibody.pressure", "pressure_middle": "multibody.pressure",
    "pressure_highest": "multibody.pressure", "operating_points": "multibody.pressure", "speed_*": "multibody.speed",
    "sub_discs": "multibody.patch_force", "patch_phase_shift": "multibody.patch_force",
    "forces_rise_with_pressure": "multibody.patch_force", "pads_in_phase": "multibody.pad_motion",
    "amplitude_rises_with_pressure": "multibody.pad_motion",
    "pads_and_forces_not_correlated": "multibody.pad_motion, multibody.patch_force",
    "damped_at_low_load": "multibody.growth_rate", "critically_stable_at_high_load": "multibody.growth_rate",
    "pressure_damps_at_low_speed": "multibody.growth_rate",
    "pressure_destabilises_at_high_speed": "multibody.growth_rate", "caliper_decides": "multibody.stability",
    "oscillation_not_from_patches": "multibody.oscillation_frequency",
}

_TWO_PI = 2 * np.pi


def motion_rows(multibody, known):
    """Rows of the product Multibody; ``known`` = published values in SI by key."""
    corners = {name: index_of([known.get(f"pressure_{p}st"), known.get(f"speed_{s}st")], multibody.pressure,
                              multibody.speed)
               for name, p, s in (("low", "lowe", "lowe"), ("high", "highe", "highe"), ("pressed", "highe", "lowe"),
                                  ("fast", "lowe", "highe"))}
    rows = {**_settings(multibody), **_patches(multibody)}
    if corners["low"] is not None:
        rows |= _low_load(multibody, corners["low"])
    if corners["high"] is not None:
        rows |= _high_load(multibody, corners["high"])
    if None not in corners.values():
        rows |= _between(multibody, **corners)
    return rows


def _settings(multibody):
    pressure, speed = np.unique(multibody.pressure), np.unique(multibody.speed)
    values = {"pressure_lowest": pressure[0], "pressure_middle": np.median(pressure), "pressure_highest": pressure[-1],
              "speed_lowest": speed[0], "speed_highest": speed[-1], "operating_points": multibody.pressure.size,
              "sub_discs": multibody.patch_force.shape[2]}
    return {key: ours(value, "a setting of this case, not a result") for key, value in values.items()}


def _low_load(multibody, low):
    outer, inner = multibody.pad_motion[low, :2, 0]
    normal = multibody.patch_force[low].sum(axis=1)
    shared = max(abs(correlation(motion, force)) for motion, force in zip((outer, inner), normal, strict=True))
    return {
        "pads_in_phase": ours(correlation(outer, inner), "correlation over the whole run"),
        "damped_at_low_load": ours(damping_ratio(multibody, low) if multibody.growth_decided[low] else None,
                                   _damping_note(multibody, low), _damping_note(multibody, low)),
        "pads_and_forces_not_correlated": ours(shared, "whole run, the larger of both pads, sum of its patch forces"),
    }


def _high_load(multibody, high):
    caliper, abutment = (int(np.argmin(np.abs(factor - 1)))
                         for factor in (multibody.caliper_factor, multibody.abutment_factor))
    map_ = multibody.stability[high]
    influence = ratio(np.ptp(map_[:, abutment]), np.ptp(map_[caliper]))
    return {
        "critically_stable_at_high_load": ours(damping_ratio(multibody, high), _damping_note(multibody, high)),
        "caliper_decides": ours(influence, "linearised at the highest pressure and speed, over the factors"
                                f" {multibody.caliper_factor.min():g} to {multibody.caliper_factor.max():g}"),
    }


def _between(multibody, low, high, pressed, fast):
    """Rows that compare operating points: high with low load; pressure at the lowest and the highest speed."""
    amplitude, force = (ratio(measure(multibody, high), measure(multibody, low)) for measure in (_amplitude, _force))
    slow_change, fast_change = (damping_ratio(multibody, b) - damping_ratio(multibody, a)
                                for a, b in ((low, pressed), (fast, high)))
    note = "difference of - growth rate over angular frequency"
    return {
        "amplitude_rises_with_pressure": ours(amplitude, "rms along sliding about the mean, second half, both pads"),
        "forces_rise_with_pressure": ours(force, "mean over the run"),
        "pressure_damps_at_low_speed": ours(slow_change, note),
        "pressure_destabilises_at_high_speed": ours(fast_change, note),
    }


def _patches(multibody):
    """Phases of the sub-discs and their fundamental frequency, from the outer pad."""
    step = multibody.time[1] - multibody.time[0]
    forces = multibody.patch_force[:, 0]
    spectrum = np.fft.rfft(forces - forces.mean(axis=-1, keepdims=True))[..., 1:]
    line = np.abs(spectrum).sum(axis=1).argmax(axis=-1)
    fundamental = (line + 1) / (step * forces.shape[-1])
    tones = spectrum[np.arange(len(line)), :, line]
    turned = tones * np.conj(np.roll(tones, 1, axis=1))
    shift = np.degrees(np.abs(np.angle(turned))).min() if np.abs(turned).min() > 0 else np.nan
    apart = (multibody.oscillation_frequency / fundamental).min()
    return {
        "patch_phase_shift": ours(shift, "neighbours in the order of the sub-discs, all operating points, outer pad"),
        "oscillation_not_from_patches": ours(apart, "smallest over the operating points; the fundamental is the"
                                             f" strongest line of the patch forces, +-{1 / multibody.time[-1]:.2g} Hz"),
    }


def damping_ratio(multibody, operating):
    """Damping ratio of the pad oscillation, negative when it grows; nan where nothing oscillates."""
    return ratio(-multibody.growth_rate[operating], _TWO_PI * multibody.oscillation_frequency[operating])


def _damping_note(multibody, operating):
    """How the damping ratio was formed, its standard error, and whether its sign is decided."""
    rate, deviation = multibody.growth_rate[operating], multibody.growth_rate_std[operating]
    decided = "" if multibody.growth_decided[operating] else ": sign undecided"
    return f"- growth rate over angular frequency; growth rate {rate:.3g} +- {deviation:.2g} 1/s{decided}"


def _amplitude(multibody, operating):
    motion = multibody.pad_motion[operating, :, 0]
    return motion[:, motion.shape[1] // 2:].std(axis=1).mean()


def _force(multibody, operating):
    return multibody.patch_force[operating].sum(axis=1).mean()

"""Our numbers for the facts of the bimaterial rupture, from the product Rupture."""

import numpy as np

from pipeline.validation import ours, ratio

#: fact key or pattern -> product field
FIELDS = {
    "dilatational_*": "rupture.dilatational_speed", "shear_*": "rupture.shear_speed",
    "rayleigh_*": "rupture.rayleigh_speed", "contrast": "rupture.shear_speed", "end": "rupture.duration",
    "left_speed": "rupture.speed", "right_speed": "rupture.speed", "left_stop": "rupture.stop",
    "left_supershear": "rupture.speed", "left_near_dilatational": "rupture.speed",
    "right_near_rayleigh": "rupture.speed", "right_self_sustained": "rupture.stop", "left_evanescent": "rupture.slip",
    "right_slip_grows": "rupture.slip_growth", "left_heals": "rupture.healed", "right_heals": "rupture.healed",
    "left_mach_cone": "rupture.mach_angle", "adams_*": "rupture.speed",
}

LEFT, RIGHT = 0, 1
UPPER, LOWER = 0, 1
#: m: distance from the centre excluded from speeds and healing; distance from it and from a stop where slips are read
_RUN_IN, _INSIDE = 2.5e-4, 4e-4


def rupture_rows(products, facts, known):
    """Rows of the product ``rupture``; ``facts`` and ``known`` are not needed."""
    rupture = products["rupture"]
    return {**_table(rupture), **_fronts(rupture), **_waves(rupture)}


def _table(rupture):
    note = "from modulus, density and Poisson ratio of this case"
    names = {"dilatational": rupture.dilatational_speed, "shear": rupture.shear_speed,
             "rayleigh": rupture.rayleigh_speed}
    rows = {f"{name}_{k + 1}": ours(speeds[k], note) for name, speeds in names.items() for k in (UPPER, LOWER)}
    return {**rows, "end": ours(rupture.duration.item(), "set to the same value"),
            "contrast": ours(rupture.shear_speed[LOWER] / rupture.shear_speed[UPPER], note)}


def _fronts(rupture):
    """Rows of both fronts; a front that has died has no speed."""
    centre = 0.5 * (rupture.x[0] + rupture.x[-1])
    speed = [value if value > 0.0 else np.nan for value in rupture.speed]
    notes = [f"standard error {error:.2g} m/s; {kind}, {outcome}" for error, kind, outcome in zip(
        rupture.speed_error, rupture.kind, rupture.outcome, strict=True)]
    far = [abs(rupture.stop[side] - centre) for side in (LEFT, RIGHT)]
    fading = (rupture.stop[LEFT] + _INSIDE, centre - _RUN_IN - _INSIDE)
    return {
        "left_speed": ours(speed[LEFT], notes[LEFT]), "right_speed": ours(speed[RIGHT], notes[RIGHT]),
        "left_stop": ours(rupture.stop[LEFT] if rupture.outcome[LEFT] == "stopped" else np.nan, notes[LEFT],
                          f"the left front is {rupture.outcome[LEFT]}"),
        "left_supershear": ours(speed[LEFT] / rupture.shear_speed.max(), notes[LEFT]),
        "left_near_dilatational": ours(speed[LEFT] / rupture.dilatational_speed.min(), notes[LEFT]),
        "right_near_rayleigh": ours(speed[RIGHT] / rupture.rayleigh_speed[LOWER], notes[RIGHT]),
        "right_self_sustained": ours(ratio(far[RIGHT], far[LEFT]), "distances from the centre"),
        "left_evanescent": ours(_slip_ratio(rupture, *fading), "at the end"),
        "right_slip_grows": ours(rupture.slip_growth.item() or np.nan, "at the end; see what mesh and damping do to it",
                                 "the right front has not run 1.4 mm"),
        "left_heals": ours(_sliding(rupture, LEFT, centre), "healing time over time since arrival, median"),
        "right_heals": ours(_sliding(rupture, RIGHT, centre), "healing time over time since arrival, median"),
        "left_mach_cone": ours(_mach(rupture), "ridge of the rotation rate; as short as this one it reads low"),
    }


def _slip_ratio(rupture, first, second):
    slip = np.interp([first, second], rupture.x, rupture.slip[-1])
    return ratio(*slip)


def _sliding(rupture, side, centre):
    """Median over the nodes passed of slip duration over the time since arrival."""
    passed = (rupture.reached == 1) & ((rupture.x < centre) == (side == LEFT)) & (np.abs(rupture.x - centre) > _RUN_IN)
    since = rupture.duration - rupture.arrival[passed]
    settled = since > 0.1 * rupture.duration
    if not settled.any():
        return np.nan
    return np.median(((rupture.healed - rupture.arrival)[passed] / np.maximum(since, 1e-12))[settled])


def _mach(rupture):
    if not rupture.mach_known[LEFT, LOWER]:
        return np.nan
    return rupture.mach_angle[LEFT, LOWER] / rupture.mach_expected[LEFT, LOWER]


def _waves(rupture):
    speed = [value if value > 0.0 else np.nan for value in rupture.speed]
    pulse = rupture.pulse_speed.mean() if rupture.pulse_exists else np.nan
    wave = rupture.generalised_rayleigh_speed.item() if rupture.interface_wave else np.nan
    return {"adams_left": ours(speed[LEFT] / pulse, f"pulse at {pulse:.5g} m/s", "no such pulse for these solids"),
            "adams_right": ours(speed[RIGHT] / wave, f"wave at {wave:.5g} m/s", "no such wave for these solids")}

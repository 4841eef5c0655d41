"""Our numbers for the facts of the bimaterial rupture, from the product Rupture."""

import numpy as np

from pipeline.validation import ours, ratio

LEFT, RIGHT = 0, 1
UPPER, LOWER = 0, 1
#: m: distance from the centre left out of speeds and healing; distance of the slips compared from that and from a stop
_RUN_IN, _INSIDE = 2.5e-4, 4e-4


def rupture_rows(products, facts, known):
    """Rows of the product ``rupture``; ``facts`` and ``known`` are not needed."""
    found = products["rupture"]
    return {**_table(found), **_fronts(found), **_waves(found)}


def _table(found):
    note = "from modulus, density and Poisson ratio of this case"
    names = {"dilatational": found.dilatational_speed, "shear": found.shear_speed, "rayleigh": found.rayleigh_speed}
    rows = {f"{name}_{k + 1}": ours(speeds[k], note) for name, speeds in names.items() for k in (UPPER, LOWER)}
    return {**rows, "end": ours(found.duration.item(), "chosen alike"),
            "contrast": ours(found.shear_speed[LOWER] / found.shear_speed[UPPER], note)}


def _fronts(found):
    """Rows of both fronts; a front that died has no speed."""
    centre = 0.5 * (found.x[0] + found.x[-1])
    speed = [value if value > 0.0 else np.nan for value in found.speed]
    said = [f"standard error {error:.2g} m/s; {kind}, {outcome}" for error, kind, outcome in zip(
        found.speed_error, found.kind, found.outcome, strict=True)]
    far = [abs(found.stop[side] - centre) for side in (LEFT, RIGHT)]
    fading = (found.stop[LEFT] + _INSIDE, centre - _RUN_IN - _INSIDE)
    return {
        "left_speed": ours(speed[LEFT], said[LEFT]), "right_speed": ours(speed[RIGHT], said[RIGHT]),
        "left_stop": ours(found.stop[LEFT] if found.outcome[LEFT] == "stopped" else np.nan, said[LEFT],
                          f"the left front is {found.outcome[LEFT]}"),
        "left_supershear": ours(speed[LEFT] / found.shear_speed.max(), said[LEFT]),
        "left_near_dilatational": ours(speed[LEFT] / found.dilatational_speed.min(), said[LEFT]),
        "right_near_rayleigh": ours(speed[RIGHT] / found.rayleigh_speed[LOWER], said[RIGHT]),
        "right_self_sustained": ours(ratio(far[RIGHT], far[LEFT]), "distances from the centre"),
        "left_evanescent": ours(_slip_ratio(found, *fading), "at the end"),
        "right_slip_grows": ours(found.slip_growth.item() or np.nan, "at the end; see what mesh and damping do to it",
                                 "the right front has not run 1.4 mm"),
        "left_heals": ours(_sliding(found, LEFT, centre), "healing time over time since arrival, median"),
        "right_heals": ours(_sliding(found, RIGHT, centre), "healing time over time since arrival, median"),
        "left_mach_cone": ours(_mach(found), "ridge of the rotation rate; as short as this one it reads low"),
    }


def _slip_ratio(found, first, second):
    slip = np.interp([first, second], found.x, found.slip[-1])
    return ratio(*slip)


def _sliding(found, side, centre):
    """Median over the nodes passed of slip duration over the time since arrival."""
    there = (found.reached == 1) & ((found.x < centre) == (side == LEFT)) & (np.abs(found.x - centre) > _RUN_IN)
    since = found.duration - found.arrival[there]
    settled = since > 0.1 * found.duration
    if not settled.any():
        return np.nan
    return np.median(((found.healed - found.arrival)[there] / np.maximum(since, 1e-12))[settled])


def _mach(found):
    if not found.mach_known[LEFT, LOWER]:
        return np.nan
    return found.mach_angle[LEFT, LOWER] / found.mach_expected[LEFT, LOWER]


def _waves(found):
    speed = [value if value > 0.0 else np.nan for value in found.speed]
    pulse = found.pulse_speed.mean() if found.pulse_exists else np.nan
    wave = found.generalised_rayleigh_speed.item() if found.interface_wave else np.nan
    return {"adams_left": ours(speed[LEFT] / pulse, f"pulse at {pulse:.5g} m/s", "no such pulse for these solids"),
            "adams_right": ours(speed[RIGHT] / wave, f"wave at {wave:.5g} m/s", "no such wave for these solids")}

"""Our numbers for the facts of the pin on disc, from the products that a case has."""

import numpy as np

from pipeline.validation import ours

#: fact key or pattern -> product field
FIELDS = {"lock_in_181": "lock_in.root", "lock_in_*": "lock_in.base", "vibrations_grow": "lock_in.root",
          "gap_range": "interface_law.gap", "full_slip": "interface_law.displacement",
          "disc_harmonics*": "transient.harmonic_amplitude",
          "pin_harmonics*": "transient.harmonic_amplitude", "disc_rocking_*": "pin_on_disc.disc_frequency",
          "disc_20_*": "pin_on_disc.disc_frequency", "disc_30_*": "pin_on_disc.disc_frequency",
          "pin_first_*": "pin_on_disc.pin_frequency", "pin_second_*": "pin_on_disc.pin_frequency"}

#: an out-of-plane mode of the disc has more than this fraction of its modal mass out of plane
_OUT_OF_PLANE = 0.5
#: lines of the pin and of the disc count within these ranges, dB below the base
_PIN_RANGE, _DISC_RANGE = 50.0, 60.0
#: base and harmonics that are compared
_LINES = 5
_SAME_LENGTH = 1e-4
#: fraction of the limit that counts as full slip
_FULL_SLIP = 0.99


def pin_on_disc_rows(products, facts, known):
    """Rows of all ``products`` (name -> product or None); ``known`` = published values in SI by key."""
    rows = _disc_rows(products["pin_on_disc"]) | _pin_rows(products["pin_on_disc"], known)
    for name, write in (("interface_law", _interface_rows), ("transient", _harmonic_rows)):
        if products.get(name) is not None:
            rows |= write(products[name])
    if products.get("transient") is not None:
        rows |= _growing_rows(products["pin_on_disc"], products["transient"], known)
    if products.get("lock_in") is not None:
        rows |= _lock_in_rows(products["lock_in"], known)
    return rows


def _disc_rows(system):
    """Disc modes by their nodal diameters; the fourth and fifth of Figure 3 are not forced on any."""
    rows = {}
    for name, diameters in (("disc_rocking", 1), ("disc_20", 2), ("disc_30", 3)):
        chosen = (system.disc_diameters == diameters) & (system.disc_out_of_plane > _OUT_OF_PLANE)
        lowest = ours(system.disc_frequency[chosen].min() if chosen.any() else None,
                      f"lowest mode with {diameters} nodal diameters, {chosen.sum()} such modes below"
                      f" {system.disc_frequency.max():.0f} Hz")
        rows |= {f"{name}_test": lowest, f"{name}_simulation": lowest}
    return rows


def _pin_rows(system, known):
    """Bending modes of the clamped pin at the lengths of the paper; bending in two planes comes in pairs."""
    rows = {}
    for keys, length, pair in ((("pin_first_test", "pin_first_simulation"), 0.1465, 0),
                               (("pin_second_test", "pin_second_simulation"), 0.1465, 1),
                               (("pin_second_151",), known.get("test_length"), 1),
                               (("pin_second_181",), known.get("further_length"), 1)):
        index = _index_of_length(system.pin_length, length)
        value = None if index is None else system.pin_frequency[index, 2 * pair]
        rows |= {key: ours(value, "clamped pin with accelerometer, out of contact") for key in keys}
    return rows


def _interface_rows(law):
    """Ranges of Figures 4 and 5."""
    shear = law.shear[-1] / law.limit[-1]
    slipping = np.flatnonzero(shear >= _FULL_SLIP)
    carried = law.gap[law.gap_pressure >= 0.01 * law.gap_pressure[-1]]
    return {"gap_range": ours(np.ptp(carried), "from 1 % of the highest pressure of the law to all of it"),
            "full_slip": ours(law.displacement[slipping[0]] if len(slipping) else None,
                              "at the highest pressure of the law")}


def _harmonic_rows(transient):
    """Base and harmonics of the settled motion, at the first operating point."""
    names, caveat = list(transient.sensor_name), "" if transient.settled[0].all() else "; the motion has not settled"
    if not {"pin", "disc"} <= set(names) or not transient.cycle_amplitude[0].all():
        return {}
    levels = {}
    for name in ("pin", "disc"):
        amplitude = transient.harmonic_amplitude[0, names.index(name), :_LINES]
        levels[name] = 20 * np.log10(np.maximum(amplitude / amplitude[0], 1e-12))
    note = "velocity at multiples of the dominant frequency" + caveat
    falls = {name: -np.diff(level).max() for name, level in levels.items()}
    acceleration = levels["pin"] + 20 * np.log10(np.arange(1, _LINES + 1))
    return {"pin_harmonics": ours(_unbroken(acceleration, _PIN_RANGE), f"acceleration within {_PIN_RANGE:g} dB;"
                                                                       f" {note}"),
            "disc_harmonics": ours((levels["disc"] > -_DISC_RANGE).sum(), note),
            "pin_harmonics_fall": ours(falls["pin"], note), "disc_harmonics_do_not_fall": ours(falls["disc"], note)}


def _growing_rows(system, transient, known):
    """A motion that has not settled has the dominant line of the disc that a short window shows."""
    names = list(transient.sensor_name)
    other_length = _index_of_length(system.pin_length[:1], known.get("test_length")) is None
    if "disc" not in names or other_length or transient.settled[0].any():
        return {}
    line = ours(transient.cycle_frequency[0, names.index("disc")] or None,
                f"dominant line of the disc in the last {1e3 * float(transient.window):.3g} ms, time step"
                f" {1e6 * float(transient.step):.3g} us; still growing", "no motion")
    return {"lock_in_151": line._replace(field="transient.cycle_frequency")}


def _unbroken(levels, below):
    """Lines before the first that lies more than ``below`` dB under the base."""
    return int(np.argmin(np.append(levels > -below, False)))


def _lock_in_rows(lock_in, known):
    """Cases of the map: base of the settled motion, or the growing mode where the paper's own window shows growth."""
    rows = {}
    case = np.array([scan == "case" for scan in lock_in.scan])
    for keys, length in ((("lock_in_matched",), 0.1465), (("lock_in_test", "lock_in_151"), known.get("test_length"))):
        index = _index_of_length(np.where(case, lock_in.length, np.nan), length)
        if index is not None:
            root = lock_in.root[index]
            base = ours(lock_in.base[index] or None, f"base frequency of the motion, {_state(lock_in, index)};"
                        f" growing mode at {_hertz(root):.0f} Hz{_as_stepped(root, known)}", "nothing grows")
            rows |= dict.fromkeys(keys, base)
    index = _index_of_length(np.where(case, lock_in.length, np.nan), known.get("test_length"))
    if index is not None:
        rows["vibrations_grow"] = ours(lock_in.root[index].real, "fastest growing mode")
    return rows | _further(lock_in, case, known)


def _state(lock_in, index):
    return f"{lock_in.kind[index]}, {'settled' if lock_in.settled[index] else 'NOT settled in the window'}"


def _hertz(root):
    return abs(root.imag) / (2 * np.pi)


def _as_stepped(root, known):
    """The frequency of a root at the paper's time step: the trapezoidal rule turns w into 2 / h arctan(w h / 2)."""
    step = known.get("time_step")
    if not step:
        return ""
    shifted = np.arctan(np.pi * _hertz(root) * step) / (np.pi * step)
    return f", which the trapezoidal rule at the paper's step shows at {shifted:.0f} Hz"


def _further(lock_in, case, known):
    """181.5 mm: the case with the heaviest base, whose growing mode is compared."""
    near = case & (np.abs(lock_in.length - known.get("further_length", np.nan)) < _SAME_LENGTH)
    if not near.any():
        return {}
    index = np.flatnonzero(near)[np.argmax(lock_in.base_mass[near])]
    return {"lock_in_181": ours(_hertz(lock_in.root[index]) or None,
                                f"fastest growing mode with {lock_in.base_mass[index]:g} kg moving with the clamp"
                                f" (fitted); the base frequency of the large motion is {lock_in.base[index]:.0f} Hz"
                                f" ({_state(lock_in, index)})",
                                "nothing grows")}


def _index_of_length(lengths, wanted):
    """Index of the length ``wanted``, None where there is none."""
    if wanted is None:
        return None
    near = np.flatnonzero(np.abs(lengths - wanted) < _SAME_LENGTH)
    return int(near[0]) if len(near) else None

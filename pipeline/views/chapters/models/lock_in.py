"""Chapters: interface law, pin and disc, lock-in."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.models import lock_in as pictures
from pipeline.views.figures.number_format import number, plural, quantity, span


def interface_law(law, look):
    """Chapter of the product InterfaceLaw."""
    radius = 1 / float(law.summit_curvature)
    full = law.limit / law.tangential_stiffness
    return Chapter(
        "interface_law", "Constitutive law of the rough interface",
        f"Summits of {law.source}: {number(float(law.summit_density) / 1e6, 3)} per mm², heights scattered by"
        f" {quantity(float(law.summit_spread), 'm', 3)}, median radius {quantity(radius, 'm', 3)}. Each summit"
        " deforms as a Hertz contact and shears as a Cattaneo-Mindlin contact up to"
        f" {quantity(float(law.shear_limit), 'Pa', 3)}.",
        f"Friction, the shear limit over the pressure, is {span(law.friction, '1')} and hardly depends on pressure."
        f" Full slip develops over {span(full, 'm')}; the exponent of the evolution rule (Dahl model) is"
        f" {span(law.exponent, '1', 2)} (single Hertz contact: 1/3). The real contact area reaches"
        f" {number(100 * law.real_area.max(), 3)} %; at such spot pressures aluminium yields, which an elastic law"
        " neglects.",
        (Figure(pictures.normal_law(law), "Pressure over the distance between mean planes (compare Figure 4 of the"
                                          " paper, whose curve is not in the text)."),
         Figure(pictures.shear_law(law), "Shear stress over tangential displacement at five pressures (Figure 5)."),
         Figure(pictures.descriptions(law), f"Shear law at {quantity(law.pressure[len(law.pressure) // 2], 'Pa', 3)}"
                                            " and the three descriptions of section 4 (Figures 6 to 8).")))


def pin_on_disc(system, look):
    """Chapter of the product PinOnDisc."""
    rows = [(f"{n}", f"{f:.0f}", f"{100 * o:.0f} %") for n, f, o in
            zip(system.disc_diameters, system.disc_frequency, system.disc_out_of_plane, strict=True)][:24]
    pins = [(f"{1e3 * length:.1f}", *(f"{f:.0f}" for f in frequencies)) for length, frequencies in
            zip(system.pin_length[1:], system.pin_frequency[1:], strict=True)]
    modes = range(1, system.pin_frequency.shape[1] + 1)
    lean = "upstream: the tip trails" if system.tilt > 0 else "downstream: the tip digs in"
    return Chapter(
        "pin_on_disc", "Pin and disc",
        f"Disc on its shaft and pin in its clamp as finite elements. The pin is"
        f" {quantity(system.pin_length[0], 'm', 4)} long"
        f" and tilted by {number(abs(np.degrees(float(system.tilt))), 3)}° with its clamp {lean}; contact is"
        f" {quantity(float(system.contact_offset), 'm', 3)} off the centre of its tip.",
        f"At {span(system.load, 'kg')} the contact stiffness is {span(system.contact_stiffness, 'N/m')} and the"
        f" friction coefficient {span(system.friction, '1')}. A mass of {quantity(float(system.base_mass), 'kg', 2)}"
        " moves with the clamp along the guide.",
        tables=(Table(("nodal diameters", "frequency / Hz", "out of plane"), tuple(rows),
                      "Modes of the disc on its shaft", (1, 2), folded=True),
                Table(("length / mm", *(f"mode {k} / Hz" for k in modes)), tuple(pins),
                      "Modes of the clamped pin, out of contact", tuple(modes))))


def lock_in(product, look):
    """Chapter of the product LockIn."""
    scanned = np.array([scan == "length" for scan in product.scan])
    kinds = [str(k) for k, s in zip(product.kind, scanned, strict=True) if s]
    unsettled = int(np.sum(product.settled == 0))
    counted = ", ".join(f"{kinds.count(k)} {k}" for k in dict.fromkeys(kinds))
    return Chapter(
        "lock_in", "Lock-in over length, load, speed and angle",
        f"{len(product.kind)} points; where a mode grows, the motion was integrated until it settled and its spectrum"
        " classified: classical (one base frequency, near a mode of one body), intermediate (between modes of both"
        " bodies), multiple (side bands), dual base.",
        f"Over {scanned.sum()} pin lengths: {counted}. Points without a growing mode are stable against small"
        f" disturbances. {plural(unsettled, 'point')} did not settle in the window: their base frequency still drifts."
        f" The paper's frequencies are marked; 1445 Hz appears only as a growing mode, with a mass moving with the"
        " clamp.",
        (Figure(pictures.length_map(product), "Base frequency over pin length: filled where the motion has settled in"
                " the window, hollow where it drifts. Grey dots: mode with the largest growth rate about steady"
                " sliding. Black: the paper's numbers."), *_motions(product)),
        (_cases(product, scanned),))


def _motions(product):
    """One figure per case, comparable to Figures 11 to 15."""
    for case in range(len(product.trace)):
        if not product.base[case]:
            continue
        state = "settled" if product.settled[case] else "NOT settled"
        yield Figure(pictures.case_motion(product, case),
                     f"Free length {1e3 * product.length[case]:.1f} mm, {number(float(product.base_mass[case]), 2)} kg"
                     f" with the clamp ({state}): disc and pin along the axis of the disc, as in Figures 9 and 11 to"
                     " 15. Vertical lines: frequencies given in the text, measured (solid) and simulated (dotted); the"
                     " paper's spectra end at 5 kHz (simulated) and 20 kHz (measured).")


def _cases(product, scanned):
    rows = []
    for k in np.flatnonzero(~scanned):
        root = product.root[k]
        grows = f"{abs(root.imag) / (2 * np.pi):.0f} Hz, {root.real:.0f} 1/s" if root else "none"
        base = f"{product.base[k]:.0f}" if product.base[k] else ""
        settled = "yes" if product.settled[k] else "NO"
        rows.append((str(product.scan[k]), f"{1e3 * product.length[k]:.1f}", f"{product.load[k]:.3g}",
                     f"{product.speed[k] * 30 / np.pi:.3g}", f"{np.degrees(product.tilt[k]):.3g}",
                     f"{product.base_mass[k]:.3g}", grows, str(product.kind[k]), base, settled,
                     f"{product.harmonics[k][1]}, {product.harmonics[k][0]}"))
    return Table(("scan", "length / mm", "load / kg", "speed / rpm", "tilt / °", "base / kg", "growing mode", "lock-in",
                  "base / Hz", "settled", "lines pin, disc"), tuple(rows), "Cases and scans", (1, 2, 3, 4, 5, 8))

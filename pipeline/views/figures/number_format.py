"""Numbers as an engineer writes them: SI values in a convenient unit, with as many digits as they carry."""

import numpy as np

#: SI unit -> (name, size in SI) of the units a reader expects, largest first
SCALES = {
    "m": (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9)),
    "m^2": (("m²", 1.0), ("cm²", 1e-4), ("mm²", 1e-6)),
    "s": (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)),
    "1/s": (("1/s", 1.0),),
    "Hz": (("kHz", 1e3), ("Hz", 1.0)),
    "Pa": (("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3), ("Pa", 1.0)),
    "Pa/m": (("MPa/µm", 1e12), ("MPa/mm", 1e9), ("Pa/m", 1.0)),
    "1/Pa": (("mm²/N", 1e-6),),
    "m^2/N": (("mm²/N", 1e-6),),
    "N": (("kN", 1e3), ("N", 1.0), ("mN", 1e-3)),
    "N/m": (("N/µm", 1e6), ("N/mm", 1e3), ("N/m", 1.0)),
    "N s/m": (("N s/m", 1.0),),
    "m/s": (("m/s", 1.0), ("mm/s", 1e-3), ("µm/s", 1e-6), ("nm/s", 1e-9)),
    "J/K/kg": (("J/(kg K)", 1.0),),
    "W/m/K": (("W/(m K)", 1.0),),
}
MINUS, TIMES, THIN, RANGE = "\u2212", "\u00d7", "\u202f", "\u2013"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value, digits=4):
    """``value`` with ``digits`` significant digits; powers of ten outside 10⁻³ ... 10⁵."""
    value = float(value)
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e5:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        return f"{mantissa}{THIN}{TIMES}{THIN}10{str(int(exponent)).translate(SUPERSCRIPTS)}".replace("-", MINUS)
    text = np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")
    return text.replace("-", MINUS)


def scale(largest, unit):
    """(name, size in SI) of the convenient unit for magnitudes up to ``largest`` SI units; SI's own for 0."""
    scales = SCALES.get(unit, ((unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴"), 1.0),))
    if not largest:
        return next((s for s in scales if s[1] == 1.0), scales[0])
    return next((s for s in scales if abs(largest) >= 0.9995 * s[1]), scales[-1])


def quantity(value, unit, digits=4):
    """'13.5 MPa' for 13.5e6 Pa; a sequence shares one unit."""
    values = np.atleast_1d(np.asarray(value, dtype=float))
    name, size = scale(np.abs(values).max(initial=0.0), unit)
    text = ", ".join(number(v / size, digits) for v in values)
    return text if name == "1" else f"{text}{THIN}{name}"


def span(values, unit, digits=3):
    """'0.4–0.67', '1–3 MPa' or '−60 to 4 1/s': smallest to largest; one number where both read the same."""
    low, high = float(np.min(values)), float(np.max(values))
    name, size = scale(max(abs(low), abs(high)), unit)
    first, last = number(low / size, digits), number(high / size, digits)
    between = RANGE if low >= 0.0 else " to "
    text = first if first == last else f"{first}{between}{last}"
    return text if name == "1" else f"{text}{THIN}{name}"


def percent(fraction, digits=3):
    """'4.9 %' for 0.049."""
    return f"{number(100.0 * float(fraction), digits)}{THIN}%"


def ordinal(order):
    """'1st', '2nd', '3rd', '11th'."""
    ending = "th" if order % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(order % 10, "th")
    return f"{order}{ending}"


def plural(amount, noun):
    """'1 mode', '3 modes', 'no modes'."""
    return f"1 {noun}" if amount == 1 else f"{amount or 'no'} {noun}s"

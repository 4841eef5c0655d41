"""Units as people and instruments write them, with their size in SI by the definitions, not by the program's list."""

from dataclasses import dataclass

_G, _INCH, _FOOT, _LBF, _PSI = 9.80665, 0.0254, 0.3048, 4.4482216152605, 6894.757293168361
_TURN, _ATM, _MMHG, _KELVIN, _POUND = 6.283185307179586, 101325.0, 133.322387415, 273.15, 0.45359237


@dataclass(frozen=True)
class Label:
    """``text`` of a file: a value v of it is ``size`` v + ``zero`` in ``si``, the SI unit of what is ``measured``.

    ``level``: v is a level in dB above ``size``. ``stated``: read only where what is measured is stated.
    """

    text: str
    size: float
    measured: str
    si: str
    zero: float = 0.0
    level: bool = False
    stated: bool = False


def _labels(measured, si, *groups, stated=False):
    return [Label(text, size, measured, si, stated=stated) for size, texts in groups for text in texts.split("|")]


LABELS = [
    *_labels("acceleration", "m/s^2", (1.0, "m/s^2|m/s2|M/S^2|m/s²|m/s**2|[m/s^2]|(m/s2)|m/sec^2|m/s/s|m s^-2|ms^-2"),
             (_G, "g|G|gn|g_n|[g]|g's|Gs"), (_G / 1e3, "mg"), (1e-3, "mm/s^2|mm/s²|MM/S^2"), (1e-2, "cm/s^2|Gal"),
             (_FOOT, "ft/s^2|ft/sec2"), (_INCH, "in/s^2|in/s2"), (1e-6, "µm/s²|um/s^2")),
    *_labels("velocity", "m/s", (1.0, "m/s|M/S|m/sec|m·s^-1"), (1e-3, "mm/s|MM/S|mm/sec|mm s-1"), (1e-6, "µm/s|um/s"),
             (_INCH, "in/s|ips|inch/s|in/sec"), (1 / 3.6, "km/h|kph|km/hr"), (0.44704, "mph|mi/h"), (_FOOT, "ft/s"),
             (_FOOT / 60, "ft/min|fpm"), (1 / 60, "m/min"), (1e-2, "cm/s")),
    *_labels("displacement", "m", (1.0, "m|meter"), (1e-3, "mm|[mm]|MM|Millimeter|mm pk"),
             (1e-6, "um|µm|μm|micron|microns|UM"), (_INCH / 1e3, "mil|mils|Mils|thou"), (_INCH, "in|inch|inches"),
             (1e-2, "cm"), (1e-9, "nm"), (_FOOT, "ft")),
    *_labels("force", "N", (1.0, "N|[N]|Newton|newtons"), (1e3, "kN|KN|kn|kilonewton"), (1e-3, "mN"), (10.0, "daN"),
             (_LBF, "lbf|lbsf"), (1e3 * _LBF, "klbf|kip"), (_G, "kgf|kp"), (1e-5, "dyn"), (1e6, "MN")),
    *_labels("force", "N", (_G, "kg"), (_LBF, "lb|lbs"), stated=True),
    *_labels("pressure", "Pa", (1.0, "Pa|PA|pascal|N/m^2"), (1e3, "kPa|KPa"), (1e6, "MPa|N/mm^2|N/mm2|N/mm²|MPa(g)"),
             (1e5, "bar|Bar|BAR|bar(g)|barg|bar abs|bar_g|[bar]|bar (a)|daN/cm2"),
             (_PSI, "psi|PSI|psig|psi(a)|lbf/in^2"),
             (100.0, "mbar|hPa"), (_ATM, "atm"), (_MMHG, "mmHg"), (_ATM / 760, "Torr"),
             (_G * 1e4, "kg/cm2|kgf/cm^2|kp/cm²"),
             (1e3 * _PSI, "ksi"), (25.4 * _MMHG, "inHg")),
    *_labels("sound_pressure", "Pa", (1.0, "Pa|PA|N/m2"), (1e-3, "mPa"), (1e-6, "µPa|uPa"), stated=True),
    *_labels("angle", "rad", (1.0, "rad|radians"), (_TURN / 360, "deg|°|degrees|Deg"), (_TURN, "rev|turn"),
             (1e-3, "mrad"), (_TURN / 360 / 60, "arcmin")),
    *_labels("angular_velocity", "rad/s", (1.0, "rad/s|rad/sec|1/s rad"),
             (_TURN / 60, "rpm|RPM|1/min|U/min|r/min|rev/min|min-1|Rpm|tr/min|min^-1"), (_TURN, "rps|rev/s"),
             (_TURN / 360, "deg/s|°/s|deg/sec"), (1e3 * _TURN / 60, "krpm")),
    *_labels("torque", "N m", (1.0, "N m|Nm|N*m|N.m|N-m|N·m|NM|newton meter"), (1e3, "kN m|kNm|kN·m"),
             (1e-3, "mNm|N mm|N.mm|Nmm|mN m"), (_FOOT * _LBF, "lbf ft|ft-lbf|ft.lbf|lbf-ft|ftlb"),
             (_INCH * _LBF, "in-lbf|lbf in|in.lbf|inlb"), (_G, "kgf m|kgf-m"), (1e-2, "N cm|Ncm")),
    *_labels("torque", "N m", (_FOOT * _LBF, "lb-ft|ft-lb|lb.ft"), (_G, "kg m|kg-m"), stated=True),
    *_labels("voltage", "V", (1.0, "V|volt|Volts|v"), (1e-3, "mV"), (1e-6, "uV|µV"), (1e3, "kV")),
    *_labels("current", "A", (1.0, "A|Amp|amps|ampere"), (1e-3, "mA"), (1e-6, "µA")),
    Label("K", 1.0, "temperature", "K"), Label("Kelvin", 1.0, "temperature", "K"),
    *[Label(text, 1.0, "temperature", "K", _KELVIN) for text in
      ("degC", "deg C", "°C", "ºC", "Deg. C", "Celsius", "celsius", "[°C]", "DEG C", "oC", "Â°C", "Grad C", "deg_C")],
    *[Label(text, 5 / 9, "temperature", "K", 459.67 * 5 / 9) for text in
      ("degF", "deg F", "°F", "Fahrenheit", "DEGF")],
    Label("C", 1.0, "temperature", "K", _KELVIN, stated=True),
    Label("F", 5 / 9, "temperature", "K", 459.67 * 5 / 9, stated=True),
    *[Label(text, 20e-6, "sound_pressure", "Pa", level=True, stated=True) for text in
      ("dB re 20 uPa", "dB (re 20 µPa)", "dB SPL", "dB(SPL)", "dB re 20e-6 Pa", "dB rel. 20 uPa", "dB//20uPa")],
    Label("dBV", 1.0, "voltage", "V", level=True), Label("dB re 1 V", 1.0, "voltage", "V", level=True),
]
#: what no channel has, or what may be several: to be asked back, whatever is measured
ASKED_BACK = ("EU", "eu", "", "mol", "dB", "dB(A)", "dBA", "dB(C)", "kG", "xyz", "V/g", "m^7", "Pa^3", "units",
              "g/N", "tbd", "ton", "N/A", "mm pk-pk", "G p-p", "sone", "n.a.", "raw", "mV/Pa", "grad", "cd",
              "kg^2", "???", "#", "a.u.", "None", "Sv")


def drawn(rng, stated):
    """A Label of a quantity drawn at random; ``stated``: whether the case states what is measured."""
    usable = [one for one in LABELS if stated or not one.stated]
    quantity = rng.choice(sorted({one.measured for one in usable}))
    of_it = [one for one in usable if one.measured == quantity]
    return of_it[int(rng.integers(len(of_it)))]

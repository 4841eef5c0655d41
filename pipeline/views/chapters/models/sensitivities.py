"""Chapter: what moves the unstable modes, and what would make the strongest stable?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.models import sensitivities as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

TWO_PI = 2.0 * np.pi
#: rows of the ranked table, modes with a figure of their own
_ROWS, _DRAWN = 12, 2
#: errors below this share of a change are not worth a digit
_EXACT = 5e-3
WORDS = {
    "friction": "friction", "friction_over_pressure": "friction over pressure",
    "friction_over_speed": "friction over speed", "contact_stiffness": "contact stiffness",
    "complex_modes.damping_speed": "contact damping speed", "structure.pressures": "pressure",
    "complex_modes.speeds": "drive speed", "structure.joints.loss_time": "loss time of joints",
    "structure.pad.lining_young": "lining modulus", "structure.pad.backplate_young": "backplate modulus",
    "structure.pad.lining_loss_factor": "lining loss factor", "structure.pad.densities": "pad density",
    "structure.pad.backplate_loss_factor": "backplate loss factor"}


def chapter(product, convergence, look):
    """Chapter of the product Sensitivities."""
    if not len(product.mode):
        return Chapter("sensitivities", "What matters", "No unstable mode was examined: there is none, or none was"
                       " asked for.", "No sensitivities.")
    return Chapter(
        "sensitivities", "What matters",
        f"Derivatives of the growth rate of {plural(len(product.mode), 'unstable mode')} to"
        f" {plural(len(product.parameter), 'value')} of the brake, from left and right vectors about the sliding state"
        " that each value leads to. Values rank by what one standard deviation of them changes: as the case declares"
        f" it, or {percent(product.unstated_scatter)} of the value where it declares none."
        f" {_certainty(product, convergence)}",
        statement(product), tuple(_figure(product, k) for k in range(min(len(product.mode), _DRAWN))),
        tuple(filter(None, (_ranked(product), _remedies(product), _all(product), _left_out(product)))))


def statement(product):
    """What matters most for the mode that grows most, and what to change to make it stable; '' without modes."""
    if not len(product.mode):
        return ""
    first, *others = _order(product, 0)[:3]
    rate = _growth(product.mode_root[0].real)
    most = (f"What matters most for the mode at {_frequency(product, 0)} (growth rate {rate} at {_where(product, 0)})"
            f" is {_the(product, first)}: one standard deviation more of it"
            f" ({_scatter(product, 0, first)}) {_effect(product, 0, first)}")
    if others:
        most += ", then " + " and ".join(
            f"{_the(product, p)} ({_scatter(product, 0, p)} {_effect(product, 0, p)})" for p in others)
    return f"{most}. {_to_do(product)}"


def in_words(name):
    """A value in plain words: 'structure.joints.shim_stiffness' -> 'shim stiffness'."""
    name = str(name)
    if name in WORDS:
        return WORDS[name]
    *parts, last = name.removeprefix("structure.").removeprefix("joints.").split(".")
    parts = ["fluid"] if parts == ["piston", "fluid"] else parts
    return " ".join([*parts, "Young's modulus" if last == "young" else last]).replace("_", " ")


def written(product, parameter, value):
    """A value with its unit."""
    return quantity(value, str(product.unit[parameter]), 3)


def _order(product, mode):
    """Indices of the values by rank, those that are known."""
    ranked = np.argsort(product.rank[mode], kind="stable")
    return [int(p) for p in ranked if product.rank[mode, p]]


def _the(product, parameter):
    words = in_words(product.parameter[parameter])
    return words if words.startswith("friction") or words == "pressure" else f"the {words}"


def _growth(rate):
    return quantity(rate, "1/s", 3)


def _frequency(product, mode):
    return quantity(product.mode_root[mode].imag / TWO_PI, "Hz", 3)


def _where(product, mode):
    return f"{quantity(product.pressure[mode], 'Pa', 3)} and {quantity(product.speed[mode], 'rad/s')}"


def _effect(product, mode, parameter):
    change = product.change[mode, parameter]
    return f"{'adds' if change > 0 else 'takes away'} {_growth(abs(change))}"


def _scatter(product, mode, parameter):
    """One standard deviation: '29 %' of the value, or in its unit where the value is 0."""
    value, width = product.value[mode, parameter], product.scatter[mode, parameter]
    return percent(width / abs(value), 2) if value else written(product, parameter, width)


def _to_do(product):
    found = [_instead(product, p, value) for p, value, root in _tried(product) if root.real <= 0]
    if not found:
        return "No single value that was tried makes it stable." if len(product.remedy_value) else \
            "No single value, changed as far as parts usually can be, makes it stable to first order."
    alone = ", each alone" if len(found) > 1 else ""
    return f"It becomes stable with {', or with '.join(found)}{alone}; other modes are to be computed anew then."


def _tried(product):
    return [(int(p), float(value), root) for mode, p, value, root in
            zip(product.remedy_mode, product.remedy_parameter, product.remedy_value, product.remedy_root, strict=True)
            if mode == 0]


def _instead(product, parameter, value):
    """'friction 23 % lower (0.63 to 0.48)', 'a loss factor ... of 0.09 instead of 0.03'."""
    now, words = product.value[0, parameter], in_words(product.parameter[parameter])
    if words.endswith("loss factor"):
        return f"a {words} of {number(value, 2)} instead of {number(now, 2)}"
    amount = percent(abs(value / now - 1), 2)
    return (f"{_the(product, parameter)} {amount} {'higher' if value > now else 'lower'}"
            f" ({written(product, parameter, now)} to {written(product, parameter, value)})")


def _figure(product, mode):
    shown = _order(product, mode)[:_ROWS]
    names = [in_words(product.parameter[p]) for p in shown]
    widths = [_scatter(product, mode, p) for p in shown]
    about = (f"Mode at {_frequency(product, mode)}, growth rate {_growth(product.mode_root[mode].real)} at"
             f" {_where(product, mode)}: change of the growth rate by one standard deviation more of each value, which"
             " is written beside its bar. Red: less stable; blue: more stable; hatched: scatter not declared. Dashed:"
             " stable beyond.")
    return Figure(pictures.tornado(product, mode, shown, names, widths), about)


def _ranked(product):
    growth, rows = product.root[0].real, []
    for p in _order(product, 0)[:_ROWS]:
        derivative, value = product.derivative[0, p].real, product.value[0, p]
        rows.append((in_words(product.parameter[p]), written(product, p, value),
                     f"{_scatter(product, 0, p)}{'' if product.declared[p] else ', assumed'}",
                     _with_error(product.change[0, p], product.error[0, p] * product.scatter[0, p]),
                     _signed(derivative * value / 100) if value else "—", _needed(growth, derivative, value),
                     str(product.parameter[p])))
    return Table(("value", "now", "scatter", "adds, 1/s", "per 1 %, 1/s", "stable at", "setting or factor"),
                 tuple(rows), f"What one standard deviation (scatter) adds to the growth rate of the mode at"
                 f" {_frequency(product, 0)}; the change at which it is stable is to first order", (1, 2, 3, 4, 5))


def _with_error(change, error):
    return _signed(change) + (f" ± {number(error, 1)}" if error > _EXACT * abs(change) else "")


def _needed(growth, derivative, value):
    """By how much the value would have to change to take all growth, to first order."""
    change = -growth / (derivative * value) if value and derivative else np.inf
    if abs(change) > 1:
        return "—"
    return f"{'+' if change > 0 else '−'}{percent(abs(change), 2)}"


def _signed(value):
    return f"{'+' if value > 0 else ''}{number(value, 3)}"


def _remedies(product):
    rows = tuple((in_words(product.parameter[p]), written(product, p, product.value[0, p]), written(product, p, value),
                  _signed(root.real), _growth(product.root[0].real)) for p, value, root in _tried(product))
    return rows and Table(("value", "now", "then", "growth rate then, 1/s", "growth rate now"), rows,
                          f"Tried in the reduced model for the mode at {_frequency(product, 0)}, one value at a time",
                          (1, 2, 3, 4))


def _all(product):
    modes = range(len(product.mode))
    order = np.argsort(-np.max(abs(product.change), axis=0), kind="stable")
    rows = tuple((in_words(product.parameter[p]), *(_signed(product.change[k, p]) if product.known[k, p] else "—"
                                                    for k in modes), str(product.method[p]),
                  str(product.parameter[p])) for p in order)
    head = ("value", *(f"{_frequency(product, k)}" for k in modes), "method", "setting or factor")
    return Table(head, rows, "All values and modes: what one standard deviation adds to the growth rate, 1/s",
                 tuple(range(1, len(head) - 2)), (), True)


def _left_out(product):
    rows = tuple(zip(map(str, product.left_out), map(str, product.left_out_reason), strict=True))
    return Table(("values", "why"), rows, "Not computed", (), (1,), True)


def _certainty(product, convergence):
    text = ("Uncertainties hold the smoothing of the tables of contact law and friction map alone, up to"
            f" {_growth((product.known * product.error * product.scatter).max())} here.")
    if convergence is not None and len(convergence.root):
        text += (" Finer contact and meshes, and the reduction, change growth rates by up to"
                 f" {percent(convergence.growth_share, 2)}: derivatives are hardly better known.")
    return text

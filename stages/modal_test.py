"""Stage modal_test: modes from measured frequency responses."""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, ConvergenceError, Quantity, Section, option, stage
from pipeline.physics.modal.frf_identification import identify
from pipeline.products import ModalTest, ResponseFunctions, TestModes


class Settings(Section):
    """Band and orders of the identification."""

    lowest_frequency: Quantity("Hz", ge=0) | None = option(None, "begin of the band; none = that of the responses")
    highest_frequency: Quantity("Hz", gt=0) | None = option(None, "end of the band; none = that of the responses")
    band: Quantity("Hz", gt=0) = option("1 kHz", "the band is taken in parts of about this width, which overlap")
    order: int = option(40, "highest order of the denominator in a part", ge=4, le=200)
    pair_within: float = option(0.02, "share of their frequency within which two modes of other shapes are a pair",
                                gt=0, lt=1)


#: share of a part by which it reaches into its neighbours, where its modes are not kept, and by which its edges move
_OVERLAP, _MOVABLE = 0.25, 0.25
#: lines within the half-power band of a mode from which its damping comes out to 1 % under a lasting force
_WITHIN = 4
#: standard deviations by which a mode that grows is none of noise
_GROWN = 4.0
#: fewest lines of a part
_LEAST = 64
#: likeness of two shapes up to which modes close in frequency make a pair
_ALIKE = 0.5


@stage
def modal_test(responses: ResponseFunctions, settings: Settings, context: Context) -> ModalTest:
    """Identify natural frequencies, damping and shapes from measured frequency responses, with their uncertainty.

    Method:
    Poles of common denominators of rising order up to {order} (least squares complex frequency) were followed from
    order to order, in parts of the band of {band}; those that came back were refined together with their residues by
    weighted least squares over all responses until they moved by less than a hundredth of their standard deviations.
    Modes whose residues do not exceed four standard deviations, or that do not settle, were left out, and poles added
    or split where more than noise was left. Standard deviations are those of the least squares; the noise of each
    response, a constant and a share of its size, is told by what is left of it from line to line. What windows of
    blows, of correlations and of given responses add is taken off the decay rates.
    """
    return ModalTest(runs={name: _modes(name, test, settings, context) for name, test in responses.tests.items()})


def _modes(name, test, settings, context):
    """TestModes of the TestResponses of one test."""
    where, axis, response = f"modal_test: {name}", test.line, test.response
    low = axis[axis > 0.0][0] if settings.lowest_frequency is None else settings.lowest_frequency
    high = axis[-1] if settings.highest_frequency is None else settings.highest_frequency
    if not low < high or np.count_nonzero((axis >= low) & (axis <= high)) < _LEAST:
        raise ConfigError(where, f"{_LEAST} or more lines between {low:g} and {high:g} Hz",
                          f"{np.count_nonzero((axis >= low) & (axis <= high))} of {len(axis)}, {axis[0]:g} to"
                          f" {axis[-1]:g} Hz")
    dead = [str(key) for key, row in zip(test.label, response, strict=True) if not np.any(row)]
    if dead:
        raise ConfigError(where, "responses that are not 0 all over", ", ".join(dead), "leave them out of the file")
    parts = _parts(axis, response, low, high, settings.band)
    found = context.map(partial(_identified, axis=axis, response=response, most=settings.order), parts,
                        f"modes of {name}")
    free = [replace(one, pole=one.pole + test.decay) for one in found]
    _refuse_growing(where, test, free)
    kept = [(one, one.frequency >= first, one.frequency < last) for one, (first, last, *_) in zip(
        free, parts, strict=True)]
    fields = ("frequency", "frequency_std", "damping_ratio", "damping_ratio_std", "residue", "residue_std")
    modes = {field: np.concatenate([getattr(one, field)[above & below] for one, above, below in kept])
             for field in fields}
    inside = (axis >= low) & (axis <= high)
    return TestModes(
        **{field: modes[field] for field in fields[:4]}, narrow=_narrow(test, modes),
        partner=_partners(modes["frequency"], _likeness(modes["residue"]), settings.pair_within),
        place=list(test.place), reference=list(test.reference), shape=modes["residue"],
        shape_std=modes["residue_std"], likeness=_likeness(modes["residue"]),
        **_fit(axis, response, inside, found, parts), **_diagram(kept, parts, float(test.decay)))


def _refuse_growing(where, test, free):
    """Refuse a window, stated of given responses, that is more than the decay of a mode, whatever its error."""
    grown = [(f, p.real, d) for one in free for f, p, d in zip(one.frequency, one.pole, one.std[:, 0], strict=True)
             if p.real > _GROWN * d]
    if grown and str(test.method) == "given":
        frequency, rate, _ = max(grown, key=lambda row: row[1] / row[2])
        raise ConfigError(where, f"decay rates above that of the window, {test.decay:.4g} 1/s",
                          f"{test.decay - rate:.4g} 1/s at {frequency:.4g} Hz", "correct"
                          " response_functions.window_decay or window_end: what was measured under a window decays"
                          " faster than it")


def _narrow(test, modes):
    """(m,) 1 of modes whose half-power band holds few lines of responses that Hann segments of a lasting force gave."""
    width = 2 * modes["damping_ratio"] * modes["frequency"]
    return ((width < _WITHIN * (test.line[1] - test.line[0])) & ("lasting force" in str(test.method))).astype(int)


def _parts(axis, response, low, high, width):
    """[(first, last, lower, upper)] in Hz: modes of first to last are kept of the lines of lower to upper. Parts meet
    where the responses are small, so that no mode lies at an edge."""
    lines = np.count_nonzero((axis >= low) & (axis <= high))
    count = max(min(round((high - low) / width), lines // _LEAST), 1)
    edges = np.linspace(low, high, count + 1)
    size = np.sqrt(np.mean(abs(response) ** 2 / np.mean(abs(response) ** 2, axis=1, keepdims=True), axis=0))
    for k in range(1, count):
        near = np.flatnonzero(abs(axis - edges[k]) <= _MOVABLE * (high - low) / count)
        edges[k] = axis[near[size[near].argmin()]] if len(near) else edges[k]
    more = _OVERLAP * (high - low) / count
    return [(edges[k] if k else 0.0, edges[k + 1] if k + 1 < count else np.inf, max(edges[k] - more, low),
             min(edges[k + 1] + more, high)) for k in range(count)]


def _identified(part, axis, response, most):
    inside = (axis >= part[2]) & (axis <= part[3])
    try:
        return identify(axis[inside], response[:, inside], most)
    except np.linalg.LinAlgError as error:
        raise ConvergenceError(f"modal_test: {part[2]:g} to {part[3]:g} Hz", "equations that can be solved", str(error),
                               "choose another band") from None


def _likeness(shape):
    """Modal assurance criterion (m, m) of shapes (m, n)."""
    size = np.sum(abs(shape) ** 2, axis=1)
    return abs(shape.conj() @ shape.T) ** 2 / np.maximum(np.outer(size, size), 1e-300)


def _partners(frequency, likeness, within):
    """Mode (m,) that is nearest in frequency, of another shape, and says the same of this one; itself without such."""
    partner = np.arange(len(frequency))
    apart = abs(frequency[:, None] / frequency - 1.0) + 1e9 * (likeness > _ALIKE)
    if len(frequency) > 1:
        nearest = apart.argmin(axis=1)
        mutual = (nearest[nearest] == partner) & (apart[partner, nearest] < within)
        partner = np.where(mutual, nearest, partner)
    return partner


def _fit(axis, response, inside, found, parts):
    """Fields of what is measured and fitted over the lines, and of what is left of each response."""
    fitted = np.zeros_like(response)
    for one, (first, last, lower, upper) in zip(found, parts, strict=True):
        lines = (axis >= lower) & (axis <= upper) & (axis > 0.0)
        own = (axis[lines] >= first) & (axis[lines] < last)
        fitted[:, np.flatnonzero(lines)[own]] = one.fitted[:, own]
    measured, fitted = response[:, inside], fitted[:, inside]
    size = np.sqrt(np.mean(abs(measured) ** 2, axis=1))
    left = np.sqrt(np.mean(abs(measured - fitted) ** 2, axis=1))

    def together(values):
        return np.sqrt(np.mean(abs(values / np.maximum(size, 1e-300)[:, None]) ** 2, axis=0))

    return {"line": axis[inside], "measured": together(measured), "fitted": together(fitted),
            "noise": left / np.maximum(size, 1e-300)}


def _diagram(kept, parts, decay):
    """Fields of the stabilisation diagrams of all parts, the modes numbered through; ``decay`` 1/s is the window's."""
    rows, number = [], 0
    for (one, above, below), (first, last, *_) in zip(kept, parts, strict=True):
        renumbered = np.full(len(one.pole) + 1, -1)
        renumbered[:-1][above & below] = number + np.arange(np.count_nonzero(above & below))
        number += np.count_nonzero(above & below)
        diagram, pole = one.stabilisation, one.stabilisation.pole + decay
        size = abs(pole) / (2 * np.pi)
        own = (size >= first) & (size < last)
        rows.append((diagram.order[own], size[own], (-pole.real / abs(pole))[own],
                     diagram.stable[own].astype(int), renumbered[diagram.chosen[own]]))
    names = ("order", "pole_frequency", "pole_damping", "stable", "chosen")
    return {name: np.concatenate(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}

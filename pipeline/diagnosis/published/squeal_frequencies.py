"""Squeal lines without signals: whether lists of frequencies can say what made a brake squeal.

A model with a mode every 90 Hz has one near any line. A list therefore explains a line within its tolerance only if
as many lines at random in the band would be met rarely (1 %, shared by all lists that are tried).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from pipeline.contract import ConfigError, Quantity, Section, option
from pipeline.diagnosis.published.chance_agreement import Match, covered, match
from pipeline.diagnosis.published.frequency_lists import Alternative, Features, lines_of, list_problem
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.physics.modal.disc_modes import describe

#: what makes any mode sound; which of them grow hangs on damping that nobody has measured there
_ANY_MODE = (("flexible_disc", "multi-body loop"), ("falling_friction", "contact"), ("changing_load", "contact"))


class SquealLines(Section):
    """Squeal frequencies of a bench against the modes of the whole brake."""

    kind: Literal["squeal"] = "squeal"
    run: str = option(..., "recorded run")
    list: str = option(..., "list with its lines")
    low: Quantity("Hz", ge=0) = option(..., "lower end of the band in which lines at random are drawn")
    high: Quantity("Hz", gt=0) = option(..., "upper end")
    model_error: float = option(0.01, "relative error of the frequencies of the model, added to the tolerance of a"
                                      " line",
                                gt=0, lt=0.1)


@dataclass(frozen=True)
class Claim:
    """What would sound at ``lines`` (k,) Hz if ``effect`` were what the chain leaves out, and its Match."""

    effect: str
    location: str
    says: str
    lines: np.ndarray
    match: Match


def heard(recording, section):
    """Lines of the section ``section`` and the tolerance (n,) [Hz] of their agreement with a model."""
    seen = lines_of(recording, section.run, section.list)
    return seen, np.hypot(seen.frequency_tolerance, section.model_error * seen.frequency)


def claims(recording, section, modes):
    """Claims on the recorded lines from a product ComplexModes."""
    seen, tolerance = heard(recording, section)
    heaviest = np.lexsort((modes.operating_speed, modes.operating_pressure))[-1]
    every = np.unique(np.abs(modes.operating_root[heaviest].imag) / (2 * np.pi))
    if every.max() < section.high:
        raise ConfigError("diagnosis.lines.high", f"at most {every.max():.0f} Hz, where the complex modes end",
                          f"{section.high:.0f} Hz", "raise complex_modes.frequency_max")
    growing = np.abs(modes.unstable_root.imag) / (2 * np.pi)
    multiples = np.concatenate([np.empty(0), *(f * np.arange(2, section.high // f + 1) for f in growing)])
    listed = [("saturated_motion", "contact", "multiples of growing complex modes", multiples)]
    listed += [(*pair, "complex modes, growing or not", every) for pair in _ANY_MODE]
    band = section.low, section.high
    return tuple(Claim(effect, location, says, lines, match(seen.frequency, tolerance, lines, band))
                 for effect, location, says, lines in listed)


def squeal_problem(recording, section, claimed, rules=DEFAULTS):
    """DiagnosisProblem over which lines are explained: none by forces on a rigid disc, and by each of the Claims."""
    seen, tolerance = heard(recording, section)
    names = [str(n) for n in seen.label]
    features = {n: Features("explained", "1", [1.0], [rules.lists.half_std]) for n in names}
    nothing = {n: np.zeros(1) for n in names}
    return list_problem(features, nothing, [Alternative(c.effect, c.location, {
        n: np.array([float(rare and np.any(np.abs(c.lines - f) <= t))])
        for n, f, t in zip(names, seen.frequency, tolerance, strict=True)})
        for c, rare in zip(claimed, rarely(claimed, rules.lists), strict=True)], rules=rules)


def rarely(claimed, rules=DEFAULTS.lists):
    """True (c,) for Claims whose agreement is rare by chance, over all of them."""
    return [c.match.p_value <= rules.chance / len(claimed) for c in claimed]


def undecided(claimed, recording, section):
    """Indices of the Claims that meet every line, though lines at random would too."""
    count = len(lines_of(recording, section.run, section.list).frequency)
    return [i for i, c in enumerate(claimed) if c.match.matched == count]


def squeal_reasons(recording, section, claimed, modes, structure=None, rules=DEFAULTS.lists):
    """Sentences from the matches, and what precision or which shape would decide."""
    seen, tolerance = heard(recording, section)
    count, band = len(seen.frequency), (section.low, section.high)
    where = f"between {1e-3 * section.low:.3g} and {1e-3 * section.high:.3g} kHz"
    grow = np.count_nonzero(_within(np.abs(modes.unstable_root.imag) / (2 * np.pi), band))
    reasons = ["left out by the chain: the disc is rigid where forces are computed, which then excite its modes one"
               f" way; {count} lines were heard, and none follows from that",
               f"{grow or 'none'} of the complex modes {where} {'grow' if grow > 1 else 'grows'} in this model, whose"
               " pads, joints and damping there are assumed"]
    for c in claimed:
        count_in_band = np.count_nonzero(_within(c.lines, band))
        gain = f", ln density over random lines {c.match.gain:+.1f}" if count_in_band else ""
        reasons.append(f"{c.effect} ({c.says}): {count_in_band} lines {where}, {c.match.matched} of {count} heard ones"
                       " within tolerance; as many lines at random are met with probability"
                       f" {c.match.p_value:.2g}{gain}")
    spacing = (section.high - section.low) / max(np.count_nonzero(_within(claimed[-1].lines, band)), 1)
    needed = needed_tolerance(claimed[-1].lines, band, count, rules.chance)
    reasons.append(f"a mode every {spacing:.0f} Hz: for agreement of {count} lines to be rarer than"
                   f" {100 * rules.chance:g} % by chance they had to be known, and the model right, within"
                   f" {needed:.1f} Hz; print and model leave {tolerance.max():.0f} Hz: frequencies alone cannot decide")
    return reasons + (_of_shapes(seen, tolerance, structure, rules) if structure is not None else [])


def _within(lines, band):
    return (lines >= band[0]) & (lines <= band[1])


def needed_tolerance(lines, band, count, level=0.01):
    """Tolerance [Hz] at which ``count`` lines at random are all met with probability ``level``."""
    return float(scipy.optimize.brentq(lambda t: covered(lines, t, band) ** count - level, 0.0, band[1] - band[0]))


def _of_shapes(seen, tolerance, structure, rules):
    shape = structure.disc.shape
    diameters, axial = describe(structure.disc.node, shape.reshape(len(shape), -1).T)
    reasons = []
    for line, width in zip(seen.frequency, tolerance, strict=True):
        near = (np.abs(structure.disc.frequency - line) <= width) & (axial > rules.axial)
        diameters_near = ", ".join(str(n) for n in np.unique(diameters[near]))
        if diameters_near:
            reasons.append(f"modes of the disc alone within {width:.0f} Hz of {1e-3 * line:.3g} kHz have"
                           f" {diameters_near} nodal diameters: a scan that counts them chooses between"
                           " modes, which frequencies do not")
    return reasons

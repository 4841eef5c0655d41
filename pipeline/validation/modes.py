"""Modes and squeal frequencies as the paper's sections 3.3 and Table 1 state them."""

import numpy as np
import scipy

from pipeline.validation import ours

#: fact key or pattern -> product field
FIELDS = {"mode_*_simulation": "structure.free_frequency", "mode_*_test": "structure.free_frequency",
          "complex_mode_at_line_*": "complex_modes.operating_root", "squeal_line*": "squeal.event_frequency",
          "no_mode_excited": "squeal.event_order", "no_squeal_at_constant_load": "squeal.event_frequency"}

#: modes further apart than this factor are not the same mode
_FARTHEST = 1.25
#: cost of a forbidden pair
_NEVER = 1e3
#: half-width of the band in which neighbours of a squeal frequency are counted [Hz]
_NEIGHBOURHOOD = 1000.0
#: what responds, by the coupling of the stage response
_RESPONDING = {"disc": "disc alone", "released": "brake with open contacts", "assembly": "whole assembly"}
#: squeal events closer than this are one squeal frequency [Hz]: the last digit of the paper's
_ONE_LINE = 100.0


def disc_mode_rows(structure, facts):
    """Free-disc modes paired with the two columns of Table 1, each mode once per column.

    A mode may represent a row of its multiplicity (single = axisymmetric, pair = nodal diameters), and
    of its diameters where these can be inferred. Of all such pairings the one with the smallest sum
    of logarithmic frequency ratios is taken; pairs more than 25 % apart are rejected.
    """
    rows = {}
    for column in ("simulation", "test"):
        listed = [fact for fact in facts if fact.single is not None and fact.role == column]
        if listed:
            rows |= _paired(structure, listed)
    return rows


def _paired(structure, facts):
    wanted = np.array([fact.value if fact.read_as is None else fact.read_as for fact in facts])
    apart = np.abs(np.log(wanted[:, None] / structure.free_frequency))
    apart[~np.array([_fits(fact, structure.free_diameters) for fact in facts])] = _NEVER
    chosen = dict(zip(*scipy.optimize.linear_sum_assignment(np.minimum(apart, _NEVER)), strict=True))
    return {fact.key: _pair(structure, fact, chosen[i]) if i in chosen and apart[i, chosen[i]] < np.log(_FARTHEST)
            else ours(np.nan, "", _unpaired(structure, fact)) for i, fact in enumerate(facts)}


def _fits(fact, diameters):
    return (diameters == 0) == fact.single if fact.diameters is None else diameters == fact.diameters


def _pair(structure, fact, mode):
    by = "multiplicity" if fact.diameters is None else f"inferred nodal diameters ({fact.diameters})"
    return ours(structure.free_frequency[mode], f"free disc, {structure.free_diameters[mode]} nodal diameters,"
                f" {structure.free_out_of_plane[mode]:.0%} of its motion along the axis; paired by {by} and frequency:"
                " the paper prints no shape")


def _unpaired(structure, fact):
    kind = "single" if fact.single else "paired"
    return (f"no {kind} free-disc mode that is not yet paired lies within a factor of {_FARTHEST:g}; the computed ones"
            f" end at {structure.free_frequency.max(initial=0):.0f} Hz")


def system_mode_rows(modes, known):
    """The complex mode nearest each squeal frequency at the highest pressure and speed, with its neighbours counted."""
    heaviest = np.lexsort((modes.operating_speed, modes.operating_pressure))[-1]
    frequency = np.abs(modes.operating_root[heaviest].imag) / (2 * np.pi)
    rows = {}
    for key in ("complex_mode_at_line_1", "complex_mode_at_line_2"):
        if key in known:
            near = np.count_nonzero(np.abs(frequency - known[key]) <= _NEIGHBOURHOOD)
            nearest = frequency[np.argmin(np.abs(frequency - known[key]))] if near else np.nan
            rows[key] = ours(nearest, f"nearest root; {near} roots lie within {_NEIGHBOURHOOD:.0f} Hz, one every"
                             f" {2 * _NEIGHBOURHOOD / max(near, 1):.0f} Hz, so that agreement is weak evidence",
                             f"the complex modes end at {frequency.max():.0f} Hz")
    return rows


def squeal_rows(squeal, known):
    """Squeal events: their number, their distinct frequencies, and the one nearest each line of the test bench.

    A harmonic of a lower tone is audible too, but it is neither an excited mode nor a separate squeal frequency: it
    counts only where the test bench heard nothing at all.
    """
    frequency = np.sort(squeal.event_frequency[squeal.event_order == 1])
    lines = np.count_nonzero(np.diff(frequency) > _ONE_LINE) + bool(len(frequency))
    source = f"response of the {_RESPONDING[str(squeal.coupling)]}"
    harmonics, constant = squeal.event_frequency.size - len(frequency), "our pressure and speed are constant"
    basis = f"{source}; {harmonics or 'no'} harmonic{'' if harmonics == 1 else 's'} of lower tones excluded"
    rows = {"squeal_lines": ours(lines, f"distinct frequencies, more than {_ONE_LINE:.0f} Hz apart; {basis}"),
            "no_mode_excited": ours(len(frequency), f"events at all operating points and sensors, {basis}; {constant}"),
            "no_squeal_at_constant_load": ours(len(frequency) + harmonics, "events at all operating points and sensors,"
                                               f" {harmonics or 'none'} of them harmonics, {source}; {constant}")}
    for key in ("squeal_line_1", "squeal_line_2"):
        if key in known:
            nearest = frequency[np.argmin(np.abs(frequency - known[key]))] if len(frequency) else np.nan
            rows[key] = ours(nearest, f"nearest squeal event, {basis}", f"no squeal event in the {basis}")
    return rows

"""Settings whose influence asks for the case to be computed again, such as dimensions, which move the mesh.

    sensitivities:
      differences:
        - {setting: structure.disc.ring_thickness, variation: 0.01}
"""

import numpy as np

from pipeline.case_models.operating_points import MODES_ALONE
from pipeline.contract import ConfigError, Section, option
from pipeline.contract.settings import leaves
from pipeline.physics.stability.refinement import moved_roots

MORE, LESS = "more", "less"
#: stages whose settings may be varied
STAGES = ("surface", "micro_friction", "friction_map", "structure", "reduced_model")


class Difference(Section):
    """A setting that is raised and lowered by one standard deviation."""

    setting: str = option(..., "name of the setting, with its stage: structure.disc.ring_thickness")
    variation: float = option(0.01, "its standard deviation over its value, by which it is raised and lowered", gt=0,
                              lt=0.5)


def check_differences(sections, where):
    """ConfigError for differences of settings that are no numbers, or that are named twice."""
    named = [difference.setting for difference in sections["sensitivities"].differences]
    for k, difference in enumerate(sections["sensitivities"].differences):
        if named.index(difference.setting) != k:
            raise ConfigError(f"{where}.{k}", "each setting once", difference.setting, "state it once")
        _setting(sections, difference.setting, f"{where}.{k}.setting")


def raised_and_lowered(sections):
    """{name of a variant: {setting: value}} of the differences of a case."""
    changes = {}
    for k, difference in enumerate(sections["sensitivities"].differences):
        value, unit = _setting(sections, difference.setting, f"sensitivities.differences.{k}.setting")
        for end, factor in ((MORE, 1 + difference.variation), (LESS, 1 - difference.variation)):
            written = f"{value * factor!r} {unit}" if unit else value * factor
            changes[f"{difference.setting}.{end}"] = {**MODES_ALONE, difference.setting: written}
    return changes


def _setting(sections, name, where):
    """(value, SI unit) of a setting."""
    stage, _, key = name.partition(".")
    numbers = {leaf.key: (leaf.value, leaf.unit) for leaf in leaves(sections[stage])
               if isinstance(leaf.value, float) and leaf.value} \
        if stage in STAGES and stage in sections else {}
    if key not in numbers:
        near = f"one of {', '.join(f'{stage}.{known}' for known in list(numbers)[:8])}, ..." if numbers else \
            f"a setting of {', '.join(STAGES)}"
        raise ConfigError(where, near, repr(name), "name a setting that is a number other than 0")
    return numbers[key]


def by_differences(differences, modes, chosen, varied, card):
    """Fields of the product Sensitivities over the Differences, of the ``chosen`` unstable modes.

    ``varied``: ComplexModes of the variants; ``card``: what the case says of itself, for values and their units.
    """
    count, none = len(differences), np.zeros((len(chosen), len(differences)))
    table = {"parameter": [d.setting for d in differences], "unit": ["1"] * count, "method": ["differences"] * count,
             "source": [""] * count, "declared": [1] * count, "value": none.copy(), "scatter": none.copy(),
             "derivative": none.astype(complex), "error": none.copy(), "known": none.astype(int)}
    for k, difference in enumerate(differences):
        stage, _, key = difference.setting.partition(".")
        value = abs(float(card.settings.get(stage, {}).get(key, 1.0)))
        table["unit"][k] = card.units.get(stage, {}).get(key) or "1"
        table["value"][:, k], table["scatter"][:, k] = value, difference.variation * value
        high, low = (_found(modes, chosen, varied[f"{difference.setting}.{end}"]) for end in (MORE, LESS))
        there = np.isfinite(high) & np.isfinite(low)
        step, middle = difference.variation * value, modes.unstable_reduced[chosen]
        table["derivative"][there, k] = ((high - low) / (2 * step))[there]
        table["error"][there, k] = (abs((high + low).real / 2 - middle.real) / step)[there]
        table["known"][:, k] = there
    return table


def _found(modes, chosen, other):
    """The ``chosen`` unstable modes (r,) in another case with the same operating points; nan where not found."""
    found = np.full(len(chosen), complex(np.nan, np.nan))
    for operating in set(modes.unstable_operating[chosen].tolist()):
        here = np.flatnonzero(modes.unstable_operating == operating)
        moved = moved_roots(modes.unstable_reduced[here], other.operating_root[operating], 0.0).root
        for k, mode in enumerate(chosen):
            if mode in here:
                found[k] = moved[list(here).index(mode)]
    return found

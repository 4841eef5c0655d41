"""Declared countermeasures: what each changes and costs, and which ones are refused.

    countermeasures:
      variants:
        shim:
          change: {structure.pad.backplate_loss_factor: 0.05, structure.joints.finger_loss_factor: 0.1}
          cost: {mass: 0.1 kg, price: 2 EUR}
          note: constrained-layer shim on both pads
"""

import re
from difflib import get_close_matches
from typing import Any

from pipeline.case_models.operating_points import MODES_ALONE
from pipeline.contract import ConfigError, Section, option
from pipeline.contract.received.names import checked_all

#: stages whose settings make modes
OF_MODES = ("lumped", "surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
            "complex_modes")
#: settings that must stay, and why
_FIXED = {"structure.pressures": "operating points are compared one by one",
          "lumped.load_factors": "operating points are compared one by one",
          "complex_modes.speeds": "operating points are compared one by one",
          "complex_modes.squeal_from": "squeal is counted alike before and after",
          **dict.fromkeys(MODES_ALONE, "variants are computed in the reduced model, without a sweep over friction")}
#: how the names of variants begin in the run folder, where other stages have theirs
PREFIX = "countermeasures."
_COST = re.compile(r"\s*(?P<number>[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)\s*(?P<unit>[^\d\s].*)?")


class Variant(Section):
    """One countermeasure."""

    change: dict[str, Any] = option({}, "settings that it changes, as 'stage.key': value")
    cost: dict[str, str | float] = option(
        {}, "what it costs, in columns of your own: a number with or without a unit, such as mass: 0.1 kg")
    note: str = option("", "what it is")


def changes(variants, more):
    """{name of a variant in the run folder: {'stage.key': value}} of declared ``variants``, with what all change."""
    return {f"{PREFIX}{name}": {**variant.change, **MODES_ALONE, **more} for name, variant in variants.items()}


def check_declared(variants, known):
    """ConfigError for variants that change nothing or what leaves modes alone, and for costs that are no numbers.

    ``known``: names of the stages of the chain.
    """
    where = "countermeasures.variants"
    for name, variant in checked_all(dict(variants), where).items():
        if not variant.change:
            raise ConfigError(f"{where}.{name}.change", "at least one setting that it changes", "none",
                              "state it as 'stage.key': value, or leave the variant out")
        for key, value in variant.change.items():
            check_key(f"{where}.{name}.change", key, value, known)
    costs(variants)


def check_key(where, key, value, known):
    """ConfigError where a variant may not change the setting ``key``; ``known``: names of the stages of the chain."""
    stage, dot, _ = key.partition(".")
    if stage not in known or not dot and not (isinstance(value, dict) and value):      # a whole section may be given
        near = get_close_matches(stage, [name for name in known if name in OF_MODES], 1)
        raise ConfigError(where, "'stage.key' with a stage of the chain", repr(key),
                          f"did you mean '{near[0]}'?" if near and dot else "such as structure.disc.young")
    if stage not in OF_MODES:
        raise ConfigError(where, f"settings of {', '.join(name for name in known if name in OF_MODES)}, which modes"
                          " depend on", repr(key), "change that in the case itself: it holds before and after")
    if key in _FIXED:
        raise ConfigError(where, "settings that may differ", f"{key!r}: {_FIXED[key]}", "change it in the case itself")


def check_different(sections, varied):
    """ConfigError for variants that leave the case as it is, that are equal, or that have other operating points.

    ``sections`` {stage: settings} of the case, ``varied`` {name of a variant: the same}.
    """
    seen = {"": _of_modes(sections)}
    for name, settings in varied.items():
        shown, given = f"countermeasures.variants.{name.removeprefix(PREFIX)}", _of_modes(settings)
        for stage, key in (each.split(".") for each in _FIXED if each not in MODES_ALONE):
            if stage not in sections:
                continue
            there, here = (getattr(each[stage], key) for each in (settings, sections))
            if there != here:
                raise ConfigError(shown, f"the {stage}.{key} of the case", str(there), _FIXED[f"{stage}.{key}"])
        same = [other for other, known in seen.items() if known == given]
        if same:
            raise ConfigError(shown, "settings that differ from those of the case and of all other variants",
                              f"those of {same[0].removeprefix(PREFIX) or 'the case'}", "change another value, or leave"
                              " it out")
        seen[name] = given


def _of_modes(sections):
    """All settings that modes depend on, without those that variants are computed with."""
    plain = {name: sections[name].model_dump() for name in OF_MODES if name in sections}
    for key in MODES_ALONE:
        stage, _, field = key.partition(".")
        plain[stage].pop(field, None)
    return plain


def costs(variants):
    """[(column, unit, {name of a variant: number})] in the order of the YAML; ConfigError for what is no number."""
    stated = {name: variant.cost for name, variant in variants.items()}
    columns = cost_columns(stated, "countermeasures.variants", "variants")
    return [(column, unit, numbers) for column, (unit, numbers) in columns.items()]


def cost_columns(stated, where, owners):
    """{column: (unit, {name: number})} of costs ``stated`` {name: {column: as written}} by ``owners`` at ``where``;
    ConfigError for what is no number, or in another unit than before."""
    columns = {}
    for name, costs_of in stated.items():
        for column, given in costs_of.items():
            here = f"{where}.{name}.cost.{column}"
            number, unit = _number(given, here)
            known, numbers = columns.setdefault(column, (unit, {}))
            if unit != known:
                raise ConfigError(here, f"{known or 'no unit'}, as in the {owners} before", repr(unit or "none"),
                                  "state each cost in one unit")
            numbers[name] = number
    return columns


def _number(given, where):
    read = _COST.fullmatch(given) if isinstance(given, str) else None
    if isinstance(given, str) and read is None:
        raise ConfigError(where, "a number, with or without a unit, such as 0.1 kg", repr(given)[:100])
    return (float(read["number"]), (read["unit"] or "").strip()) if read else (float(given), "")


def in_words(changed):
    """'structure.pad.lining_thickness: 9 mm; ...' of what a variant changes."""
    return "; ".join(f"{key}: {value}" for key, value in changed.items())

"""The declared design space: which settings may change, how far, and which declarations are refused.

    design_search:
      space:
        structure.joints.finger_stiffness: {from: 100 MN/m, to: 800 MN/m, log: true}
        structure.pad.lining_thickness: {from: 8 mm, to: 12 mm, cost: {price: 1 EUR}}
        structure.bracket.kind: {values: [ground, body]}
"""

from typing import Any

from pipeline.case_models.countermeasures.declared import OF_MODES, check_key, cost_columns
from pipeline.contract import ConfigError, option, section
from pipeline.contract.settings import leaves
from pipeline.contract.units import to_si

#: one value of the space; ``from`` is a word of Python and no name of a class body
Range = section("Range", "How far one setting may go: between two ends, or one of a list.", {
    "from": (str | float | None, option(None, "lower end, with its unit")),
    "to": (str | float | None, option(None, "upper end, with its unit")),
    "values": (tuple[Any, ...], option((), "instead of two ends: the values that it may have")),
    "log": (bool, option(False, "steps are shares of the value, as for stiffnesses over decades")),
    "cost": (dict[str, str | float], option(
        {}, "what moving it from one end to the other costs, or another value of a list than that of the case, in"
            " columns of your own such as mass: 0.1 kg"))})


def stated(sections):
    """{'stage.key': (value, SI unit)} of all settings."""
    return {f"{stage}.{leaf.key}": (leaf.value, leaf.unit) for stage, each in sections.items() for leaf in leaves(each)}


def numbers(every):
    """Those of ``every`` setting, as of ``stated``, that may lie between two ends."""
    return {name: (value, unit) for name, (value, unit) in every.items() if isinstance(value, float)}


def ends(name, given, unit):
    """(lower, upper) in SI of a Range with two ends; ConfigError for units that do not fit and ends at odds."""
    where = f"design_search.space.{name}"
    for end in ("from", "to"):
        if getattr(given, end) is None:
            raise ConfigError(f"{where}.{end}", "from and to, or values: [...]", "none", "state both ends of its range")
    low, high = (to_si(getattr(given, end), unit or "1", f"{where}.{end}") for end in ("from", "to"))
    if not low < high:
        raise ConfigError(where, "a lower end below the upper one",
                          f"from {getattr(given, 'from')} to {given.to}", "exchange them")
    if given.log and low <= 0:
        raise ConfigError(f"{where}.from", "a lower end above 0 where log is true", repr(getattr(given, "from")))
    return low, high


def check_space(sections):
    """ConfigError for a space that cannot be searched: names, units, ends, lists, costs and budget."""
    settings = sections["design_search"]
    if not settings.space:
        return
    known = numbers(stated({stage: each for stage, each in sections.items() if stage in OF_MODES}))
    for name, given in settings.space.items():
        where = f"design_search.space.{name}"
        check_key(where, name, None, tuple(sections))
        if given.values:
            _check_list(where, given)
        elif name in known:
            ends(name, given, known[name][1])
        elif getattr(given, "from") is not None or given.to is not None:
            raise ConfigError(where, "a setting that is a number with a unit or a fraction, to lie between two ends",
                              "none of the case" + _near(name, known), "name one, or state values: [...]")
        else:
            raise ConfigError(where, "from and to, or values: [...]", "neither")
    _check_costs(settings)
    if settings.budget < settings.starts:
        raise ConfigError("design_search.budget", f"at least one brake for each of the {settings.starts} starts",
                          str(settings.budget), "raise it, or lower design_search.starts")


def _near(name, known):
    from difflib import get_close_matches

    near = get_close_matches(name, known, 1)
    return f", did you mean '{near[0]}'?" if near else ""


def _check_list(where, given):
    if getattr(given, "from") is not None or given.to is not None or given.log:
        raise ConfigError(where, "either from and to, or values", "both", "take one away")
    if len(given.values) < 2 or len({repr(v) for v in given.values}) < len(given.values):
        raise ConfigError(f"{where}.values", "at least two values, each once", repr(list(given.values))[:100])


def columns(settings):
    """{column: (unit, {name of a value: cost of its whole range})}; ConfigError for what is no number."""
    return cost_columns({name: given.cost for name, given in settings.space.items()}, "design_search.space", "values")


def _check_costs(settings):
    known = columns(settings)
    for column in settings.weight:
        if column not in known:
            raise ConfigError(f"design_search.weight.{column}", f"a column of costs of the space"
                              f"{': ' + ', '.join(known) if known else ', which states none'}", repr(column),
                              "state cost: {...} beside the values that have it")


def at_ends(settings):
    """{name: changes} of the case with each value at each of its ends, all others as in the case."""
    return {f"design_search.space.{name}.{end}": {name: value} for name, given in settings.space.items()
            for end, value in (enumerate(given.values) if given.values else
                               ((end, getattr(given, end)) for end in ("from", "to")))}

"""Stage comparison: every published fact beside the number computed here, with tolerance and doubt."""

from dataclasses import fields
from fnmatch import fnmatch

from pipeline.contract import ConfigError, Context, InputFile, Products, Section, option, stage
from pipeline.products import Comparison
from pipeline.validation import beam_on_beam, disc_brake, field_of, lumped, matrices, pin_on_disc, rupture
from pipeline.validation.published_facts import load

#: product that only one system has -> rows (products, facts, known) -> {key: Ours}, and the product field of each
#: fact key; the first product that is present counts
SYSTEMS = {"structure": (disc_brake.disc_brake_rows, disc_brake.FIELDS),
           "pin_on_disc": (pin_on_disc.pin_on_disc_rows, pin_on_disc.FIELDS),
           "beam_on_beam": (beam_on_beam.beam_on_beam_rows, beam_on_beam.FIELDS),
           "lumped": (lumped.lumped_rows, lumped.FIELDS), "rupture": (rupture.rupture_rows, rupture.FIELDS),
           "matrices": (matrices.matrix_rows, matrices.FIELDS)}

#: size in SI of the printed units that the chains compute
SIZE = {"1": 1.0, "%": 0.01, "um": 1e-6, "mm": 1e-3, "m": 1.0, "us": 1e-6, "ms": 1e-3, "s": 1.0, "1/s": 1.0, "Hz": 1.0,
        "rad/s": 1.0, "mm/s": 1e-3, "m/s": 1.0, "N": 1.0, "kg": 1.0, "MPa": 1e6, "GPa": 1e9,
        "deg": 0.017453292519943295}
_REASON = {"condition": "a condition of the authors' work, not a result", "derived": "follows from other rows",
           "input": "an input of the authors, not a result"}
_UNCOMPUTED = "not computed by this chain"


class Settings(Section):
    """Reference of the case, and the facts that it was tuned to."""

    reference: InputFile | None = option(None, "published facts, e.g. data/reference/disc_brake.yaml; none = no rows")
    tuned: dict[str, str] | None = option({}, "key of a fact, or a pattern such as mode_*_test: what was tuned on it")


def _check(sections):
    """Refuse an unreadable reference, or tuned keys that are not in it, before anything is computed."""
    settings = sections["comparison"]
    _tuned(settings.tuned or {}, load(settings.reference) if settings.reference else ())


@stage(check=_check)
def comparison(products: Products, settings: Settings, context: Context) -> Comparison:
    """Compare published numbers with ours.

    A statement without a number is compared if it bounds one of our numbers. Inputs are shown but not
    compared: choosing the same value as the authors is not evidence. A misprinted value is shown as
    printed and its row is not counted. Every row carries its fact key and the
    product field that our value comes from.

    Method:
    Published facts are read from {reference}; each of our values is computed from the products of this case. Modes in
    tables are paired by multiplicity, by nodal diameter if it can be inferred, and then by frequency.
    """
    facts = load(settings.reference) if settings.reference else ()
    tuned = _tuned(settings.tuned or {}, facts)
    known = known_values(facts)
    rows_of, fields_by_key = _system_of(products)
    ours = rows_of(products, facts, known)
    for fact in facts:
        if fact.key in ours and fact.unit not in SIZE:
            raise ConfigError(f"{settings.reference}: {fact.key}.unit", f"one of {', '.join(SIZE)}", repr(fact.unit))
    rows = [_row(fact, ours.get(fact.key), fields_by_key, tuned.get(fact.key, "")) for fact in facts]
    return Comparison(**{field.name: [row[field.name] for row in rows] for field in fields(Comparison)})


def known_values(facts):
    """{key: value in SI} of the facts with a value in a unit that the chains compute."""
    return {fact.key: fact.value * SIZE[fact.unit] for fact in facts if fact.value is not None and fact.unit in SIZE}


def _system_of(products):
    """Function that computes the rows, and their product fields, of the system of ``products``; none if unknown."""
    return next((system for name, system in SYSTEMS.items() if name in products), (lambda *_: {}, {}))


def _tuned(patterns, facts):
    """Fact key -> what was tuned on it."""
    for pattern in patterns:
        if facts and not any(fnmatch(fact.key, pattern) for fact in facts):
            raise ConfigError(f"comparison.tuned.{pattern}", "a key of the reference file, or a pattern of keys",
                              "no match", f"examples of keys: {', '.join(fact.key for fact in facts[:3])}")
    return {fact.key: what for pattern, what in patterns.items() for fact in facts if fnmatch(fact.key, pattern)}


def _row(fact, ours, fields_by_key, tuned):
    """The fields of one row."""
    value = None if ours is None or ours.value is None else ours.value / SIZE[fact.unit]
    verdict, counted = _verdict(fact, value)
    statement = f"the paper says: {fact.statement}" if fact.statement else ""
    origin = _REASON.get(fact.role, _UNCOMPUTED) if ours is None else ours.note
    field = "" if ours is None else ours.field or field_of(fact.key, fields_by_key)
    return {"row": fact.quantity, "key": fact.key, "field": field, "section": fact.part, "unit": fact.unit,
            "published": fact.value or 0.0, "published_known": int(fact.value is not None), "ours": value or 0.0,
            "ours_known": int(value is not None), "tolerance": (fact.tolerance or 0.0) * counted,
            "bounds": bounds(fact), "verdict": verdict, "tuned": tuned, "source": fact.source, "doubt": fact.doubt,
            "note": "; ".join(filter(None, (statement, origin, _reading(fact, value))))}


def _verdict(fact, value):
    """Verdict, and whether the row counts as compared."""
    if value is None or not fact.comparable or fact.role == "input" or fact.read_as is not None:
        return "not comparable", False
    return ("within" if fact.met_by(value) else "outside"), True


def bounds(fact):
    """'at least 1', 'at most 0.2', '-0.005 to 0.005' or 'exactly 4'; '' for a fact without bounds."""
    if not fact.bounded:
        return ""
    if None in (fact.lower, fact.upper):
        return f"at most {fact.upper:g}" if fact.lower is None else f"at least {fact.lower:g}"
    return f"exactly {fact.lower:g}" if fact.lower == fact.upper else f"{fact.lower:g} to {fact.upper:g}"


def _reading(fact, value):
    if fact.read_as is None or value is None:
        return ""
    return (f"not counted, because the printed value is doubted; {'within' if fact.met_by(value) else 'outside'} the"
            f" tolerance of {fact.tolerance:g} {fact.unit} about {fact.read_as:g} {fact.unit}, the value it is read as")

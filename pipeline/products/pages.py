"""The comparison with the source, and the report."""

from pipeline.contract import Array, count, product, quantity, text


@product(version=2)
class Comparison:
    """Published values beside ours, row by row."""

    row: Array = text("row", "name of the quantity")
    key: Array = text("row", "key of the fact in the reference file")
    field: Array = text("row", "product and field that our value comes from, e.g. micro_friction.real_area; empty where none")
    section: Array = text("row", "part of the source, as named in its reference file")
    unit: Array = text("row", "unit in which the row is shown")
    published: Array = quantity("1", "row", "published value in that unit (0 where none)")
    published_known: Array = count("row", "1 where the paper gives a value")
    ours: Array = quantity("1", "row", "our value in that unit (0 where none)")
    ours_known: Array = count("row", "1 where the chain computes the quantity")
    tolerance: Array = quantity("1", "row", "tolerance in that unit (0 where the row is not compared by a tolerance)")
    bounds: Array = text("row", "what a statement without a number implies for our value, in that unit; empty where nothing")
    verdict: Array = text("row", "within, outside, or not comparable")
    tuned: Array = text("row", "what was tuned to reach the row, empty where nothing")
    source: Array = text("row", "where the paper says so")
    doubt: Array = text("row", "doubt about the published value, empty where none")
    note: Array = text("row", "how our value was formed")


@product(version=2)
class Report:
    """The report page of a case, and its verdict for other programs."""

    html: Array = text("", "self-contained page")
    verdict: Array = text("", "verdict.json, schema brakechain-verdict/1: SI units, null where unknown")

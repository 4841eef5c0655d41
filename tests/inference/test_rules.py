"""The rules as a table: complete, with units and meanings."""

from dataclasses import fields, replace

from pipeline.inference.rules import DEFAULTS, Rules


def test_every_threshold_is_a_row_with_its_value_in_force():
    strict = replace(DEFAULTS, decision=replace(DEFAULTS.decision, posterior=0.99))
    rows = strict.rows()
    assert len(rows) == sum(len(fields(group.type)) for group in fields(Rules)) == len({name for name, *_ in rows})
    assert {name: value for name, value, *_ in rows}["decision.posterior"] == 0.99
    assert all(unit in ("1", "nat") and meaning for *_, unit, meaning in rows)

"""Combinations that were tried, in the product and for machines."""

from types import SimpleNamespace

from pipeline.diagnosis.output.combinations import NOT_REFITTED, as_rows, combinations
from pipeline.inference.search.selection import Combination

TRIED = (Combination(("coulomb at mount", "cubic_stiffness at mount"), 12.5, 130.0, 1.1, "named"),
         Combination(("coulomb at mount",), 3.0))


def test_every_combination_is_told_with_what_became_of_it():
    told = as_rows(SimpleNamespace(**combinations(SimpleNamespace(combinations=TRIED))))
    assert told[0] == {"effects": ["coulomb at mount", "cubic_stiffness at mount"], "evidence_gain": 12.5,
                       "objective": 130.0, "held_out_error": 1.1, "outcome": "named"}
    assert told[1]["objective"] is None and told[1]["held_out_error"] is None and told[1]["outcome"] == NOT_REFITTED


def test_without_any_there_are_no_rows():
    assert as_rows(SimpleNamespace(**combinations(SimpleNamespace(combinations=())))) == []

"""Combinations that were tried, in the product and for machines."""

from types import SimpleNamespace

from pipeline.diagnosis.output.combinations import NOT_REFITTED, as_rows, combinations
from pipeline.inference.search.selection import Combination

TRIED = (Combination(("coulomb at mount", "cubic_stiffness at mount"), 12.5, 130.0, 1.1, "named", 0.02,
                     (("coulomb@mount.force", 0.19, "N"), ("cubic_stiffness@mount.coefficient", 2e4, "N/m^3"))),
         Combination(("coulomb at mount",), 3.0))


def test_every_combination_is_told_with_what_became_of_it():
    told = as_rows(SimpleNamespace(**combinations(SimpleNamespace(combinations=TRIED))))
    assert told[0] == {"effects": ["coulomb at mount", "cubic_stiffness at mount"], "evidence_gain": 12.5,
                       "objective": 130.0, "held_out_error": 1.1, "leaves": 0.02, "outcome": "named",
                       "values": "coulomb at mount.force 0.19 N; cubic_stiffness at mount.coefficient 2e+04 N/m^3"}
    assert told[1]["objective"] is None and told[1]["held_out_error"] is None and told[1]["outcome"] == NOT_REFITTED
    assert told[1]["leaves"] is None and told[1]["values"] == ""


def test_without_any_there_are_no_rows():
    assert as_rows(SimpleNamespace(**combinations(SimpleNamespace(combinations=())))) == []

"""Sets of laws: their starts, what is left of them, and what was tried counts once."""

import numpy as np

from pipeline.inference.search.selection import Combination, Selection, merged, sets_and_parts


def test_a_start_holds_the_nominal_values_and_those_of_members_in_their_order():
    selection = Selection((4, 1), (4, 1, 2), (), np.array([0.1, 0.2]), {1: np.array([1.0]), 2: np.array([2.0]),
                                                                       4: np.array([4.0, 4.5])}, frozenset(), 1.0)
    assert selection.start((4, 1)).tolist() == [0.1, 0.2, 4.0, 4.5, 1.0]
    assert selection.start((1, 4)).tolist() == [0.1, 0.2, 1.0, 4.0, 4.5]


def test_parts_of_a_set_lack_its_last_members_and_none_comes_twice():
    assert [set(each) for each in sets_and_parts((3, 1, 2), (1, 3, 5))] == [{1, 2, 3}, {1, 3}, {1, 3, 5}]
    assert sets_and_parts((3,)) == []


def test_a_combination_that_was_tried_keeps_what_became_of_it():
    tried, again = Combination(("a", "b"), 5.0, outcome="named"), Combination(("b", "a"), 5.0)
    other = Combination(("a", "c"), 4.0)
    assert merged((tried,), (again, other)) == (tried, other)

"""What a reader collects: numbers that stand twice or nowhere, ranges, notes."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.deck import Draft, span, whole

pytestmark = pytest.mark.exact


def draft():
    made = Draft("x.inp", label=[40, 10, 30, 20], position=[(4, 0, 0), (1, 0, 0), (3, 0, 0), (2, 0, 0)])
    made.add_element("tetra", 7, (10, 20, 30, 40))
    return made


def test_nodes_are_found_by_number():
    made = draft()
    made.unread["*TIE"] += 2
    made.notes.append("more")
    deck = made.deck()
    (kind, numbers, rows), = deck.blocks
    assert kind == "tetra" and list(numbers) == [7] and list(deck.node[rows[0], 0]) == [1, 2, 3, 4]
    assert deck.notes == ("not read: *TIE (2 times)", "more")


def test_numbers_twice_and_nodes_nowhere():
    made = draft()
    made.add_element("tetra", 8, (10, 20, 30, 41))
    with pytest.raises(ConfigError, match="x.inp: expected nodes that the deck defines, found node 41 of element 8"):
        made.deck()
    made = draft()
    made.label[0] = 10
    with pytest.raises(ConfigError, match="one node of each number, found node 10 twice, and 0 more; renumber"):
        made.deck()
    empty = Draft("x.inp")
    empty.add_element("tetra", 1, (1, 2, 3, 4))
    with pytest.raises(ConfigError, match="node 1 of element 1"):
        empty.deck()


def test_ranges_and_whole_numbers():
    assert list(span(1, 7, 3, "")) == [1, 4, 7] and whole("12", "") == 12
    for bad in ((5, 1, 1), (1, 10**12, 1)):
        with pytest.raises(ConfigError, match="a range of numbers"):
            span(*bad, "")
    for text in ("1.0", "", "9" * 30):
        with pytest.raises(ConfigError, match="a whole number"):
            whole(text, "")


def test_positions_are_finite():
    made = draft()
    made.position[1] = (np.inf, 0, 0)
    with pytest.raises(ConfigError, match="finite coordinates, found others of node 10"):
        made.deck()

"""Two channels that are exchanged."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import pressed, rubbing

EFFECT = named("swapped_channels")


@pytest.mark.exact
def test_each_shows_what_the_other_should():
    swapped = EFFECT.on(rubbing(), "x and turn", {"gain": 1.0})
    base, found = (respond(bench, pressed()) for bench in (rubbing(), swapped))
    for name, other in {"x": "turn", "turn": "x", "y": "y", "n": "n", "t": "t"}.items():
        np.testing.assert_array_equal(found[name], base[other])


def test_pairs_are_of_one_unit():
    assert EFFECT.locations(rubbing()) == ("x and y", "x and turn", "y and turn", "n and t")

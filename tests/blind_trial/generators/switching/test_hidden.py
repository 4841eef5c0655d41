"""What can be hidden: a place for everything, changes of the rig that vanish at size zero, ten foreign laws or more."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching.hidden import FAULTS, PIECES, hides, known_exactly, places, row_of
from pipeline.blind_trial.generators.switching.joint_laws import Spot
from pipeline.blind_trial.generators.switching.rig import LAYOUTS, drawn
from pipeline.effects import CATALOGUE

RIG = drawn(np.random.default_rng(1), "bridge")


@pytest.mark.parametrize("piece", PIECES.values(), ids=lambda p: p.form)
def test_every_piece_has_places_and_acts_there(piece):
    assert (piece.laws is None) != (piece.change is None)
    for layout in LAYOUTS:
        rig = drawn(np.random.default_rng(2), layout)
        assert places(piece, rig)
        index = places(piece, rig)[-1]
        assert set(known_exactly(piece, rig, index)) <= set(rig.names)
        spot = Spot(row_of(piece, rig, index), 1e-3, 0.1, 1000.0, (0.2, 0.5, 0.8))
        if piece.laws is not None:
            assert all(np.array_equal(law.row, spot.row) for law in piece.laws(spot, 0.3))


@pytest.mark.exact
@pytest.mark.parametrize("piece", [p for p in PIECES.values() if p.change], ids=lambda p: p.form)
def test_changes_of_a_rig_vanish_at_size_zero(piece):
    index = places(piece, RIG)[0]
    for changed, matrix in zip(piece.change(RIG, index, 0.0).matrices(), RIG.matrices(), strict=True):
        np.testing.assert_array_equal(changed, matrix)
    assert piece.change(RIG, index, 0.5) != RIG


@pytest.mark.exact
def test_an_arm_in_series_has_half_the_stiffness_and_a_quarter_of_the_damping():
    softer = PIECES["compliant_arm"].change(RIG, 1, 1.0)
    assert softer.stiffness[1] == RIG.stiffness[1] / 2 and softer.damping[1] == RIG.damping[1] / 4


def test_known_names_are_of_the_catalogue_and_foreign_ones_are_not():
    known = {effect.name for effect in CATALOGUE}
    for piece in PIECES.values():
        assert (piece.name in known) == piece.known, piece.form
    assert set(FAULTS.values()) <= known
    classes = hides()
    assert len(classes["foreign"]) >= 10 and ("coulomb",) in classes["effect"] and classes["control"] == ((),)

"""Where and how large physics is hidden: places, spots, sizes by what they change or leave."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.placement import BELOW, difference, noise_of, placed, places
from pipeline.blind_trial.generators.spring_mass.rig_case import made


@pytest.mark.parametrize("name, masses, wanted", [
    ("coulomb", 1, ["link_0"]), ("coulomb", 3, ["link_0", "link_1", "link_2", "link_3"]),
    ("moving_base", 2, ["link_0"]), ("moving_base", 3, ["link_0", "link_3"]),
    ("attached_mass", 2, ["mass_0", "mass_1"]),
    ("pressure_ripple", 2, ["shaker"]), ("clipping", 2, ["x_0", "x_1"])])
def test_places_of_a_piece(name, masses, wanted):
    assert [place for _, place in places(HIDDEN[name], masses)] == wanted
    assert placed(HIDDEN[name], len(wanted), masses)[1] == wanted[0], "numbers count on from the first after the last"


def test_a_piece_is_as_large_as_its_change_or_what_it_leaves_asks_for():
    hiding = made(3, masses=1, level=0.01).hiding
    shape = (0.3, 0.6, 0.5)
    seen = hiding.planted("cubic_stiffness", 0, shape, 0.1, below=False)
    assert hiding.change(seen) == pytest.approx(0.1, rel=0.4)
    faint = hiding.planted("cubic_stiffness", 0, shape, 0.1, below=True)
    noise = noise_of(hiding.without(hiding.trained), hiding.level)
    assert BELOW[0] / 1.4 < hiding.left(faint, (faint,), hiding.shown((faint,)), noise) < 1.4 * BELOW[1]


def test_a_spot_has_the_sizes_of_the_motion_there():
    """Root mean squares of elongation and force of a link, over all runs."""
    hiding = made(3, masses=2, level=0.01).hiding
    spot = hiding.spot(HIDDEN["coulomb"], 1, (0.1, 0.2, 0.3))
    way = np.concatenate([x[1] - x[0] for x in hiding.bare])
    assert spot.length == pytest.approx(np.sqrt(np.mean(way**2)), rel=1e-9)
    assert spot.force == pytest.approx(hiding.truth.links[1].stiffness * spot.length) and spot.shape == (0.1, 0.2, 0.3)


def test_what_another_piece_explains_is_not_left():
    hiding = made(3, masses=1, level=0.01).hiding
    both = tuple(hiding.planted(name, 0, (0.3, 0.6, 0.5), 0.1, below=False) for name in ("cubic_stiffness", "coulomb"))
    seen, noise = hiding.shown(both), noise_of(hiding.without(hiding.trained), hiding.level)
    alone = hiding.explained.left(difference(seen, hiding.without(hiding.trained)), noise)
    assert 4 < hiding.left(both[0], both, seen, noise) < alone

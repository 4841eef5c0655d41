"""Hidden physics in a rig: several pieces act together, sizes are found, nothing planted is the rig itself."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.inserted_effect import (
    Planted,
    Recorder,
    built,
    change_of,
    shown,
    sized,
)
from pipeline.blind_trial.generators.spring_mass.linear_motion import linear
from pipeline.blind_trial.generators.spring_mass.motion import World, moved
from pipeline.blind_trial.generators.spring_mass.rig import Link, Rig, drawn
from pipeline.contract.errors import ConfigError

RIG = drawn(np.random.default_rng(2), 3)
FORCE = np.random.default_rng(3).standard_normal(80)
RECORDER = Recorder((FORCE,), 100.0, np.ones(3), 0.0, 40.0)


def planted(name, index, size, place="somewhere"):
    return Planted(HIDDEN[name], place, Spot(RIG, index, 0.01, 0.2, 3.0, 5.0, (0.3, 0.6, 0.9)), size)


@pytest.mark.exact
def test_what_is_built_of_masses_and_springs_is_a_rig_of_other_values():
    world, chains = built(RIG, (planted("added_stiffness", 1, 0.3), planted("attached_mass", 0, 0.2)))
    mass = (1.2 * RIG.mass[0], *RIG.mass[1:])
    links = (*RIG.links, Link(1, -1, 0.3 * RIG.links[1].stiffness, 0.0))
    rig = Rig(mass, links, RIG.pushed)
    assert world == World(rig) and not chains
    np.testing.assert_allclose(moved(world, FORCE, 0.01, 40.0), linear(rig, FORCE, 0.01, 40.0), atol=1e-6)


@pytest.mark.exact
def test_two_dampers_at_two_links_are_more_damping_of_both():
    world, _ = built(RIG, (planted("joint_damping", 0, 0.1), planted("joint_damping", 1, 0.2)))
    more = [0.1 * 15, 0.2 * 15, 0.0, 0.0]
    links = tuple(Link(k.near, k.far, k.stiffness, k.damping + c) for k, c in zip(RIG.links, more, strict=True))
    found, damped = moved(world, FORCE, 0.01, 40.0), linear(replace(RIG, links=links), FORCE, 0.01, 40.0)
    np.testing.assert_allclose(found, damped, atol=2e-5 * abs(found).max())


def test_a_law_beside_a_base_that_moves_acts_on_the_masses_it_had():
    world, _ = built(RIG, (planted("cubic_stiffness", 1, 0.1), planted("moving_base", 0, 0.1)))
    assert len(world.rig.mass) == 4 and len(world.laws) == 1
    np.testing.assert_array_equal(world.laws[0].row, [-1.0, 1.0, 0.0, 0.0])


def test_a_channel_shows_what_its_sensor_does_and_the_motion_stays():
    bare = RECORDER.motion(World(RIG))
    plain, wrong = (shown(RECORDER, RIG, p, bare)[0] for p in ((), (planted("sensor_gain", 1, 0.1),)))
    np.testing.assert_allclose(wrong, plain * np.array([[1.0], [1.1], [1.0]]), rtol=1e-12)
    assert change_of([wrong], [plain]) == pytest.approx(0.1)


def test_a_size_is_found_on_a_bent_scale_and_refused_where_there_is_none():
    found = sized(planted("coulomb", 0, 0.0), lambda p: 50 * p.size**2, 0.4)
    assert 50 * found.size**2 == pytest.approx(0.4, rel=0.36)
    with pytest.raises(ConfigError, match="draw another seed"):
        sized(planted("coulomb", 0, 0.0), lambda p: 0.01, 0.4)

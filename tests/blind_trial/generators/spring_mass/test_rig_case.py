"""Cases: the same seed gives the same case, hidden physics changes it by what is wanted, controls hide nothing."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.placement import BELOW
from pipeline.blind_trial.generators.spring_mass.rig import drawn
from pipeline.blind_trial.generators.spring_mass.rig_case import (
    CHANGE,
    FAR,
    LEVELS,
    SAMPLES,
    STEP_SHOWS,
    kind_of,
    known,
    made,
)


def test_a_control_is_repeatable_and_noisy_by_its_level():
    first, again = made(5, masses=1, level=0.1), made(5, masses=1, level=0.1)
    assert all(np.array_equal(a, b) for (_, a), (_, b) in zip(first.runs, again.runs, strict=True))
    quiet = made(5, masses=1, level=1e-6)
    left = np.array([a - b for (_, a), (_, b) in zip(first.runs, quiet.runs, strict=True)])
    assert first.kind == "control" and not first.planted and first.change == 0 and len(first.runs) == len(LEVELS)
    np.testing.assert_allclose(np.sqrt(np.mean(left**2)), first.noise[0], rtol=0.05)


@pytest.mark.parametrize("wanted", [None, 0.05])
def test_hidden_physics_changes_one_run_as_wanted(wanted):
    hidden, bare = (made(7, name, level=1e-6, masses=1, change=wanted) for name in ("cubic_stiffness", ""))
    assert hidden.planted[0].place == "link_0" and hidden.truth == bare.truth == drawn(np.random.default_rng(7), 1)
    (_, with_it), (_, without) = hidden.runs[0], bare.runs[0]
    change = np.sqrt(np.mean((with_it - without) ** 2) / np.mean(without**2))
    low, high = (wanted, wanted) if wanted else CHANGE
    assert low / 1.4 < change < 1.4 * high and with_it.shape == (1, SAMPLES)
    assert hidden.change == pytest.approx(change, rel=1e-3)


def test_a_law_that_would_be_a_wrong_value_has_that_value_exact():
    found = made(9, "joint_damping", masses=1)
    assert found.exact == ("damping_0",) and found.belief.links[0].damping == found.truth.links[0].damping
    assert found.belief.links[0].stiffness != found.truth.links[0].stiffness


def test_a_spring_to_the_wall_beside_a_link_to_the_wall_has_that_link_exact():
    """The last of three masses has the links 2, to its neighbour, and 3, to the far wall."""
    found = made(9, "added_stiffness", place=2, masses=3)
    far = found.truth.links[3]
    assert (far.near, far.far) == (2, -1) and found.exact == ("stiffness_3",)
    assert found.belief.links[3].stiffness == far.stiffness and found.left[0] > 5


def test_values_known_exactly_stand_in_controls_as_well_and_betray_nothing():
    told = [known(seed, drawn(np.random.default_rng(seed), 1)) for seed in range(300)]
    assert 75 < sum(map(len, told)) < 125
    assert set(told) == {(), ("mass_0",), ("stiffness_0",), ("damping_0",)}
    first = next(seed for seed, names in enumerate(told) if names)
    assert made(first, masses=1, level=0.1).exact == told[first]


def test_a_pair_hides_both():
    pair = made(5, ("coulomb", "cubic_stiffness"), (0, 1))
    assert pair.kind == "pair" and [p.place for p in pair.planted] == ["link_0", "link_1"]
    assert all(p.size > 0 for p in pair.planted) and min(pair.left) > 10


@pytest.mark.parametrize("hidden", ["cubic_stiffness", "sensor_delay"])
def test_below_the_threshold_the_change_is_lost_in_noise_and_values(hidden):
    found = made(6, hidden, masses=1, level=0.03, kind="below")
    assert found.kind == "below" and BELOW[0] / 1.4 < found.left[0] < 1.4 * BELOW[1] and found.change < 0.03


def test_one_wrong_value_is_far_off_and_the_others_are_not():
    found = made(4, masses=2, kind="wrong_value")
    what, k = found.far.split("_")
    pairs = {"mass": (found.belief.mass, found.truth.mass)} | {
        name: tuple([getattr(link, name) for link in r.links] for r in (found.belief, found.truth))
        for name in ("stiffness", "damping")}
    off = {(name, str(i)): abs(np.log(b / t)) for name, (believed, true) in pairs.items()
           for i, (b, t) in enumerate(zip(believed, true, strict=True))}
    assert found.kind == "wrong_value" and np.log(FAR[0]) <= off.pop((what, k)) <= np.log(FAR[1])
    assert max(off.values()) <= np.log(1.3) + 1e-12


def test_a_decoy_of_the_solver_is_a_control_whose_step_is_too_long():
    decoy, control = made(3, masses=1, kind="solver"), made(3, masses=1)
    assert decoy.step * decoy.rate == 4 * control.step * control.rate == 1 and decoy.truth == control.truth
    assert decoy.left[0] >= STEP_SHOWS and not decoy.planted


def test_a_case_is_of_the_class_of_what_it_hides():
    assert [kind_of(h) for h in ((), ("coulomb",), ("clipping",), ("film_drag",), ("coulomb", "backlash"))] == [
        "control", "effect", "sensor", "foreign", "pair"]

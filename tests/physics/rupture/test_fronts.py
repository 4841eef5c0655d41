"""Fronts of made-up records whose speeds, stops and precursors are known."""

import numpy as np
import pytest

from pipeline.physics.rupture.dynamics import OPEN, SLIP, STICK, Record
from pipeline.physics.rupture.fronts import (
    LEFT,
    RIGHT,
    Front,
    arrivals,
    front,
    local_speed,
    named,
    slip_profiles,
    straight_speed,
)

X, CENTRE, HALF = np.linspace(0, 4e-3, 161), 2e-3, 6e-5
TIME = np.arange(1, 401) * 5e-9


def record(right=1000.0, left=1700.0, left_stop=1.2e-3, width=5e-8, precursor=0.0, end=TIME[-1]):
    """Pulses of given speeds; the left one fades at ``left_stop``; a precursor at 2200 m/s runs to the right."""
    rate = np.zeros((TIME.size, X.size))
    for i, x in enumerate(X):
        speed = right if x > CENTRE else left
        arrival = abs(x - CENTRE) / speed
        size = 1.0 if x > CENTRE else max(0.0, (x - left_stop) / (CENTRE - left_stop))
        rate[:, i] += size * ((arrival < TIME) & (min(arrival + width, end) > TIME)) * (1 + TIME)
        if precursor and x > CENTRE:
            early = abs(x - CENTRE) / 2200.0
            rate[:, i] += precursor * ((early < TIME) & (early + 2e-8 > TIME))
    state = np.where(rate > 0, SLIP, STICK).astype(np.uint8)
    stress = np.ones(rate.shape, np.float32)
    return Record(TIME, rate.astype(np.float32), stress, stress, state)


def both(made, run_in=3e-4):
    arrival = arrivals(made, X, CENTRE, HALF)
    return arrival, [front(made, arrival, X, CENTRE, HALF, run_in, side) for side in (LEFT, RIGHT)]


@pytest.mark.exact
def test_speeds_stops_and_healing():
    _, (left, right) = both(record())
    assert left.speed == pytest.approx(1700, rel=0.01) and right.speed == pytest.approx(1000, rel=0.01)
    assert left.stop == pytest.approx(1.2e-3, abs=3e-5) and left.outcome == "stopped"
    assert right.outcome == "running" and right.stop == pytest.approx(CENTRE + 1000 * TIME[-1], abs=6e-5)
    assert left.kind == right.kind == "pulse" and right.healing_time == pytest.approx(5e-8, abs=6e-9)
    assert named(left, right, False) == "the left front stops, the right one runs on"


@pytest.mark.exact
def test_the_precursor_is_not_the_pulse():
    """Weak slip at 2200 m/s ahead of a pulse at 700 m/s changes neither its speed nor where it ends."""
    _, (_, right) = both(record(right=700.0, precursor=0.05))
    assert right.speed == pytest.approx(700, rel=0.01)
    assert right.stop == pytest.approx(CENTRE + 700 * TIME[-1], abs=6e-5)
    assert right.precursor_reach == pytest.approx(2e-3, abs=5e-5)
    assert right.precursor_lead > 3e-7


@pytest.mark.exact
def test_nodes_near_the_nucleation_that_slip_again_do_not_end_the_pulse():
    """Three nodes whose second slip is the larger one, as behind a front with little damping."""
    made = record(left_stop=-1.0, width=1e-8)
    again = np.flatnonzero(X < CENTRE - HALF)[-6:-3]
    made.slip_rate[(TIME > 3.8e-7) & (TIME < 4.2e-7)] += 2.0 * np.isin(np.arange(X.size), again)
    _, (left, _) = both(made)
    assert left.outcome != "died" and left.speed == pytest.approx(1700, rel=0.01)


def test_slip_that_goes_on_is_a_crack():
    _, (_, right) = both(record(width=1.0, end=1.0))
    assert right.kind == "crack"


def test_fronts_that_die_within_the_run_in():
    _, (left, right) = both(record(left_stop=1.9e-3), run_in=3e-4)
    assert left.outcome == "died" and left.speed == 0.0 and left.kind == "none"
    assert named(left, right, False) == "the left front dies, the right one runs on"


def test_outcomes_are_named():
    def of(outcome):
        return Front(0.0, outcome, 0.0, 0.0, "none", 0.0, 0.0, 0.0)

    assert named(of("died"), of("died"), False) == "both fronts die"
    assert named(of("running"), of("edge"), False) == "neither front stops"
    assert named(of("running"), of("stopped"), True) == (
        "the left front never stops, the right one stops; the interface opens")


def test_nothing_slips():
    still = record()._replace(slip_rate=np.zeros((TIME.size, X.size), np.float32),
                              state=np.full((TIME.size, X.size), OPEN, np.uint8))
    arrival, fronts = both(still)
    assert not arrival.reached.any() and [f.outcome for f in fronts] == ["died", "died"]


@pytest.mark.exact
def test_local_speed_and_slip_profiles():
    made = record()
    arrival, _ = both(made)
    speed = local_speed(arrival, X, 2e-4)
    assert np.median(speed[(X > 2.4e-3) & (X < 3.5e-3)]) == pytest.approx(1000, rel=0.02)
    slip = slip_profiles(made, 5e-9, [1e-6, 2e-6])
    assert slip[1, 120] == pytest.approx(5e-8, rel=0.1) and slip[0, 140] == 0.0


@pytest.mark.exact
def test_a_late_outlier_does_not_bend_a_straight_line():
    time = X / 900.0
    time[40] += 1e-6
    assert straight_speed(X, time)[0] == pytest.approx(900.0, rel=1e-3)

"""What a recorded rupture did: fronts, speeds, stops, healing; the pulse told from the P precursor.

A dilatational wave runs ahead of a slow front and may make the interface slip a little before the pulse comes. The
arrival of the pulse at a node is therefore not the first slip there: it is the moment at which the slip rate passes
half of its peak on the rise to that peak. Walking outwards from the nucleation zone, peaks come later and later; where
the peak (median of ``_NEAR`` nodes) falls back in time by more than ``_FALL`` only the precursor has passed, and the
pulse ends there.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.rupture.dynamics import SLIP

LEFT, RIGHT = -1, 1
#: fall of the peak time, over the time itself, at which the pulse has ended and the precursor begins
_FALL = 0.3
_NEAR = 7
#: share of the run at its end in which a front that still moves has not stopped
_RECENT = 0.06


class Arrival(NamedTuple):
    """Per interface node: pulse arrival and end of the slip that it brings; all in s or m."""

    reached: np.ndarray         # (s,) True where the pulse (or the nucleation) has passed
    arrival: np.ndarray         # (s,) half peak on the rise; 0 where not reached
    first_slip: np.ndarray      # (s,) first slip of any size; 0 where none
    healed: np.ndarray          # (s,) end of the slip episode that holds the peak; 0 where not reached
    sliding_share: np.ndarray   # (s,) share of the time since arrival in which the node slips


class Front(NamedTuple):
    """One side of the rupture."""

    stop: float                 # m, position of the outermost node reached
    outcome: str                # died, stopped, running or edge
    speed: float                # m/s, straight line through the arrivals beyond the run-in; 0 where there is none
    speed_error: float          # m/s, standard error of that line
    kind: str                   # pulse, crack or none
    healing_time: float         # s, median duration of the slip episode of the pulse; 0 where none
    precursor_lead: float       # s, largest time by which first slip precedes the pulse
    precursor_reach: float      # m, outermost slip of any size, from the centre


def arrivals(record, x, centre, half_width):
    """Arrival of a rupture that starts from |x - centre| <= half_width (m)."""
    rate = np.abs(record.slip_rate)
    peak = rate.argmax(axis=0)
    slipped = rate[peak, np.arange(x.size)] > 0.0
    rise, fall = _episode(rate, peak)
    last = record.time.size - 1
    reached = np.zeros(x.size, dtype=bool)
    inside = np.abs(x - centre) <= half_width
    reached[inside] = slipped[inside]
    for side in (LEFT, RIGHT):
        latest, order = 0.0, outwards(x, centre, half_width, side)
        moments = _smooth(record.time[peak[order]])
        for i, moment in zip(order, moments, strict=True):
            if not slipped[i] or moment < (1.0 - _FALL) * latest or peak[i] == last:
                break
            reached[i], latest = True, max(latest, moment)
    since = record.time[:, None] >= record.time[rise][None]
    share = (since & (record.state >= SLIP)).sum(axis=0) / np.maximum(since.sum(axis=0), 1)
    first = np.where(slipped, record.time[(rate > 0.0).argmax(axis=0)], 0.0)
    return Arrival(reached, np.where(reached, record.time[rise], 0.0), first,
                   np.where(reached, record.time[fall], 0.0), np.where(reached, share, 0.0))


def front(record, arrival, x, centre, half_width, run_in, side):
    """Front of one side; ``run_in`` m from the centre are left out of speed, kind and healing time."""
    order = outwards(x, centre, half_width, side)
    order = order[arrival.reached[order]]
    slipped = x[arrival.first_slip > 0.0]
    reach = max(0.0, side * (slipped - centre).max(initial=0.0) if side > 0 else (centre - slipped).max(initial=0.0))
    if order.size == 0:
        return Front(centre + side * half_width, "died", 0.0, 0.0, "none", 0.0, 0.0, reach)
    stop = x[order[-1]]
    beyond = order[np.abs(x[order] - centre) >= run_in]
    outcome = _outcome(record, arrival, order, beyond.size == 0, side)
    if beyond.size < 4:
        return Front(stop, outcome, 0.0, 0.0, "none", 0.0, 0.0, reach)
    speed, error = straight_speed(x[beyond], arrival.arrival[beyond])
    passed = beyond[record.time[-1] - arrival.arrival[beyond] >= _RECENT * record.time[-1]]
    share = np.median(arrival.sliding_share[passed]) if passed.size else 0.0
    kind = "none" if not passed.size else ("pulse" if share < 0.5 else "crack")
    duration = (arrival.healed - arrival.arrival)[passed]
    lead = (arrival.arrival - arrival.first_slip)[beyond].max()
    return Front(stop, outcome, speed, error, kind, float(np.median(duration)) if passed.size else 0.0, lead, reach)


def _outcome(record, arrival, order, early, side):
    """What became of a front that reached the nodes ``order``; ``early``: none of them beyond the run-in."""
    if order[-1] in (0, record.slip_rate.shape[1] - 1):
        return "edge"
    if record.time[-1] - arrival.arrival[order].max() < _RECENT * record.time[-1]:
        return "running"
    if early:
        return "died"
    return "running" if record.slip_rate[-1, order[-1] + side] != 0.0 else "stopped"


def named(left, right, opened):
    """One phrase for the outcome of both fronts; ``opened`` = True where the interface has opened."""
    alive = {"running", "edge"}
    if left.outcome == right.outcome == "died":
        phrase = "both fronts die"
    elif left.outcome in alive and right.outcome in alive:
        phrase = "neither front stops"
    elif left.outcome in alive:
        phrase = f"the left front never stops, the right one {_verb(right)}"
    else:
        phrase = f"the left front {_verb(left)}, the right one {_verb(right)}"
    return phrase + ("; the interface opens" if opened else "")


def _verb(side):
    return {"died": "dies", "stopped": "stops", "running": "runs on", "edge": "reaches the edge"}[side.outcome]


def straight_speed(x, time):
    """(speed, standard error) in m/s of the straight line of arrival over position; late outliers left out once."""
    off = np.abs(time - np.polyval(np.polyfit(x, time, 1), x))
    kept = off <= max(4.0 * np.median(off), 1e-3 * np.ptp(time))
    (slope, _), covariance = np.polyfit(x[kept], time[kept], 1, cov=True)
    return (abs(1.0 / slope), np.sqrt(covariance[0, 0]) / slope**2) if slope else (0.0, 0.0)


def local_speed(arrival, x, window):
    """(s,) m/s, speed of the front over x: lines through the arrivals within ``window`` m; 0 where undefined."""
    speed = np.zeros(x.size)
    nodes = np.flatnonzero(arrival.reached)
    for i in nodes:
        near = nodes[np.abs(x[nodes] - x[i]) <= 0.5 * window]
        if near.size >= 5 and np.ptp(arrival.arrival[near]) > 0.0:
            speed[i] = straight_speed(x[near], arrival.arrival[near])[0]
    return speed


def slip_profiles(record, step, times):
    """(t, s) m, slip at ``times`` (s), from the recorded slip rates."""
    total = np.cumsum(record.slip_rate.astype(float), axis=0) * step
    return total[np.clip(np.rint(np.asarray(times) / step).astype(int) - 1, 0, len(total) - 1)]


def outwards(x, centre, half_width, side):
    """Node numbers outside the nucleation zone on one side, from the centre outwards."""
    nodes = np.flatnonzero(side * (x - centre) > half_width)
    return nodes if side == RIGHT else nodes[::-1]


def _smooth(values):
    """Median over ``_NEAR`` neighbours, fewer at the ends but always as many on both sides."""
    halves = [min(_NEAR // 2, i, values.size - 1 - i) for i in range(values.size)]
    return np.array([np.median(values[i - half:i + half + 1]) for i, half in enumerate(halves)])


def _episode(rate, peak):
    """Indices where each column passes half of its peak on the rise, and where its slip episode ends."""
    rise, fall = peak.copy(), peak.copy()
    for i in range(rate.shape[1]):
        half = 0.5 * rate[peak[i], i]
        while rise[i] > 0 and rate[rise[i] - 1, i] >= half:
            rise[i] -= 1
        while fall[i] < rate.shape[0] - 1 and rate[fall[i] + 1, i] > 0.0:
            fall[i] += 1
    return rise, fall

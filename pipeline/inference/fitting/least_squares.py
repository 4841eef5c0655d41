"""Maximum a posteriori by Levenberg-Marquardt in latent coordinates and whitened residuals.

In latent coordinates the prior is N(0, I), so that the objective is |r(u)|^2 + |u|^2; the steps are those of ``steps``.
"""

from contextlib import suppress
from dataclasses import replace

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference.fitting.fit_state import DIFFERENCE, linearised, refreshed, worth_halving
from pipeline.inference.fitting.steps import along_valley, damped_step, newton_step, within
from pipeline.inference.time_budget import TimeSpentError, spent

ITERATIONS = 60
#: widest forward-difference step in latent coordinates, which looks beyond kinks of the forward model
_WIDEST = 1e-2
#: the expected decrease of the objective at which a fit counts as converged, tempered as the evidence will be
TOLERANCE = 1e-3
#: the same of features, as a share of the objective: far off, a small change of it says nothing
_SHARE = 1e-4
#: where no step helps (rounding, kinks of the forward model) or iterations are used up, a fit counts as converged below
#: this: a posterior standard deviation from its linearised optimum
_STALLED = 1.0
#: a fit that used up its iterations goes on, for this fraction of them, where its predicted decrease is below _NEARLY
_NEARLY, _AGAIN = 30.0, 3
#: steps by central differences, their first damping, and the share of the promised decrease that each must reach
_CENTRAL, _LIGHT, _KEPT = 8, 1e-12, 0.1
#: share of the tolerance below which the gain of a step is none
_LEAST = 0.1
#: so many times the decrease of the objective that its slope promises may a fit still come down
HOPE = 10.0
#: iterations, and the share of the objective that is left after them where a fit of features crawls
_CRAWLING = ((5, 0.97), (8, 0.7))
#: noise powers from which on a fit of samples crawls, iterations, and the share of what noise is not that is left after
#: them
_ABOVE, _CREEPING, _LEFT = 1.2, 10, 0.98
#: iterations over which a fit is judged that has to come down to what others reach
_LATE = 4
#: share of the objective that a step of a rough fit must gain for another to follow
_ROUGHLY = 0.01
#: share of the promised decrease below which a step by differences is taken along the bent valley instead
_BENT = 0.1


def fit(problem, noises, hypothesis, start, runs, iterations=ITERATIONS):
    """Levenberg-Marquardt from latent ``start``; the Fit says whether it ``converged``.

    ``noises`` [Noise] belong to ``runs``. Raises what the forward model raises at the start.
    """
    return continued(problem, linearised(problem, noises, hypothesis, start, runs), iterations)


def continued(problem, state, iterations=ITERATIONS, enough=np.inf, patient=True):
    """The Fit after further iterations. Jacobians are updated by the secant (Broyden 1965) as long as that serves.

    A fit is given up, as it is, where its slope promises nothing that would bring its objective down to ``enough``, and
    without ``patient`` where features stay far off. Where its iterations do not end by themselves, central differences
    tell how far it is from its optimum: in a narrow valley the error of forward ones looks like a slope. Near the noise
    it goes on along them, and from there on as before where it is nearly at its end. Where steps of the forward model
    do not settle on the way it begins again with shorter ones.
    """
    begun = state
    try:
        state = iterated(problem, begun, iterations, enough, patient)
        return _ended(problem, state, iterations, enough, patient)
    except TimeSpentError:
        return state
    except BrakechainError as error:
        if not worth_halving(error, begun.hypothesis):
            raise
    finer = replace(begun.hypothesis, halvings=begun.hypothesis.halvings + 1)
    return continued(problem, linearised(problem, begun.noises, finer, begun.latent, begun.runs), iterations, enough,
                     patient)


def _ended(problem, state, iterations, enough, patient):
    """The Fit once central differences tell where it ends (see ``continued``)."""
    if state.converged or state.objective > enough:
        return state
    state = _at_central_differences(problem, state)
    if not (state.converged or state.unordered or state.far):
        state = _along_central_differences(problem, state)
    if state.converged or state.promised > _NEARLY * _scale(state):
        return state
    state = iterated(problem, state, iterations // _AGAIN, enough, patient)
    return state if state.converged or state.objective > enough else _at_central_differences(problem, state)


def again(problem, state):
    """The Fit at its latent values, not converged and ``strict`` from there on, with differences taken anew over wide
    steps, which look beyond kinks."""
    return replace(refreshed(problem, state, _WIDEST), converged=False, strict=True)


def beside(problem, state, kept, iterations=4):
    """The Fit after a few iterations over the parameters that are not ``kept`` (k,) as they are."""
    free = np.flatnonzero(~kept)
    for _ in range(iterations):
        gradient, hessian = state.slopes
        latent = state.latent.copy()
        latent[free] = within(latent[free] + newton_step(gradient[free], hessian[np.ix_(free, free)]))
        moved = linearised(problem, state.noises, state.hypothesis, latent, state.runs)
        if moved.objective >= state.objective:
            break
        state = moved
    return state


def _at_central_differences(problem, state):
    """The Fit with central differences, converged where they show it at its optimum."""
    state = refreshed(problem, state, central=True)
    return replace(state, converged=state.promised < _STALLED * _scale(state))


def _along_central_differences(problem, state):
    """The Fit after a few steps by central differences, as long as they keep what they promise.

    Where a factor common to many values shows nowhere, priors alone say how large it is: the valley is straight, and so
    narrow that forward differences lead out of it.
    """
    for _ in range(_CENTRAL):
        moved, *_ = damped_step(problem, state, _LIGHT, 2.0, False)
        if moved is None or state.objective - moved.objective < _KEPT * state.promised:
            break
        state = _at_central_differences(problem, moved)
        if state.converged:
            break
    return state


def iterated(problem, state, iterations, enough=np.inf, patient=True, rough=False, frugal=False):
    """The Fit after ``iterations``; where no step helps, differences are taken over wider steps before it ends.

    A ``rough`` one stops where updated Jacobians promise no more: its latent values are of use. A ``frugal`` one takes
    no differences at all: it stops where the Jacobians that it has, and their updates, lead no further. Any stops, not
    converged, when the time of the diagnosis is spent.
    """
    damping, growth, width, objectives = 1e-3, 2.0, DIFFERENCE, []
    with suppress(TimeSpentError):
        for _ in range(iterations):
            objectives.append(state.objective)
            if spent() or (not patient and _crawls(state, objectives)) or (rough and _settles(state, objectives)):
                break
            expected, scale = state.promised, _scale(state)
            if state.objective - HOPE * expected > enough or _lags(objectives, enough):
                break
            if expected < _tolerance(state, scale, patient):
                if rough or frugal or state.fresh:
                    return replace(state, converged=state.fresh and not rough)
                state = refreshed(problem, state)
                continue
            moved, damping, growth = damped_step(problem, state, damping, growth, frugal)
            if state.fresh and not frugal and (moved is None or state.objective - moved.objective < _BENT * expected):
                moved = min(along_valley(problem, state), moved or state, key=lambda s: s.objective)
            if moved is not None and state.objective - moved.objective > _LEAST * TOLERANCE * scale:
                state = moved
                continue
            if frugal:
                break
            if state.fresh and expected < _STALLED * scale:
                return replace(state, converged=True)
            if state.fresh and width >= _WIDEST:
                break
            width *= 10 if state.fresh else 1
            state, damping, growth = refreshed(problem, state, width), 1e-3, 2.0
    return state


def _tolerance(state, scale, patient):
    return max(TOLERANCE * scale, 0.0 if patient or not state.unordered else _SHARE * state.objective)


def _crawls(state, objectives):
    """Whether what is far off has stayed so, features or samples: its hypothesis has no use for more iterations."""
    def stayed(count, share, noise=0.0):
        return len(objectives) > count and objectives[-1] - noise > share * (objectives[-1 - count] - noise)

    if state.unordered:
        return state.far and any(stayed(count, share) for count, share in _CRAWLING)
    noise = state.counts.sum()
    return objectives[-1] > _ABOVE * noise and stayed(_CREEPING, _LEFT, noise)


def _lags(objectives, enough):
    """Whether a fit that is above ``enough`` has come down so little of late that it will not get there."""
    if len(objectives) <= _LATE or objectives[-1] <= enough:
        return False
    return (objectives[-1 - _LATE] - objectives[-1]) * HOPE < objectives[-1] - enough


def _settles(state, objectives):
    """Whether the last step gained so little that a rough fit may end."""
    return not state.fresh and len(objectives) > 1 and objectives[-1] > (1 - _ROUGHLY) * objectives[-2]


def _scale(state):
    """Objective per unit of log evidence (see ``effective.tempering``); 1 of a strict fit."""
    return 1.0 if state.strict else 1 / max(state.weights.max(), 1e-12)

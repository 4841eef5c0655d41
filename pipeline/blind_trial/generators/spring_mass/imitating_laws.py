"""Known laws for which hidden physics can be taken: what of its change they leave, beside other values of the rig.

Looked for among its kin at the same place, and at other places for the piece itself. Each first takes part linearly, in
any amount of about one; the nearest are then refitted as they are, with sizes and times of their own.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.spring_mass.detectability import Refitted
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Planted, built, shown, sized
from pipeline.blind_trial.generators.spring_mass.linear_motion import linear_world
from pipeline.blind_trial.generators.spring_mass.placement import difference, places
from pipeline.contract.errors import BrakechainError

#: standard deviations of the noise below which two laws cannot be told apart with a probability of 0.9
APART = 4.0
#: known laws that come near to a piece at the same place
KIN = {
    "coulomb": ("asymmetric_friction", "joint_damping"), "asymmetric_friction": ("coulomb",),
    "joint_damping": ("viscoelastic_pad", "shim_damping"), "quadratic_damping": ("joint_damping", "coulomb"),
    "viscoelastic_pad": ("shim_damping",), "shim_damping": ("viscoelastic_pad", "joint_damping"),
    "cubic_stiffness": ("hysteretic_joint", "backlash"), "hysteretic_joint": ("cubic_stiffness", "coulomb"),
    "backlash": ("cubic_stiffness", "hysteretic_joint"),
    "film_drag": ("joint_damping", "quadratic_damping"), "fractional_damping": ("viscoelastic_pad", "shim_damping"),
    "magnetic_softening": ("cubic_stiffness",), "quintic_stiffness": ("cubic_stiffness",),
    "leaking_mass": ("attached_mass",), "rough_friction": ("coulomb",), "dwell_friction": ("coulomb",),
    "dithered_friction": ("coulomb", "joint_damping"),
}
#: speeds, as multiples of the typical one, at which a law with times of its own is tried
_SPEEDS = (1.0, 3.0, 9.0)
#: how many laws are refitted, of those that leave less than so many times APART linearly
_REFITTED, _WORTH = 2, 16.0
#: standard deviations of the logarithms of size and speed of a law that is refitted
_SPREADS = (1.0, 3.0)


@dataclass(frozen=True)
class Rival:
    """A known law ``name`` at a ``place``, and what it ``left``, in standard deviations of the noise."""

    name: str
    place: str
    left: float


def rivals(case):
    """[Rival] of the one piece of physics that a Case hides, nearest first."""
    hidden, hiding = case.planted[0], case.hiding
    without, near = hiding.without(hiding.trained), {}
    seen = _shown(hiding.recorder, hiding.truth, (hidden,), hiding.trained)
    for law in _laws(hiding, hidden):
        change = difference(_shown(hiding.recorder, hiding.truth, (law,), hiding.trained), without)
        asked = difference(seen, without), case.noise, case.colour, [change]
        left, key = hiding.explained.left(*asked), (law.piece.name, law.place)
        if left < near.get(key, (np.inf,))[0]:
            near[key] = left, replace(law, size=float(hiding.explained.taken(*asked)[1][0]) * law.size)
    order = sorted(near.values(), key=lambda pair: pair[0])
    refitted = [(min(left, _refitted(case, [law], seen)) if k < _REFITTED and left < _WORTH * APART else left, law)
                for k, (left, law) in enumerate(order)]
    return [Rival(law.piece.name, law.place, float(left)) for left, law in sorted(refitted, key=lambda pair: pair[0])]


def beside_the_other(case):
    """What each of the two pieces that a Case hides leaves where the other is refitted alone, as ``Rival.left``.

    What leaves much linearly is not refitted.
    """
    seen = shown(case.hiding.recorder, case.hiding.truth, case.planted, runs=slice(case.hiding.trained))
    return tuple(min(left, _refitted(case, [other], seen)) if left < _WORTH * APART else left
                 for left, other in zip(case.left, case.planted[::-1], strict=True))


def left_beside(case, named):
    """What the piece that a Case hides leaves beside known laws refitted all at once, as ``Rival.left``; infinite where
    one of the ``named`` [(name, place)] is none of HIDDEN, or cannot make such a change."""
    hidden, hiding = case.planted[0], case.hiding
    without, wanted = hiding.without(hiding.trained), hiding.change(hidden)
    try:
        laws = [sized(_at_place(hiding, hidden, *each), hiding.change, wanted) for each in named]
    except (KeyError, BrakechainError):
        return np.inf
    seen = _shown(hiding.recorder, hiding.truth, (hidden,), hiding.trained)
    changes = [difference(_shown(hiding.recorder, hiding.truth, (law,), hiding.trained), without) for law in laws]
    amounts = hiding.explained.taken(difference(seen, without), case.noise, case.colour, changes)[1]
    return _refitted(case, [replace(law, size=float(a) * law.size) for a, law in zip(amounts, laws, strict=True)], seen)


def _at_place(hiding, hidden, name, place):
    """Planted of a known piece by its name and that of its place; KeyError where there is none."""
    piece = HIDDEN[name]
    index = {where: index for index, where in places(piece, len(hiding.truth.mass))}[place]
    return Planted(piece, place, hiding.spot(piece, index, hidden.spot.shape))


def _laws(hiding, hidden):
    """Planted laws that change motion about as much as ``hidden`` does, where there is such a size."""
    masses, wanted = len(hiding.truth.mass), hiding.change(hidden)
    laws = []
    for piece in map(HIDDEN.get, (*KIN.get(hidden.piece.name, ()), *[hidden.piece.name] * hidden.piece.known)):
        itself = piece is hidden.piece
        there = [(at, location) for at, location in places(piece, masses) if (location != hidden.place) == itself]
        for at, location in there:
            spot = hiding.spot(piece, at, hidden.spot.shape)
            for speed in _SPEEDS if piece.timed else (1.0,):
                start = Planted(piece, location, replace(spot, speed=speed * spot.speed))
                try:
                    laws.append(sized(start, hiding.change, wanted))
                except BrakechainError:
                    continue
    return laws


def _refitted(case, laws, seen):
    """What laws leave of the motion ``seen`` that they are fitted to, together with the values of the rig; where that
    is less than APART, it may be still less."""
    hiding = case.hiding
    refit = of_laws(hiding.recorder, hiding.values, laws, hiding.trained)
    return refit.left(difference(seen, refit.at_rest), case.noise, case.colour, enough=0.9 * APART)


def of_laws(recorder, values, laws, runs):
    """Refitted by Values of a rig with Planted ``laws`` of other sizes and speeds, in the first ``runs``."""
    def model(u):
        rig, gains = values.at(u[:values.size])
        factors = np.exp(_SPREADS * np.reshape(u[values.size:], (len(laws), -1)))
        changed = [replace(law, size=size * law.size, spot=replace(law.spot, speed=speed * law.spot.speed))
                   for law, (size, speed) in zip(laws, factors, strict=True)]
        try:
            seen = _shown(recorder, rig, changed, runs)
        except BrakechainError:
            return np.full((runs, len(recorder.gains), len(recorder.runs[0])), np.nan)
        return np.array(seen) * gains[:, None]

    return Refitted(model, values.size + len(laws) * len(_SPREADS), costly=True)


def _shown(recorder, rig, laws, runs):
    """[(sensor, n)] of a rig with Planted laws in the first ``runs``: by the exponential where it is linear."""
    world, chains = built(rig, laws)
    exact = linear_world(world, recorder.runs[:runs], 1 / recorder.rate, recorder.corner)
    return recorder.seen(recorder.motion(world, slice(runs)) if exact is None else exact, chains)

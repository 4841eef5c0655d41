"""Where and how large physics is hidden in a rig, and what values of the rig leave of the change that it makes."""

from dataclasses import dataclass

import numpy as np

from pipeline.blind_trial.generators.spring_mass.detectability import Values
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Planted, Recorder, change_of, shown, sized
from pipeline.blind_trial.generators.spring_mass.motion import PARTS

#: what of a change below the threshold is left beside other values of the rig, in standard deviations of the noise
BELOW = (0.5, 1.5)


def places(piece, masses):
    """[(index, name)] of the places of a Hidden on a rig of so many masses."""
    links = masses + (masses > 2)
    walls = ["link_0", f"link_{links - 1}"][:1 + (masses > 2)]
    names = {"link": [f"link_{k}" for k in range(links)], "wall link": walls,
             "mass": [f"mass_{k}" for k in range(masses)], "shaker": ["shaker"],
             "channel": [f"x_{k}" for k in range(masses)]}[piece.place]
    return [(int(name.partition("_")[2] or 0), name) for name in names]


def placed(piece, number, masses):
    """(index, name) of the place of this number, counted on from the first after the last."""
    there = places(piece, masses)
    return there[number % len(there)]


@dataclass(frozen=True)
class Hiding:
    """Where and how large physics is hidden in a rig whose ``bare`` motion is known.

    ``explained`` (Refitted) by other ``values`` of the rig; ``level`` and ``colour`` of the noise.
    """

    recorder: Recorder
    values: Values
    bare: list
    explained: object
    level: float
    colour: float

    @property
    def truth(self):
        return self.values.rig

    @property
    def trained(self):
        """How many runs are fitted: all but the last."""
        return len(self.recorder.runs) - 1

    def planted(self, name, number, shape, wanted, below):
        """The Planted of a piece of HIDDEN at the place of this index."""
        piece = HIDDEN[name]
        index, where = placed(piece, number, len(self.truth.mass))
        start = Planted(piece, where, self.spot(piece, index, shape))
        if below:
            return sized(start, self._left, start.spot.between(2, *BELOW))
        return sized(start, self.change, wanted)

    def left(self, piece, planted, seen, noise):
        """Standard deviations of ``noise`` that values of the linear rig leave of the change by ``piece`` of what is
        planted and ``seen``: too many, where the others are strong and bend what values do.

        Others that are planted may take part.
        """
        others = tuple(p for p in planted if p is not piece)
        before = self.shown(others)
        beside = [difference(before, self.without(self.trained))] * bool(others)
        return self.explained.left(difference(seen[:self.trained], before), noise, self.colour, beside)

    def shown(self, planted):
        """[(sensor, n)] of the fitted runs with what is ``planted``."""
        return shown(self.recorder, self.truth, planted, self.bare, slice(self.trained))

    def without(self, runs):
        """[(sensor, n)] of the first ``runs`` of the rig alone."""
        return self.recorder.seen(self.bare[:runs])

    def change(self, piece):
        """Relative change of the first run by a Planted alone."""
        return change_of(shown(self.recorder, self.truth, (piece,), self.bare, slice(1)), self.without(1))

    def spot(self, piece, index, shape):
        """The Spot of a Hidden at the place of this index, of a drawn ``shape`` (3,)."""
        row = self.truth.rows[index] if "link" in piece.place else np.eye(len(self.truth.mass))[index]
        way = np.array([row @ x for x in self.bare])
        length = float(np.sqrt(np.mean(way**2)))
        speed = float(np.sqrt(np.mean(np.gradient(way, 1 / (self.recorder.rate * PARTS), axis=1) ** 2)))
        force = float(np.sqrt(np.mean(np.square(self.recorder.runs)))) if piece.place == "shaker" else self.truth.links[
            min(index, len(self.truth.links) - 1)].stiffness * length
        return Spot(self.truth, index, length, speed, force, len(self.recorder.runs[0]) / self.recorder.rate, shape)

    def _left(self, piece):
        without = self.without(self.trained)
        change = difference(self.shown((piece,)), without)
        return self.explained.left(change, noise_of(without, self.level), self.colour)


def difference(shown_now, before):
    """Change (run, sensor, n) from one motion to another."""
    return np.array(shown_now) - np.array(before)


def noise_of(seen, level):
    """Standard deviation (sensor,) of noise of this ``level`` relative to what the sensors show in all runs."""
    return level * np.sqrt(np.mean([s**2 for s in seen], axis=(0, 2)))

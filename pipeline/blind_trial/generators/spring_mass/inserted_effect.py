"""Hidden physics put into a rig: where it sits, how large it is, and what the sensors show of it.

A piece alone is as large as a measure of its change asks for; several act at different places of one rig.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.spring_mass import sensors
from pipeline.blind_trial.generators.spring_mass.hidden_laws import Hidden, Spot
from pipeline.blind_trial.generators.spring_mass.motion import PARTS, Law, World, moved
from pipeline.blind_trial.generators.spring_mass.rig import Rig
from pipeline.contract.errors import ConfigError, ConvergenceError

#: trials of a size, how near its change must come, in the logarithm, and the sizes between which it is looked for
_TRIALS, _NEAR, _ENDS = 16, 0.3, (1e-6, 30.0)
#: pieces that are masses and springs, in the order in which they are built in
_STRUCTURE = ("moving_base", "added_stiffness", "attached_mass", "compliant_arm")


@dataclass(frozen=True)
class Planted:
    """A Hidden ``piece`` at a ``spot`` called ``place``, of this ``size``."""

    piece: Hidden
    place: str
    spot: Spot
    size: float = 0.0


@dataclass(frozen=True)
class Recorder:
    """What records the rig: forces ``runs`` [(n,)] N at ``rate`` Hz, sensors of ``gains`` (s,), ``delay`` s and
    ``corner`` Hz."""

    runs: tuple
    rate: float
    gains: np.ndarray
    delay: float
    corner: float

    def motion(self, world, runs=slice(None)):
        """[(sensor, instant)] of a World in the chosen runs."""
        return [moved(world, force, 1 / self.rate, self.corner) for force in self.runs[runs]]

    def seen(self, motion, chains=None):
        """[(sensor, n)] of [(sensor, instant)]: every sensor by its gain and delay, and its Chain in ``chains``."""
        count = len(self.runs[0])
        time, fine = np.arange(count) / self.rate, np.arange(PARTS * (count - 1) + 1) / (self.rate * PARTS)
        whole = [self._chain(gain, (chains or {}).get(k, sensors.Chain())) for k, gain in enumerate(self.gains)]
        return [np.array([chain.shown(time, fine, run[k]) for k, chain in enumerate(whole)]) for run in motion]

    def _chain(self, gain, own):
        return replace(own, delay=self.delay + own.delay, gain=gain * own.gain)


def built(rig: Rig, planted):
    """(World, {channel: Chain}) of a rig with all that is ``planted``."""
    chains = {p.spot.index: p.piece.build(p.spot, p.size) for p in planted if p.piece.place == "channel"}
    for name in _STRUCTURE:
        for piece in (p for p in planted if p.piece.name == name):
            rig = piece.piece.build(replace(piece.spot, rig=rig), piece.size).rig
    worlds = [p.piece.build(p.spot, p.size) for p in planted
              if p.piece.place != "channel" and p.piece.name not in _STRUCTURE]
    laws = tuple(_wider(law, len(rig.mass)) for world in worlds for law in world.laws)
    return World(rig, laws, next((w.mass for w in worlds if w.mass), None),
                 next((w.jump for w in worlds if w.jump), None)), chains


def _wider(law, masses):
    return replace(law, row=np.append(law.row, np.zeros(masses - len(law.row)))) if isinstance(law, Law) else law


def shown(recorder, rig, planted, bare=None, runs=slice(None)):
    """[(sensor, n)] of the rig with all that is ``planted``; ``bare``: its motion without, where it is known."""
    world, chains = built(rig, planted)
    still = bare is not None and world == World(rig)
    return recorder.seen(bare[runs] if still else recorder.motion(world, runs), chains)


def sized(planted, measure, wanted):
    """The Planted of a size whose ``measure(planted)`` is about ``wanted``; ConfigError where there is none.

    The measure is taken as proportional to the size, between the nearest sizes on both sides once they are known.
    """
    size, (low, high) = 0.1, _ENDS
    for _ in range(_TRIALS):
        candidate = replace(planted, size=size)
        try:
            change = measure(candidate)
        except ConvergenceError:
            change = np.inf
        if abs(np.log(max(change, 1e-12) / wanted)) < _NEAR:
            return candidate
        low, high = (size, high) if change < wanted else (low, size)
        guess = size * np.clip(wanted / max(change, 1e-12), 0.01, 5.0)
        size = float(guess if low < guess < high else np.sqrt(low * high))
    raise ConfigError(f"trial: {planted.piece.name}", f"a size whose change is {wanted:.3g}", f"{change:.3g} at last",
                      "draw another seed")


def change_of(shown_now, reference):
    """Root mean square change relative to the reference, of the sensor that changes most."""
    left = np.mean([(a - b) ** 2 for a, b in zip(shown_now, reference, strict=True)], axis=(0, 2))
    return float(np.sqrt((left / np.mean([b**2 for b in reference], axis=(0, 2))).max()))

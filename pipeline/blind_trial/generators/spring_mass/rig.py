"""Rigs of a trial: a row of masses between walls, pushed by a shaker, drawn at random; and what a workshop believes."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError

#: natural frequency of one mass on one link, Hz, and damping ratio of a link: ranges of the draw
_FREQUENCY, _DAMPING, _MASS = (2.0, 4.0), (0.015, 0.05), (0.5, 2.0)
#: how far believed values are off, either way
OFF = (0.1, 0.3)


@dataclass(frozen=True)
class Link:
    """Spring (N/m) and damper (N s/m) from mass ``near`` to mass ``far``; ``far`` -1 is the wall."""

    near: int
    far: int
    stiffness: float
    damping: float


@dataclass(frozen=True)
class Rig:
    """``mass`` (n,) kg and ``links``; the shaker pushes mass ``pushed``; every mass has a displacement sensor."""

    mass: tuple
    links: tuple
    pushed: int = 0

    def __post_init__(self):
        ends = [end for link in self.links for end in (link.near, link.far)]
        if not self.mass or min(self.mass) <= 0 or max(ends, default=0) >= len(self.mass) or min(ends, default=0) < -1:
            raise ConfigError("rig", "masses above 0 kg and links between them or to the wall", str(self))

    @property
    def rows(self):
        """(link, mass): elongation of each link per displacement of each mass."""
        rows = np.zeros((len(self.links), len(self.mass)))
        for row, link in zip(rows, self.links, strict=True):
            row[link.near] = 1.0
            if link.far >= 0:
                row[link.far] = -1.0
        return rows


def drawn(random, masses):
    """A Rig of so many masses: wall, mass, mass, ...; the last of three or more is held by the other wall too.

    The shaker pushes the second mass: at one that a wall holds its force could be that of the wall's link.
    """
    mass = tuple(float(m) for m in np.exp(random.uniform(*np.log(_MASS), masses)))
    ends = [(k, k - 1) for k in range(masses)] + [(masses - 1, -1)] * (masses > 2)
    return Rig(mass, tuple(_link(random, near, far, mass[near]) for near, far in ends), min(1, masses - 1))


def _link(random, near, far, mass):
    angular = 2 * np.pi * random.uniform(*_FREQUENCY)
    return Link(near, far, mass * angular**2, 2 * random.uniform(*_DAMPING) * mass * angular)


def believed(random, rig, exact=()):
    """The Rig as the workshop has it: every value off by 10 to 30 %, but those named in ``exact``.

    Names are ``mass_0``, ``stiffness_1``, ``damping_1``, ...
    """
    def off(name, value):
        return value if name in exact else value * np.exp(random.choice((-1, 1)) * random.uniform(*np.log1p(OFF)))

    links = tuple(replace(link, **{what: off(f"{what}_{k}", getattr(link, what)) for what in ("stiffness", "damping")})
                  for k, link in enumerate(rig.links))
    return replace(rig, mass=tuple(off(f"mass_{k}", m) for k, m in enumerate(rig.mass)), links=links)


def value_names(rig):
    """Names of all values of a rig, as ``exact`` of ``believed`` has them."""
    return [f"mass_{k}" for k in range(len(rig.mass))] + [
        f"{what}_{k}" for k in range(len(rig.links)) for what in ("stiffness", "damping")]


def far_off(random, rig, belief, ends):
    """(belief with one value drawn, off by a factor between ``ends`` either way, and the name of that value)."""
    name = str(random.choice(value_names(rig)))
    factor = np.exp(random.choice((-1, 1)) * random.uniform(*np.log(ends)))
    what, k = name.split("_")[0], int(name.split("_")[1])
    if what == "mass":
        return replace(belief, mass=(*belief.mass[:k], rig.mass[k] * factor, *belief.mass[k + 1:])), name
    wrong = replace(belief.links[k], **{what: getattr(rig.links[k], what) * factor})
    return replace(belief, links=(*belief.links[:k], wrong, *belief.links[k + 1:])), name

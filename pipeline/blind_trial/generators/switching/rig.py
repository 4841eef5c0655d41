"""Rigs of one to three bodies: rows, bridges between walls, stars; drawn by their frequencies and damping ratios."""

from dataclasses import dataclass, replace

import numpy as np

WALL = -1
#: layout: springs as pairs of bodies, the wall being -1
LAYOUTS = {"single": ((0, WALL),), "row": ((0, WALL), (1, 0)), "bridge": ((0, WALL), (1, 0), (1, WALL)),
           "long row": ((0, WALL), (1, 0), (2, 1)), "star": ((0, WALL), (1, 0), (2, 0))}
#: ranges of the first frequency in Hz, of a mass in kg, of damping ratios
_FREQUENCY, _MASS, _DAMPING = (8.0, 60.0), (0.2, 5.0), (0.006, 0.03)
#: least and largest share by which the workshop's values are off
OFF = (0.1, 0.3)


@dataclass(frozen=True)
class Rig:
    """``mass`` (body,) kg; springs ``ends`` ((body, body or WALL), ...) of ``stiffness`` N/m and ``damping`` N s/m."""

    mass: tuple
    ends: tuple
    stiffness: tuple
    damping: tuple

    @property
    def rows(self):
        """(spring, body): elongations of the springs."""
        rows = np.zeros((len(self.ends), len(self.mass)))
        for row, (near, far) in zip(rows, self.ends, strict=True):
            row[near] = 1.0
            if far != WALL:
                row[far] = -1.0
        return rows

    def matrices(self):
        """Mass, damping and stiffness (body, body)."""
        rows = self.rows
        return (np.diag(self.mass), rows.T @ np.diag(self.damping) @ rows, rows.T @ np.diag(self.stiffness) @ rows)

    @property
    def frequencies(self):
        """Undamped natural frequencies, rising, Hz."""
        mass, _, stiffness = self.matrices()
        return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)) / (2 * np.pi)

    def value(self, name):
        """Value of this name, as in mass.0, stiffness.1 and damping.1."""
        kind, index = name.split(".")
        return getattr(self, kind)[int(index)]

    def with_values(self, values):
        """The rig with ``values`` {name: value}."""
        changed = {kind: list(getattr(self, kind)) for kind in ("mass", "stiffness", "damping")}
        for name, value in values.items():
            kind, index = name.split(".")
            changed[kind][int(index)] = float(value)
        return replace(self, **{kind: tuple(values) for kind, values in changed.items()})

    @property
    def names(self):
        """Names of all values."""
        springs = range(len(self.ends))
        return (*(f"mass.{k}" for k in range(len(self.mass))), *(f"stiffness.{k}" for k in springs),
                *(f"damping.{k}" for k in springs))


def drawn(random, layout):
    """A Rig of a layout: masses and relative stiffnesses first, all stiffnesses scaled to the first frequency, every
    damper sized by a damping ratio of its spring at that frequency."""
    ends = LAYOUTS[layout]
    bodies = 1 + max(max(pair) for pair in ends)
    typical = np.exp(random.uniform(*np.log(_MASS)))
    mass = tuple(map(float, typical * random.uniform(0.5, 1.5, bodies)))
    relative = typical * random.uniform(0.6, 1.6, len(ends))
    unit = Rig(mass, ends, tuple(map(float, relative)), (0.0,) * len(ends))
    wanted = np.exp(random.uniform(*np.log(_FREQUENCY)))
    stiffness = relative * (wanted / unit.frequencies[0]) ** 2
    ratio = random.uniform(*_DAMPING, len(ends))
    damping = 2 * ratio * stiffness / (2 * np.pi * wanted)
    return replace(unit, stiffness=tuple(map(float, stiffness)), damping=tuple(map(float, damping)))


def believed(random, rig, exact=(), far=""):
    """The workshop's Rig: every value off by OFF either way but those ``exact``; ``far``: one off by 1.6 to 2.2."""
    values = {}
    for name in rig.names:
        off = float(np.exp(random.choice((-1, 1)) * random.uniform(*np.log1p(OFF))))
        if name == far:
            off = float(np.exp(random.choice((-1, 1)) * random.uniform(*np.log((1.6, 2.2)))))
        if name not in exact:
            values[name] = rig.value(name) * off
    return rig.with_values(values)

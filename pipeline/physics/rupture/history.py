"""A whole rupture: steps up to a given time, pictures of the velocity field on the way, and the energy account.

Per metre of depth, with T the static shear, V the slip rate and a the length of a node, from rest:
    released = sum T V a dt (work of the static tractions on the jumps),  heat = sum shear V a dt,
    released - heat = kinetic + strain of the perturbation + what stiffness damping and absorbing edges took.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.rupture.dynamics import Record, advance, at_rest, opening, stable_step
from pipeline.physics.rupture.plate_grid import kinetic_energy, strain_energy


class Energy(NamedTuple):
    """Energies in J/m at the end of a run."""

    released: float
    heat: float
    kinetic: float
    strain: float

    @property
    def taken(self):
        """What stiffness damping and absorbing edges took."""
        return self.released - self.heat - self.kinetic - self.strain


class History(NamedTuple):
    """Record of the interface, pictures, final state and energies of one run."""

    record: Record
    step: float                 # s
    motion: object              # Motion at the end
    frame_time: np.ndarray      # (f,) s
    frames: tuple               # f pairs (lower, upper) of velocity (2, rows, columns) on every ``stride``-th node
    strips: tuple               # f pairs (lower, upper) of velocity next to the interface on every node
    energy: Energy


def run(lower, upper, interface, duration, step_share=0.9, frames=1, stride=(1, 1), strip=(1, 1)):
    """History of ``duration`` s in equal steps of about ``step_share`` of the stability limit.

    ``frames``: number of equally spaced pictures, the last at the end; ``stride``: of their nodes, ``strip``: rows of
    the strips next to the interface, both (lower, upper).
    """
    each = max(1, int(np.ceil(duration / frames / (step_share * stable_step(lower, upper)))))
    step = duration / (each * frames)
    motion, records, pictures, strips = at_rest(lower, upper, interface), [], [], []
    for frame in range(frames):
        records.append(advance(lower, upper, interface, motion, step, each, start=frame * each * step))
        pictures.append(tuple(part[1][:, ::by, ::by].astype(np.float32)
                              for part, by in zip((motion.lower, motion.upper), stride, strict=True)))
        strips.append((motion.lower[1][:, -strip[0]:].astype(np.float32),
                       motion.upper[1][:, :strip[1]].astype(np.float32)))
    record = Record(*(np.concatenate(parts) for parts in zip(*records, strict=True)))
    return History(record, step, motion, step * each * np.arange(1, frames + 1), tuple(pictures),
                   tuple(strips),
                   energies(lower, upper, interface, motion, record, step))


def energies(lower, upper, interface, motion, record, step):
    """Energy account at the end of ``record``; an open gap has worked against the static pressure."""
    pressed = float((interface.length * interface.pressure * (opening(interface, motion) - interface.gap)).sum())
    weighted = step * interface.length * record.slip_rate.astype(float)
    parts = (lower, motion.lower), (upper, motion.upper)
    return Energy(float((weighted * interface.shear).sum()) - pressed, float((weighted * record.shear).sum()),
                  sum(kinetic_energy(grid, state[1]) for grid, state in parts),
                  sum(strain_energy(grid, state[0]) for grid, state in parts))

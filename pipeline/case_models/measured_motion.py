"""A measured motion as a bench reads it, and the forces along it, behind the filters of a balance of forces.

A fit asks for the same motion under many values of a bench, most of which touch but a few of its parts: each part is
kept for the last few values that it depends on.
"""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from pipeline.physics.time_stepping.elements import alone
from pipeline.physics.virtual_rig.force_residual import (
    Motion,
    applied_force,
    below,
    channel_shares,
    drawn_forces,
    element_forces,
    moving,
    thinned,
)
from pipeline.physics.virtual_rig.inputs import holding, run_inputs
from pipeline.physics.virtual_rig.response import Run, run_drive

#: results kept of each part
_KEPT = 4


@dataclass(frozen=True, kw_only=True)
class MeasuredMotion:
    """Displacements ``measured`` {channel: (samples,)} of a Run under the section ``equation``.

    ``rate_doubt`` (n, samples) m/s that to which its speed is known, None where it is exact; ``kept`` {part: {key:
    result}}: the last results.
    """

    run: Run
    measured: dict
    equation: object
    rate_doubt: np.ndarray | None = None
    kept: dict = field(default_factory=dict, compare=False, init=False)

    def __getstate__(self):
        return self.__dict__ | {"kept": {}}

    def thinned(self, values):
        """Values (n, samples) thinned out to (n, m)."""
        return thinned(values, self.equation.decimation, self.equation.trim)

    def motion(self, bench):
        """(Motion behind the low pass, the same thinned out), kept for benches that read their channels alike.

        Both are linear in the channels and in a constant, so that no gain or offset asks for another spline.
        """
        def found():
            channels, shares = channel_shares(bench, self.measured)
            shares = shares / [c.gain for c in channels]
            read = [self._once(f"channel {c.name}", unit, partial(self._read, unit))
                    for c in channels for unit in [replace(c, gain=1.0, offset=0.0)]]
            still = shares @ [c.offset for c in channels]
            return tuple(_combined(shares, [r[k] for r in read], still * level)
                         for k, level in enumerate((1.0, self._level)))

        return self._once("motion", (bench.channels, bench.model.size), found)

    def _read(self, channel):
        """(Motion (1, samples) that a channel shows, behind the low pass, the same thinned out)."""
        shown = channel.measured(self.measured[channel.name], self.run.time)[None]
        motion = moving(below(self.run, shown, self.equation.corner), 1 / self.run.sample_rate, self.equation.corner)
        return motion, motion.thinned(self.equation.decimation, self.equation.trim)

    @property
    def _level(self):
        """What thinning makes of a constant of 1: its filter ripples by a hundredth."""
        return self._once("level", None, lambda: self.thinned(np.ones((1, self.run.samples))).mean())

    def applied(self, bench):
        """Forces (n, m) of the inputs, kept for benches on which they act alike."""
        inputs = tuple(np.asarray(force, float).tobytes() for force in run_inputs(bench, self.run))
        key = inputs, bench.model.input_rows.tobytes(), holding(bench, self.run).tobytes()
        return self._once("applied", key, lambda: applied_force(
            bench, self.run, self.equation.decimation, self.equation.trim, self.equation.corner))

    def drawn(self, bench, motion):
        """(Forces (n, m) of elements and contacts, [Resting] they are without): element by element, each kept, where
        there are no contacts and the drive turns evenly."""
        elements, turning = bench.model.elements, run_drive(bench, self.run)
        if len(bench.model.contacts.area) or np.ndim(turning):
            return self._forces(*drawn_forces(bench, self.run, motion, self.rate_doubt))
        total, resting, kernel = 0.0, [], alone(elements)
        for k, element in enumerate(elements):
            part = slice(*kernel.first[k:k + 2])
            values = (element.row, kernel.parameter[k], kernel.stiffness[part], kernel.limit[part])
            key = bench.channels, turning, int(kernel.kind[k]), *(np.asarray(v, float).tobytes() for v in values)
            forces, still = self._once(f"element {k}", key, lambda e=element: self._forces(
                *element_forces(bench, self.run, motion, (e,), self.rate_doubt)))
            total, resting = total + forces, [*resting, *still]
        return total, resting

    def _forces(self, forces, resting):
        """(Forces (n, samples), [Resting]) behind low pass and thinning."""
        shares = [np.clip(self.thinned(r.share[None])[0], 0.0, 1.0) for r in resting]
        return (self.thinned(below(self.run, forces, self.equation.corner)),
                [r._replace(share=share) for r, share in zip(resting, shares, strict=True)])

    def _once(self, part, key, found):
        """``found()``, or what it was under an equal ``key``; the last few are kept."""
        kept = self.kept.setdefault(part, {})
        if key in kept:
            kept[key] = kept.pop(key)
        else:
            result = found()
            if len(kept) >= _KEPT:
                del kept[next(iter(kept))]
            kept[key] = result
        return kept[key]


def _combined(shares, motions, still):
    """Motion (n, m) of ``shares`` (n, c) of Motions (1, m), displacements less ``still`` (n,)."""
    displacement, speed, acceleration = (shares @ np.concatenate(parts) for parts in zip(*motions, strict=True))
    return Motion(displacement - still[:, None], speed, acceleration)

"""Recorded runs as balances of forces: measured displacements put into the equation of motion, nothing simulated.

What counts as observed is the force that the inputs put on each coordinate; the model says what force the measured
motion needs: the applied one and what is left of the equation of motion (``physics.equation_residual``).

    M q'' + C q' + ... - f,    in N of the force as recorded, and of the motion as recorded where a gain makes it less

No factor on every term makes it vanish, whatever is missing: neither a gain with masses and dampings as much smaller,
nor one that makes the motion small. A run without any force has no balance to compare. A body at rest under rigid
dry friction is held by any force up to that of friction; what this takes off the noise of the balance is put back as
noise, or friction would explain noise.
"""

import zlib
from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.measured_motion import MeasuredMotion
from pipeline.case_models.runs import Recorded
from pipeline.contract import ConfigError
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.force_residual import (
    applied_force,
    coordinates,
    forces_missing,
    held_at_rest,
    linear_forces,
    rate_doubt,
    smoothed,
    thinned,
)
from pipeline.physics.virtual_rig.response import Run, run_drive
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT

#: samples of the parabola whose slope is the speed at the start
_FIRST = 7
#: force over the noise of a balance below which it is lost in it
_LOST = 0.1


@dataclass(frozen=True, kw_only=True)
class Balance(MeasuredMotion):
    """One recorded run: ``seen`` (Recorded) holds the applied forces (n, m) in N, one channel a coordinate.

    ``size`` (n,) m is the standard deviation of the motion as the given bench reads it, ``noise`` (n,) N that of the
    balance.
    """

    seen: Recorded
    size: np.ndarray
    noise: np.ndarray | float = 0.0

    def predicted(self, bench):
        """Forces (n, m) in N that the measured motion needs on this bench. ConfigError as of ``equation_residual``."""
        motion, thin = self.motion(bench)
        drawn, resting = self.drawn(bench, motion)
        applied = self.applied(bench)
        if np.ndim(run_drive(bench, self.run)):
            left = self.thinned(linear_forces(bench, self.run, motion))
        else:
            left = linear_forces(bench, self.run, thin)
        left, lost = left + drawn - applied, 0.0
        if resting:
            left, taken = held_at_rest(left, resting, np.broadcast_to(self.noise, len(left)))
            draw = np.random.default_rng(zlib.crc32(self.run.name.encode())).standard_normal(left.shape)
            lost = np.sqrt(taken) * np.reshape(self.noise, (-1, 1)) * draw
        return self.seen.samples + self._counted(thin, applied)[:, None] * left + lost

    def left(self, bench):
        """(forces in N, displacements in m, velocities in m/s), each (n, m): forces missing on the coordinates."""
        motion, thin = self.motion(bench)
        return (self.thinned(forces_missing(bench, self.run, motion, self.equation.corner)), thin.displacement,
                thin.speed)

    def _counted(self, thin, applied):
        """Factor (n,) of what is left on a bench that takes the motion for ``thin`` and the inputs for ``applied``: no
        gain of an input, or of a channel that makes the motion small, makes it less."""
        size, ways = thin.displacement.std(axis=1), [np.sqrt(np.mean(f**2)) for f in (self.seen.samples, applied)]
        as_measured = np.maximum(np.divide(self.size, size, out=np.ones(len(size)), where=size > 0), 1.0)
        return as_measured * (ways[0] / ways[1] if min(ways) > 0 else 1.0)


def balance(bench, recorded, equation):
    """Balance of a Recorded run under the section ``equation``.

    ConfigError for missing samples, runs too short, and runs in which no input acts.
    """
    measured = _displacements(bench, recorded)
    kept = (recorded.run.samples - 2 * equation.trim) // equation.decimation
    if kept < 2:
        raise ConfigError(f"run {recorded.run.name}", "samples left between its ends", f"{recorded.run.samples} in all",
                          "trim and decimate less, or take a longer stretch")
    applied = applied_force(bench, recorded.run, equation.decimation, equation.trim, equation.corner)
    refuse_unforced(recorded.run.name, applied, 0.0)
    rate = recorded.run.sample_rate / equation.decimation
    thin = Run(recorded.run.name, (applied.shape[1] - 1) / rate, rate, conditions=recorded.run.conditions)
    seen = Recorded(thin, channel_names(bench), ("N",) * len(applied), applied, np.ones(applied.shape, bool),
                    recorded.repeat_of)
    size = thinned(smoothed(bench, recorded.run, measured, equation.corner), equation.decimation, equation.trim)
    doubt = rate_doubt(bench, recorded.run, measured, equation.corner)
    return Balance(run=recorded.run, measured=measured, equation=equation, rate_doubt=doubt, seen=seen,
                   size=size.std(axis=1))


def refuse_unforced(name, applied, noise):
    """ConfigError where all forces ``applied`` (n, m) N are 0, or lost in the ``noise`` (n,) N of the balance."""
    size = np.sqrt(np.mean(applied**2, axis=1))
    if not (size > _LOST * noise).any():
        raise ConfigError(f"run {name}: bench.forward: equation", "a run with an applied force",
                          f"at most {np.max(size, initial=0.0):.3g} N root mean square",
                          "a balance of a free motion closes as soon as everything in it is small: compare the motion"
                          " instead (bench.forward: simulation, where bench.start: fitted finds how it began)")


def channel_names(bench):
    """(n,) names of the forces on the coordinates, by their bodies."""
    return tuple(f"force on {name}" for name in body_names(bench))


def body_names(bench):
    """(n,) names of the coordinates: that of the body, with a number where it has several."""
    owners = [bench.model.body_name[k] for k in bench.model.coordinate_body]
    return tuple(owner if owners.count(owner) == 1 else f"{owner} {owners[:k].count(owner) + 1}"
                 for k, owner in enumerate(owners))


def measured_start(bench, recorded):
    """Start where and as fast as the displacement channels of a Recorded run are: a parabola through its first samples.

    ConfigError where they do not give every coordinate.
    """
    motion = coordinates(bench, recorded.run, _displacements(bench, recorded))[:, :_FIRST]
    if motion.shape[1] < 3:
        raise ConfigError(f"run {recorded.run.name}", "three samples or more", f"{motion.shape[1]}")
    curve = np.polynomial.polynomial.polyfit(recorded.run.time[:motion.shape[1]], motion.T, 2)
    return Start(curve[0], curve[1])


def begun(bench, recorded):
    """The Recorded run with its measured start."""
    return replace(recorded, run=replace(recorded.run, start=measured_start(bench, recorded)))


def _displacements(bench, run):
    """{channel: (samples,)} of the displacement channels; ConfigError where samples are missing."""
    shown = {c.name for c in bench.channels if c.measurand == DISPLACEMENT}
    for channel, valid in zip(run.channels, run.valid, strict=True):
        if channel in shown and not valid.all():
            raise ConfigError(f"run {run.run.name}: {channel}", "no missing samples, because they are differentiated",
                              f"{int((~valid).sum())} missing", "declare the stretches between them as runs")
    return {c: s for c, s in zip(run.channels, run.samples, strict=True) if c in shown}

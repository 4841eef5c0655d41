"""Recorded runs as balances of forces: measured displacements put into the equation of motion, nothing simulated.

What counts as observed is the force that the inputs put on each coordinate; the model says what force the measured
motion needs: the applied one and what is left of the equation of motion (``physics.equation_residual``).
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.case_models.runs import Recorded
from pipeline.contract import ConfigError
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.force_residual import applied_force, coordinates, forces_missing, smoothed, thinned
from pipeline.physics.virtual_rig.response import Run
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT

#: samples of the parabola whose slope is the speed at the start
_FIRST = 7


@dataclass(frozen=True)
class Balance:
    """One recorded run: ``seen`` (Recorded) holds the applied forces (n, m) in N, one channel a coordinate.

    ``run`` is the Run behind it, ``measured`` {channel: (samples,)} its displacements, ``equation`` the section;
    ``motions`` holds the last filtered motion.
    """

    seen: Recorded
    run: Run
    measured: dict
    equation: object
    motions: dict = field(default_factory=dict, compare=False)

    def predicted(self, bench):
        """Forces (n, m) in N that the measured motion needs on this bench. ConfigError as of ``equation_residual``."""
        left = forces_missing(bench, self.run, self._motion(bench))
        return self.seen.samples + thinned(left, self.equation.decimation, self.equation.trim)

    def left(self, bench):
        """(forces in N, displacements in m, velocities in m/s), each (n, m): forces missing on the coordinates."""
        motion = self._motion(bench)
        speed = np.gradient(motion, 1 / self.run.sample_rate, axis=1, edge_order=2)
        return tuple(thinned(values, self.equation.decimation, self.equation.trim)
                     for values in (forces_missing(bench, self.run, motion), motion, speed))

    def _motion(self, bench):
        """Filtered displacements (n, samples), kept for benches that read their channels alike."""
        key = (bench.channels, bench.model.size)
        if key not in self.motions:
            self.motions.clear()
            self.motions[key] = smoothed(bench, self.run, self.measured, self.equation.corner)
        return self.motions[key]


def balance(bench, recorded, equation):
    """Balance of a Recorded run under the section ``equation``. ConfigError for missing samples, and runs too short."""
    measured = _displacements(bench, recorded)
    kept = (recorded.run.samples - 2 * equation.trim) // equation.decimation
    if kept < 2:
        raise ConfigError(f"run {recorded.run.name}", "samples left between its ends", f"{recorded.run.samples} in all",
                          "trim and decimate less, or take a longer stretch")
    applied = applied_force(bench, recorded.run, equation.decimation, equation.trim)
    rate = recorded.run.sample_rate / equation.decimation
    thin = Run(recorded.run.name, (applied.shape[1] - 1) / rate, rate, conditions=recorded.run.conditions)
    seen = Recorded(thin, channel_names(bench), ("N",) * len(applied), applied, np.ones(applied.shape, bool),
                    recorded.repeat_of)
    return Balance(seen, recorded.run, measured, equation)


def channel_names(bench):
    """(n,) names of the forces on the coordinates, by their bodies."""
    owners = [bench.model.body_name[k] for k in bench.model.coordinate_body]
    return tuple(f"force on {owner}" if owners.count(owner) == 1 else f"force on {owner} {owners[:k].count(owner) + 1}"
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


def started(bench, runs, settings):
    """{name: Recorded} with the starts that the section ``bench`` asks for."""
    return {name: begun(bench, run) for name, run in runs.items()} if settings.measured_start else runs


def _displacements(bench, run):
    """{channel: (samples,)} of the displacement channels; ConfigError where samples are missing."""
    shown = {c.name for c in bench.channels if c.measurand == DISPLACEMENT}
    for channel, valid in zip(run.channels, run.valid, strict=True):
        if channel in shown and not valid.all():
            raise ConfigError(f"run {run.run.name}: {channel}", "no missing samples, because they are differentiated",
                              f"{int((~valid).sum())} missing", "declare the stretches between them as runs")
    return {c: s for c, s in zip(run.channels, run.samples, strict=True) if c in shown}

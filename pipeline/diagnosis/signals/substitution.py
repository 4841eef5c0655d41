"""The stage of a mismatch by substitution: what was measured between two stages, in place of what is modelled there.

Where the recordings hold a measured friction curve, it takes the place of the friction of all contacts; where they
hold identified modes of the bodies without contact, their frequencies and damping ratios take the place of those of the
model.
The recalibrated nominal model is simulated again with either; the mismatch lies in a stage that takes it away, block by
block of the fitted runs.
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy

from pipeline.contract import BrakechainError
from pipeline.diagnosis.problem import Locator
from pipeline.diagnosis.signals.forward_model import Simulated, shown
from pipeline.diagnosis.signals.localisation import fitted
from pipeline.diagnosis.signals.start_states import begun_as
from pipeline.inference.search import localisation
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.signals.pole_identification import likeness

#: name of the axis, and stages that can be measured
AXIS, FRICTION, STRUCTURE = "substitution", "friction", "structure"
#: blocks of a run whose errors are compared
_BLOCKS = 8
#: how far a measured frequency may lie from that of a mode, as a share, before it costs as much as another shape
_NEAR = 0.05


@dataclass(frozen=True)
class Substituted:
    """Locator by ``axes``, and by an axis over the stages in ``swaps`` {stage: Swap} of ``runs`` {name: Run}."""

    axes: Locator
    bench: object
    runs: dict
    problem: object
    budget: dict
    swaps: dict
    draws: int = 2000
    seed: int = 0

    def located(self, diagnosis):
        null = diagnosis.recalibrated
        axes, bench = self.axes.located(diagnosis), fitted(self.bench, null)
        runs = begun_as(self.runs, null.hypothesis, null.values)
        modelled, decrease = self._squares(bench, runs), {}
        for stage, swap in self.swaps.items():
            try:
                decrease[stage] = modelled - self._squares(swap.applied(bench), runs)
            except BrakechainError:     # what cannot be simulated takes nothing away
                continue
        if not decrease:
            return axes
        stages = localisation.stages(tuple(decrease), decrease, self.draws, self.seed)
        axes[AXIS] = (stages, "", None)
        return axes

    def _squares(self, bench, runs):
        """Squared whitened error (blocks,) of the fitted ``runs`` {name: Run}."""
        squares = []
        for run in self.problem.training:
            left = run.samples - shown(bench, runs[run.name], run.channels)
            squares += [part @ part for part in np.array_split(self.budget[run.name].whiten(left), _BLOCKS)]
        return np.array(squares)


class Swap(Protocol):
    """Puts something measured in place of what a Bench models."""

    def applied(self, bench): ...


def substituted(problem, recording, settings):
    """The DiagnosisProblem of simulated runs, with the axis where its product Recording holds what it takes."""
    forward = problem.problem.predict
    if not isinstance(forward, Simulated) or not (measured := swaps(recording, forward.bench, settings.held_out)):
        return problem
    return replace(problem, locator=Substituted(problem.locator, forward.bench, forward.runs, problem.problem,
                                                problem.budget, measured, seed=settings.seed))


def swaps(recording, bench, held_out=()):
    """{stage: Swap} of what a product Recording holds, runs ``held_out`` left aside."""
    runs = [run for name, run in recording.runs.items() if name not in held_out]
    curves, modes = ([part for run in runs for part in getattr(run, kind).values()] for kind in ("friction", "modes"))
    measured = {FRICTION: MeasuredCurve(measured_law(curves))} if curves and len(bench.model.contacts.area) else {}
    return measured | ({STRUCTURE: MeasuredShapes(tuple(modes))} if modes else {})


@dataclass(frozen=True)
class MeasuredCurve:
    """Puts a measured FrictionLaw in place of the friction of all contacts, memory and conditions included."""

    law: FrictionLaw

    def applied(self, bench):
        return bench.with_friction("contact", lambda friction: replace(friction, law=self.law, backward=1.0, states=(),
                                                                  conditions=()))


def measured_law(curves):
    """FrictionLaw over pressure and speed of products MeasuredFriction, means over all else; where a pressure lacks a
    speed, its nearest neighbour counts."""
    pressure, speed, friction = (np.concatenate([getattr(curve, key) for curve in curves])
                                 for key in ("pressure", "speed", "friction"))
    (p, i), (v, j) = (np.unique(values, return_inverse=True) for values in (pressure, speed))
    count, total = np.zeros((2, len(p), len(v)))
    np.add.at(count, (i, j), 1.0)
    np.add.at(total, (i, j), friction)
    known = count > 0
    table = np.divide(total, count, out=np.zeros(total.shape), where=known)
    if not known.all():
        index = np.indices(table.shape)
        near = scipy.interpolate.NearestNDInterpolator(index[:, known].T, table[known])
        table = np.where(known, table, near(*index))
    return FrictionLaw(p, v, [0.0], table[:, :, None])


@dataclass(frozen=True)
class MeasuredShapes:
    """Puts frequencies and damping ratios of products MeasuredModes in place of those of the modes of the bodies that
    they are nearest to, by frequency and, at the sensors that they share, by shape."""

    measured: tuple

    def applied(self, bench):
        mass, damping, stiffness = bench.model.supported()
        squared, shape = scipy.linalg.eigh((stiffness + stiffness.T) / 2, mass)
        rows, stiff, lossy = mass @ shape, np.zeros(mass.shape), np.zeros(mass.shape)
        for modes in self.measured:
            for k, mode in self._pairs(bench, modes, np.sqrt(np.maximum(squared, 0.0)), shape):
                outer, rate = np.outer(rows[:, mode], rows[:, mode]), 2 * np.pi * modes.frequency[k]
                stiff += (rate**2 - squared[mode]) * outer
                if modes.damping_ratio[k] > 0:
                    modal = shape[:, mode] @ damping @ shape[:, mode]
                    lossy += (2 * modes.damping_ratio[k] * rate - modal) * outer
        model = bench.model
        return replace(bench, model=replace(model, stiffness=model.stiffness + stiff, damping=model.damping + lossy))

    @staticmethod
    def _pairs(bench, modes, rate, shape):
        """[(measured mode, mode of the model)]."""
        cost = abs(np.log(np.maximum(rate, 1e-300) / (2 * np.pi * modes.frequency[:, None]))) / _NEAR
        known = [k for k, name in enumerate(modes.place) if name in bench.model.sensor_name]
        if len(known) > 1:
            rows = np.array([bench.sensor(str(modes.place[k])) for k in known])
            cost = cost + 1 - likeness(np.asarray(modes.shape)[:, known], (rows @ shape).T)
        return list(zip(*scipy.optimize.linear_sum_assignment(cost), strict=True))

"""Motion of the reduced sliding model under forces that are given step by step, with the laws of its contacts.

Contacts lift, close and stick as in ``pipeline.physics.time_stepping``, which also says what is left out: friction
that turns sideways with the slip. The motion starts in steady sliding under the nominal pressure of an operating point.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.matrices.sliding_terms import sliding_state
from pipeline.case_models.steady_sliding import sliding_friction
from pipeline.exports.run_products import sliding_products
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import stepper
from pipeline.physics.virtual_rig.response import Bench

#: excess of a step over the longest one that is rounding
_EVEN = 1e-9


@dataclass
class ContactMotion:
    """A ``bench`` whose model has inputs (i,) with steady forces ``steady`` (i,) N, in steps of at most ``longest`` s.

    ``state``: the Start of the next step; ``origin`` (s,) m: the sensors in steady sliding; ``outputs`` (2 s + 2,):
    displacement and velocity sensor by sensor about steady sliding, then all normal and all friction forces, N.
    """

    bench: Bench
    steady: np.ndarray
    longest: float
    state: object
    origin: np.ndarray
    outputs: np.ndarray
    _steppers: dict = field(default_factory=dict)

    @classmethod
    def of(cls, folder, operating, longest):
        """Of the products of a run in ``folder``, at an operating point; ``longest`` step in s.

        Inputs are those of the unit of the linearised model. Errors as of ``sliding_state``; ConvergenceError where
        steady sliding is not found.
        """
        modes, model, friction_map, effects = sliding_products(folder)
        case = sliding_state(modes, model, friction_map, effects, operating)
        given = sliding_friction(friction_map, model, case.settings)[0]
        bench = with_effects(replace(case.posed.base, friction=given), effects, channels=False)
        load = modes.operating_pressure[operating] * model.input_area
        start = steady_start(bench.model, bench.law, bench.friction, load)
        whole = with_inputs(bench.model, model.input_area)
        origin = whole.sensor_rows @ start.displacement
        made = cls(replace(bench, model=whole), np.concatenate(([0.0], load, np.zeros(len(origin)))), longest, start,
                   origin, np.zeros(2 * len(origin) + 2))
        drawn = start.friction if start.friction is not None else np.zeros(1)
        made.outputs[-2:] = np.sum(start.normal), np.sum(drawn)
        return made

    def step(self, forces, length):
        """Go on by ``length`` s under ``forces`` (i,) beside the steady ones; errors as of ``simulate``."""
        count = max(int(np.ceil(length / self.longest * (1 - _EVEN))), 1)
        motion = self._stepper(length / count).run(length, inputs=self.steady + forces, record_every=count,
                                                   start=self.state, book=False)
        self.state = motion.end
        seen = np.column_stack((motion.displacement[:, -1] - self.origin, motion.velocity[:, -1]))
        self.outputs = np.concatenate((seen.ravel(), [motion.end.normal.sum(), motion.end.friction.sum()]))

    def _stepper(self, step):
        """The Stepper of this step, made once."""
        key = float(f"{step:.12g}")
        if key not in self._steppers:
            bench = self.bench
            shared = next((s.modes for s in self._steppers.values()), None) or modal_system(bench.model)
            self._steppers[key] = stepper(bench.model, bench.law, bench.friction, key, shared)
        return self._steppers[key]


def with_inputs(model, area):
    """The SlidingModel with the inputs of a unit: the pad pressure on ``area`` (i,) m^2, its own, forces at sensors."""
    names = ("pressure", *model.input_name, *(f"at_{name}" for name in model.sensor_name))
    rows = np.vstack((area @ model.input_rows, model.input_rows, model.sensor_rows))
    return replace(model, input_name=names, input_rows=rows)

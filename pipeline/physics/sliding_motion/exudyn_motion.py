"""The sliding motion as an exudyn multibody system: one first-order object, one compiled force function.

The modal coordinates are those of an ``ObjectGenericODE1``; exudyn steps them by its explicit Runge-Kutta method of
fourth order, which shares nothing with the exponential steps but the contact forces.
"""

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.sliding_motion.exponential_step import observed
from pipeline.physics.sliding_motion.motion import NO_BOOK, Run

#: largest product of a root and a step, to which longer steps are cut: beyond it contacts fail to settle
_LONGEST = 1.25


def run(system, start, step, duration, every=1, book=False):
    """The Run of a SlidingMotion by exudyn; arguments as of ``SlidingMotion.run``.

    Steps longer than Runge-Kutta steps may be are cut. Raises ConvergenceError where exudyn gives up or the motion
    grows without bound.
    """
    parts = int(np.ceil(step * abs(system.modes.root).max() / _LONGEST))
    start, count = start[0] if isinstance(start, tuple) else start, parts * round(duration / step)
    step, every = step / parts, parts * every
    watch = _Watch(system, start, step, count, every, book)

    def rate(multibody, time, item, coordinates):
        return system.real_rate(np.array(coordinates))

    _solve(rate, np.concatenate((start.real, start.imag)), count, step, watch)
    return watch.run()


def _solve(rate, start, count, step, watch):
    """Integrate z' = ``rate``; ``watch.after(number, z)`` after every step."""
    import exudyn
    from exudyn.itemInterface import NodeGenericODE1, ObjectGenericODE1

    def after_step(multibody, time):
        number = round(time / step)
        if number and watch.wants(number):
            watch.after(number, multibody.systemData.GetODE1Coordinates())
        return True

    multibody = exudyn.SystemContainer().AddSystem()
    node = multibody.AddNode(NodeGenericODE1(referenceCoordinates=0 * start, initialCoordinates=start,
                                             numberOfODE1Coordinates=len(start)))
    multibody.AddObject(ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rate))
    multibody.Assemble()
    multibody.SetPostStepUserFunction(after_step)
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = count, count * step
    talkative, exudyn.config.printToConsole = exudyn.config.printToConsole, False
    try:
        done = multibody.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44)
    except exudyn.SolverError:
        done = False
    finally:
        exudyn.config.printToConsole = talkative
    if done is False or not watch.finite:
        raise ConvergenceError("sliding motion: exudyn", "a finite motion", "none", "lower limit_cycle.step")


class _Watch:
    """States, shares and energies every so many steps; with a book, the power of every step."""

    def __init__(self, system, start, step, count, every, book):
        rows = count // every
        self._system, self._step, self._every, self._count = system, step, every, count
        self._energy = system.energy if book else NO_BOOK
        self._state = np.empty((rows, 2 * len(start)))
        self._share, self._kept = np.empty((rows, 2)), np.zeros((rows, 4))
        self._power, self._spent, self._end = np.zeros(3), np.zeros(3), None
        self._observe(np.concatenate((start.real, start.imag)))

    @property
    def finite(self):
        """Whether all steps were seen, and where they end."""
        return self._end is not None and np.isfinite(self._end).all()

    def wants(self, number):
        """Whether to look at a step."""
        return self._energy.stored.size > 0 or number % self._every == 0 or number == self._count

    def after(self, number, state):
        """Keep what is asked for of the ``state`` (2m,) after step ``number``."""
        before = self._power.copy()
        share = self._observe(state)
        self._spent += 0.5 * self._step * (before + self._power)
        if number == self._count:
            self._end = np.array(state)
        if number % self._every == 0:
            row = number // self._every - 1
            self._state[row], self._share[row] = state, share
            if self._energy.stored.size:
                self._kept[row] = *self._spent, state @ (self._energy.stored @ state)

    def _observe(self, state):
        return observed(self._system.patches, self._system.motion, self._energy, state, self._power)

    def run(self):
        """The Run, whose end is where another may start."""
        half = self._state.shape[1] // 2
        work, loss, added, stored = self._kept.T
        return Run(self._step * self._every * np.arange(1, len(self._state) + 1),
                   self._state[:, :half] + 1j * self._state[:, half:], *self._share.T, work, loss, added, stored, 4.0,
                   (self._end[:half] + 1j * self._end[half:],))

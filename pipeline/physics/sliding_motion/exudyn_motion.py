"""The sliding motion as an exudyn multibody system: one first-order object, one compiled force function.

The modal coordinates are those of an ``ObjectGenericODE1``; exudyn steps them by its explicit Runge-Kutta method of
fourth order, which shares nothing with the exponential steps but the contact forces.
"""

import numpy as np

from pipeline.contract.errors import ConvergenceError


def integrate(system, start, step, duration, every=1):
    """(time (r,), states (r, m)) of a SlidingMotion from modal coordinates ``start`` (m,), every so many steps.

    Raises ConvergenceError where exudyn gives up or the motion grows without bound.
    """
    import exudyn
    from exudyn.itemInterface import NodeGenericODE1, ObjectGenericODE1

    half, count = len(start), round(duration / step)
    states = np.empty((count // every, half), complex)

    def rate(multibody, time, item, coordinates):
        values = np.array(coordinates)
        change = system.rate(values[:half] + 1j * values[half:])
        return np.concatenate((change.real, change.imag))

    def after_step(multibody, time):
        number = round(time / step)
        if number and number % every == 0:
            values = multibody.systemData.GetODE1Coordinates()
            states[number // every - 1] = values[:half] + 1j * values[half:]
        return True

    multibody = exudyn.SystemContainer().AddSystem()
    node = multibody.AddNode(NodeGenericODE1(
        referenceCoordinates=np.zeros(2 * half), initialCoordinates=np.concatenate((start.real, start.imag)),
        numberOfODE1Coordinates=2 * half))
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
    if done is False or not np.isfinite(states).all():
        raise ConvergenceError("sliding motion: exudyn", "a finite motion", "none", "take a shorter step")
    return step * every * np.arange(1, len(states) + 1), states

"""The pads on the rigid disc as an exudyn multibody system: one generic object, one compiled force function.

The whole reduced assembly is one ``ObjectGenericODE2`` whose user functions are the compiled contact force and its
exact tangent. The four jointed sub-discs turn at a prescribed speed and need no coordinates of their own: they enter
through the patches (a test holds the jointed bodies against this form). Time stepping is exudyn's implicit
trapezoidal rule with modified Newton iterations and a fixed step, after which memory of friction, wear and elements
goes on.
"""

from functools import partial

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.pads.memory import accept, begun, remembers
from pipeline.physics.pads.pad_system import STEP_TOLERANCE, force, tangent

#: the Jacobian is renewed when an iteration leaves more than this part of the residual
CONTRACTION = 0.1


def integrate(system, start, step, steps, record_every=1, scale=None):
    """(time (m,), displacement (m, n), velocity (m, n)) at every ``record_every``-th step from rest at ``start``.

    ``system`` is a PadSystem, ``step`` in s. Every step ends with a residual below STEP_TOLERANCE times ``scale``
    (N in the system's coordinates; default the load). Raises ConvergenceError naming the time and the residual
    otherwise.
    """
    import exudyn

    scale = np.linalg.norm(system.load) if scale is None else scale
    multibody = exudyn.SystemContainer().AddSystem()
    system, memory = begun(system, start, step)
    _add_assembly(multibody, system, start)
    multibody.Assemble()
    accepted = partial(accept, system, memory) if remembers(system) else None
    states = _record(multibody, start, step, steps, record_every, accepted)
    solver = exudyn.MainSolverImplicitSecondOrder()
    if not _solve(exudyn, solver, multibody, _settings(exudyn, step, steps, STEP_TOLERANCE * scale)):
        raise ConvergenceError(f"multibody: exudyn at t = {solver.it.currentTime:.6g} s",
                               f"a residual below {STEP_TOLERANCE:g} of the load",
                               f"{solver.conv.residual / scale:.3g}", "take a shorter step")
    return np.arange(states.shape[1]) * (step * record_every), *states


def _add_assembly(multibody, system, start):
    from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

    n = np.size(start)

    def right_hand_side(multibody, time, item, displacement, velocity):
        return force(system, time, np.array(displacement), np.array(velocity))

    def jacobian(multibody, time, item, displacement, velocity, position_factor, velocity_factor):
        stiffness, damping = tangent(system, time, np.array(displacement), np.array(velocity))
        return position_factor * stiffness + velocity_factor * damping

    node = multibody.AddNode(NodeGenericODE2(
        referenceCoordinates=np.zeros(n), initialCoordinates=start, initialCoordinates_t=np.zeros(n),
        numberOfODE2Coordinates=n))
    multibody.AddObject(ObjectGenericODE2(
        nodeNumbers=[node], massMatrix=_sparse(system.mass), forceUserFunction=right_hand_side,
        jacobianUserFunction=jacobian))


def _sparse(matrix):
    import exudyn

    rows, columns = np.nonzero(matrix)
    container = exudyn.MatrixContainer()
    container.SetWithSparseMatrix(np.column_stack((rows, columns, matrix[rows, columns])), *matrix.shape)
    return container


def _record(multibody, start, step, steps, record_every, accepted):
    """(2, m, n) array that the solver fills with displacement and velocity as it goes, and tells ``accepted``."""
    states = np.zeros((2, steps // record_every + 1, np.size(start)))
    states[0, 0] = start

    def after_step(multibody, time):
        count = round(time / step)
        if accepted is not None:
            accepted(time, np.array(multibody.systemData.GetODE2Coordinates()),
                     np.array(multibody.systemData.GetODE2Coordinates_t()), step)
        if count % record_every == 0:
            states[:, count // record_every] = (multibody.systemData.GetODE2Coordinates(),
                                                multibody.systemData.GetODE2Coordinates_t())
        return True

    multibody.SetPostStepUserFunction(after_step)
    return states


def _solve(exudyn, solver, multibody, settings):
    talkative = exudyn.config.printToConsole
    exudyn.config.printToConsole = False
    try:
        return solver.SolveSystem(multibody, settings)
    except exudyn.SolverError:
        return False
    finally:
        exudyn.config.printToConsole = talkative


def _settings(exudyn, step, steps, tolerance):
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = steps, steps * step
    integration.adaptiveStep = integration.automaticStepSize = False
    integration.discontinuous.ignoreMaxIterations = False
    integration.generalizedAlpha.useNewmark = integration.generalizedAlpha.useIndex2Constraints = True
    integration.newton.modifiedNewtonContractivity = CONTRACTION
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenDense
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-300, tolerance
    return settings

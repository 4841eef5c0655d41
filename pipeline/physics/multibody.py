"""The pads on the rigid disc as an exudyn multibody system: one generic object, one compiled force function.

The whole reduced assembly is one ``ObjectGenericODE2`` whose user functions are the compiled contact force and its
exact tangent. The four jointed sub-discs turn at a prescribed speed and need no coordinates of their own: they enter
through the patches (a test holds the jointed bodies against this form). Time stepping is exudyn's implicit
trapezoidal rule with modified Newton iterations and a fixed step.
"""

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.patch_contact import contact_force, contact_tangent

TOLERANCE = 1e-10


def integrate(system, start, step, steps, record_every=1):
    """(time (m,), displacement (m, n), velocity (m, n)) at every ``record_every``-th step from rest at ``start``.

    ``system`` is a PadSystem, ``step`` in s. The residual of every step is below 1e-10 of the load. Raises
    ConvergenceError naming the time and the residual of the first step that did not converge.
    """
    import exudyn

    multibody = exudyn.SystemContainer().AddSystem()
    _add_assembly(multibody, system, start)
    multibody.Assemble()
    states = _record(multibody, np.size(start), step, steps, record_every)
    solver = exudyn.MainSolverImplicitSecondOrder()
    settings = _settings(exudyn, step, steps, TOLERANCE * np.linalg.norm(system.load))
    exudyn.SetWriteToConsole(False)
    try:
        converged, found = solver.SolveSystem(multibody, settings), f"{solver.conv.residual:.3g}"
    except exudyn.SolverError as error:
        converged, found = False, str(error).strip().splitlines()[0]
    finally:
        exudyn.SetWriteToConsole(True)
    if not converged:
        raise ConvergenceError(f"multibody: exudyn at t = {solver.it.currentTime:.6g} s",
                               f"a residual below {TOLERANCE:g} of the load", found, "take a shorter step")
    states[0, 0] = start
    return np.arange(len(states)) * (step * record_every), states[:, 0], states[:, 1]


def _add_assembly(multibody, system, start):
    from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

    n, contact = np.size(start), system.contact

    def force(multibody, time, item, displacement, velocity):
        return contact_force(contact, time, np.asarray(displacement), np.asarray(velocity))

    def tangent(multibody, time, item, displacement, velocity, position_factor, velocity_factor):
        stiffness, damping = contact_tangent(contact, time, np.asarray(displacement), np.asarray(velocity))
        return position_factor * stiffness + velocity_factor * damping

    node = multibody.AddNode(NodeGenericODE2(
        referenceCoordinates=np.zeros(n), initialCoordinates=start, initialCoordinates_t=np.zeros(n),
        numberOfODE2Coordinates=n))
    multibody.AddObject(ObjectGenericODE2(
        nodeNumbers=[node], massMatrix=system.mass, stiffnessMatrix=system.stiffness, dampingMatrix=system.damping,
        forceVector=system.load, forceUserFunction=force, jacobianUserFunction=tangent))


def _record(multibody, size, step, steps, record_every):
    """(m, 2, n) array that the solver fills with displacement and velocity as it goes."""
    states = np.zeros((steps // record_every + 1, 2, size))

    def after_step(multibody, time):
        count = round(time / step)
        if count % record_every == 0:
            states[count // record_every] = (multibody.systemData.GetODE2Coordinates(),
                                             multibody.systemData.GetODE2Coordinates_t())
        return True

    multibody.SetPostStepUserFunction(after_step)
    return states


def _settings(exudyn, step, steps, tolerance):
    settings = exudyn.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = steps, steps * step
    integration.adaptiveStep = integration.automaticStepSize = False
    integration.discontinuous.ignoreMaxIterations = False
    integration.generalizedAlpha.useNewmark = integration.generalizedAlpha.useIndex2Constraints = True
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-300, tolerance
    return settings

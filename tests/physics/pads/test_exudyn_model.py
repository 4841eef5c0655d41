"""The exudyn model: agreement with Newmark, order two, refusal, and the four jointed sub-discs as bodies."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads import newmark
from pipeline.physics.pads.exudyn_model import integrate
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import static_start
from tests.physics.small_pads import block_on_belt, random_assembly


@pytest.mark.exact
def test_exudyn_agrees_with_newmark():
    system = random_assembly()
    modal, modes = preloaded_modes(system, static_start(system))
    start, scale = np.zeros(modes.shape[1]), np.linalg.norm(modes.T @ system.load)
    time, moved, velocity = integrate(modal, start, 1e-5, 400, 3, scale)
    reference = newmark.integrate(modal, start, 1e-5, 400, 3, scale)
    np.testing.assert_array_equal(time, reference[0])
    assert np.abs(moved - reference[1]).max() < 1e-6 * np.abs(reference[1]).max()
    assert np.abs(velocity - reference[2]).max() < 1e-6 * np.abs(reference[2]).max()
    assert np.abs(moved).max() > 0


@pytest.mark.exact
def test_a_block_under_friction_swings_about_its_sliding_state_with_order_two():
    system, errors = block_on_belt(friction=0.4, load=50.0, mass=2.0, spring=1e5), []
    start = static_start(system)
    for step in (2e-4, 1e-4):
        time, moved, _ = integrate(system, start, step, round(0.05 / step))
        errors.append(np.abs(moved[:, 0] - 20.0 / 1e5 * (1 - np.cos(np.sqrt(1e5 / 2.0) * time))).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)


def test_the_same_run_gives_the_same_bits():
    system = random_assembly()
    start = static_start(system)
    first, second = (integrate(system, start, 1e-5, 50) for _ in range(2))
    np.testing.assert_array_equal(first[1], second[1])


def test_a_step_that_does_not_converge_is_refused_with_its_time():
    system = random_assembly()
    with pytest.raises(ConvergenceError, match=r"exudyn at t = \de-05 s.*residual"):
        integrate(system, static_start(system), 1e-5, 10, scale=1e-30)


@pytest.mark.exact
def test_four_jointed_sub_discs_as_bodies_are_the_same_model():
    """Rigid bodies with fixed joints, the first one driven; contact from the angles that the bodies really have."""
    system, step, steps = random_assembly(), 2e-5, 200
    start = static_start(system)
    time, moved, _ = newmark.integrate(system, start, step, steps)
    jointed, angles, torque = jointed_sub_discs(system, start, step, steps)
    np.testing.assert_allclose(angles, system.contact.disc_speed * time[-1], rtol=1e-8)
    assert np.abs(jointed - moved[-1]).max() < 1e-6 * np.abs(moved).max()
    assert (torque < 0).all()


def jointed_sub_discs(system, start, step, steps):
    """(displacement of the pads, angles of the four bodies) after ``steps`` steps of an exudyn model of five bodies."""
    import exudyn
    from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

    multibody, n = exudyn.SystemContainer().AddSystem(), len(start)
    nodes, torque = add_sub_discs(multibody, system.contact.disc_speed)

    def turned():
        return np.array([multibody.GetNodeOutput(node, exudyn.OutputVariableType.Rotation)[2] for node in nodes])

    def force(multibody, time, item, displacement, velocity):
        q, v = np.array(displacement), np.array(velocity)
        contact, torque[:] = plain_contact_force(system.contact, time, q, v, turned())
        return system.load - system.stiffness @ q - system.damping @ v + contact

    pads = multibody.AddNode(NodeGenericODE2(
        referenceCoordinates=np.zeros(n), initialCoordinates=start, initialCoordinates_t=np.zeros(n),
        numberOfODE2Coordinates=n))
    multibody.AddObject(ObjectGenericODE2(nodeNumbers=[pads], massMatrix=system.mass, forceUserFunction=force))
    multibody.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, steps * step
    settings.timeIntegration.newton.absoluteTolerance = 1e-9
    exudyn.config.printToConsole = False
    multibody.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.TrapezoidalIndex2)
    exudyn.config.printToConsole = True
    return np.array(multibody.GetNodeOutput(pads, exudyn.OutputVariableType.Coordinates)), turned(), torque


def add_sub_discs(multibody, speed):
    """(nodes, torque): four rigid discs with fixed joints, the first on a bearing and driven; torque acts on each."""
    import exudyn
    from exudyn.itemInterface import LoadTorqueVector, MarkerBodyRigid, MarkerNodeCoordinate, ObjectConnectorCoordinate
    from exudyn.utilities import InertiaCylinder

    ground, torque = multibody.CreateGround(), np.zeros(4)
    inertia = InertiaCylinder(density=7200, length=0.007, outerRadius=0.15, axis=2)
    bodies = [multibody.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0, 0, speed],
                                        nodeType=exudyn.NodeType.RotationRxyz) for _ in range(4)]
    nodes = [multibody.GetObjectParameter(body, "nodeNumber") for body in bodies]
    bearing = [1, 1, 1, 1, 1, 0]
    multibody.CreateGenericJoint(itemNumbers=[ground, bodies[0]], constrainedAxes=bearing, position=[0, 0, 0])
    for pair in zip(bodies[:-1], bodies[1:], strict=True):
        multibody.CreateGenericJoint(itemNumbers=list(pair), constrainedAxes=[1] * 6, position=[0, 0, 0])
    fixed = multibody.AddNode({"nodeType": "PointGround", "referenceCoordinates": [0, 0, 0]})
    ends = [multibody.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
            for node, coordinate in ((fixed, 0), (nodes[0], 5))]
    multibody.AddObject(ObjectConnectorCoordinate(markerNumbers=ends, offset=speed, velocityLevel=True))
    for number, body in enumerate(bodies):
        def reaction(multibody, time, vector, number=number):
            return [0, 0, torque[number]]

        marker = multibody.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, 0]))
        multibody.AddLoad(LoadTorqueVector(markerNumber=marker, loadVectorUserFunction=reaction))
    return nodes, torque


def plain_contact_force(contact, time, displacement, velocity, turned):
    """(force on the pads, torque on each sub-disc), written again with numpy: each sub-disc at its body's angle."""
    law = FrictionLaw(contact.dry.pressure, contact.dry.speed, contact.dry.distance, contact.dry.table)
    closure = -(contact.rows[0] @ displacement + contact.law.gap)
    closing = 1 - contact.rows[0] @ velocity / contact.law.damping_speed
    pressure = np.interp(closure, contact.law.closure, contact.law.pressure) * closing
    slip = np.array([contact.disc_speed * contact.radius - contact.rows[1] @ velocity, -contact.rows[2] @ velocity])
    acting = 0.5 * (1 - np.cos(np.pi * min(time / contact.ramp, 1)))
    force, torque = pressure * contact.law.area @ contact.rows[0], np.zeros(4)
    for sub_disc in range(4):
        share = overlap(contact, sub_disc, turned[sub_disc])
        friction, _ = law.evaluate(pressure, np.hypot(*slip), contact.bedding[sub_disc] + contact.bedding_speed * time)
        along, aside = acting * friction * share * pressure * contact.law.area * slip / np.hypot(*slip)
        force = force + along @ contact.rows[1] + aside @ contact.rows[2]
        torque[sub_disc] = -along @ contact.radius
    return force, torque


def overlap(contact, sub_disc, turned):
    """Share of each patch on the sectors of one sub-disc, sector by sector."""
    width = 2 * np.pi / contact.sectors
    low, high = contact.angle - contact.half_angle - turned, contact.angle + contact.half_angle - turned
    begins = width * (sub_disc + 4 * np.arange(-contact.sectors, contact.sectors))[:, None]
    inside = np.minimum(high, begins + width) - np.maximum(low, begins)
    return np.maximum(inside, 0).sum(axis=0) / (2 * contact.half_angle)

"""Motion step by step: continued as in one run, small motions as linearised ones, errors in words."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.exports.contact_motion import ContactMotion
from pipeline.exports.fmu import unit_of
from pipeline.exports.run_products import sliding_products
from pipeline.physics.time_stepping.simulate import simulate


def test_without_force_a_brake_slides_steadily(brake):
    motion, modes = ContactMotion.of(brake, 1, 1e-6), sliding_products(brake)[0]
    force = modes.operating_force[1].sum()
    assert motion.outputs[-2] == pytest.approx(force) and motion.outputs[-1] == pytest.approx(0.5 * force)
    motion.step(np.zeros(3), 1e-5)
    assert motion.outputs[-2] == pytest.approx(force, rel=1e-6)
    assert abs(motion.outputs[0]) < 1e-7 * abs(motion.origin[0])


def test_steps_go_on_as_one_run_of_the_integrator(brake):
    """Of unlike lengths, with lifting contacts: as ``simulate`` over all of them, to the rounding."""
    motion, force = ContactMotion.of(brake, 1, 1e-6), np.array([-0.9e6, 0.0, 500.0])
    bench, start = motion.bench, motion.state
    for length in (1e-4, 5e-5, 2.5e-4):
        motion.step(force, length)
    whole = simulate(bench.model, bench.law, bench.friction, step=1e-6, duration=4e-4, inputs=motion.steady + force,
                     start=start, book=False)
    assert {0, 2} <= set(whole.status.ravel())
    np.testing.assert_allclose(motion.outputs[:2], [whole.displacement[0, -1] - motion.origin[0],
                                                    whole.velocity[0, -1]], rtol=1e-8)


@pytest.mark.exact
def test_small_motions_are_those_of_the_linearised_unit(brake):
    """To what the curvature of the contact law leaves: ten times less of a tenth of the force, in N."""
    form, errors = unit_of(brake, 1).form, []
    for size in (100.0, 10.0, 1.0):
        motion, force = ContactMotion.of(brake, 1, 2e-7), np.array([0.0, 0.0, size])
        motion.step(force, 4e-4)
        linear = [each[0] for each in form.motion(form.step(np.zeros(len(form.root), complex), force, 4e-4), force)]
        errors.append(abs(motion.outputs[1] - linear[1]) / abs(linear[1]))
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.05) and errors[2] < 5e-5


def test_a_step_too_long_for_the_contacts_says_so(brake):
    motion = ContactMotion.of(brake, 1, 1e-3)
    with pytest.raises(ConfigError, match="step"):
        motion.step(np.zeros(3), 1e-3)

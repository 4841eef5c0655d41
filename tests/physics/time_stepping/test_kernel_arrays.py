"""What one step makes of a contact force, in closed form for a free mass, and steps that are too long."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant, kernel
from pipeline.physics.friction.state_variables import state_kernel
from pipeline.physics.time_stepping.kernel_arrays import STEPS_PER_PERIOD, elements_kernel, linear_kernel, refuse
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.normal_laws import Hard, Penalty, normal_kernel
from tests.physics.lumps import ball, lumps

pytestmark = pytest.mark.exact
STEP, MASS = 1e-3, 4.0


@pytest.mark.parametrize("law, share", [(Hard(), 1 / 2), (Penalty(1.0), 1 / 6)])
def test_a_force_at_the_end_of_a_step_moves_a_free_mass(law, share):
    """Displacement dt^2 / (2 m) and velocity dt / m of a constant force; dt^2 / (6 m), dt / (2 m) of one that rises."""
    model = ball(MASS)
    found = linear_kernel(model, modal_system(model), law, kernel(constant(0.0), 1), STEP)
    moved, speed = found.response[0, 0, 0, 0], found.response[1, 0, 0, 0]
    assert moved == pytest.approx(share * STEP**2 / MASS)
    assert speed == pytest.approx(STEP / MASS * (1.0 if isinstance(law, Hard) else 0.5))


def test_a_model_without_elements_has_an_empty_kernel():
    model = ball(MASS)
    system = modal_system(model)
    found = elements_kernel(model, system, linear_kernel(model, system, Hard(), kernel(constant(0.0), 1), STEP))
    assert len(found.kind) == 0 and found.to_contacts.shape[-1] == 0


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_the_longest_step_is_a_share_of_the_shortest_period(share):
    model = lumps([1.0], [[1.0]], [(2 * np.pi * 50.0) ** 2])
    step, system = share / 50.0 / STEPS_PER_PERIOD, modal_system(model)
    dry, states = kernel(constant(0.0), 0), state_kernel(constant(0.0), np.empty(0))
    parts = (system, linear_kernel(model, system, Hard(), dry, step), normal_kernel(Hard(), model.contacts), dry,
             states, model, step)
    if share < 1:
        refuse(*parts)
    else:
        with pytest.raises(ConfigError, match=r"time stepping: step: expected at most 0.008 s"):
            refuse(*parts)

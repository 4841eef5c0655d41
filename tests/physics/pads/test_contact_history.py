"""Forces along a motion, sums over patches, counters."""

import numpy as np
import pytest

from pipeline.physics.pads.contact_history import contact_history
from pipeline.physics.pads.newmark import integrate
from pipeline.physics.pads.patch_contact import contact_state
from pipeline.physics.pads.sliding_pads import static_start
from tests.physics.small_pads import random_assembly

PAD = np.repeat([0, 1], 4)


def moved(system):
    return integrate(system, static_start(system), 1e-5, 100, record_every=5)


@pytest.mark.exact
def test_history_repeats_the_state_and_sub_discs_share_the_force():
    system = random_assembly()
    time, q, v = moved(system)
    history = contact_history(system.contact, PAD, 2, time, q, v)
    state = contact_state(system.contact, time[7], q[7], v[7])
    np.testing.assert_array_equal(history.normal[:, 7], state.normal)
    np.testing.assert_array_equal(history.friction[:, 7], state.friction[:, 0])
    np.testing.assert_allclose(history.patch.sum(axis=1), history.normal.reshape(2, 4, -1).sum(axis=1))
    assert history.separated == history.outside == 0


@pytest.mark.exact
def test_powers_are_forces_times_speeds():
    """Friction does work on the pads and on the slip: together that of the disc."""
    system = random_assembly()
    contact, (time, q, v) = system.contact, moved(system)
    power = contact_history(contact, PAD, 2, time, q, v).power[:, 9]
    state, speed = contact_state(contact, time[9], q[9], v[9]), contact.rows @ v[9]
    disc = state.friction[:, 0] @ (contact.disc_speed * contact.radius)
    on_pads = (state.friction.T * speed[1:]).sum()
    np.testing.assert_allclose(power, [state.normal @ speed[0], on_pads, disc - on_pads], rtol=1e-12)


@pytest.mark.exact
def test_samples_outside_the_map_and_without_contact_are_counted():
    system = random_assembly()
    time, q, v = moved(system)
    late = system.contact._replace(bedding=np.array([1e-3, 1.0, 1e-3, 1.0]), half_angle=np.full(8, np.pi / 4))
    assert contact_history(late, PAD, 2, time, q, v).outside == 0.5
    law = system.contact.law
    opened = system.contact._replace(law=law._replace(gap=np.where(np.arange(8) < 2, 1.0, law.gap)))
    assert contact_history(opened, PAD, 2, time, q, v).separated == 0.25

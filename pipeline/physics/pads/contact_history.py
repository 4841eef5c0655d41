"""Contact forces along a computed motion, point by point and sub-disc by sub-disc."""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.dry_friction import characteristic
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.memory import accept_contact, begun_contact
from pipeline.physics.pads.patch_contact import SUB_DISCS, contact_state


class ContactHistory(NamedTuple):
    """Forces on the pads at m instants, c contacts, p pads."""

    normal: np.ndarray      # (c, m) N
    friction: np.ndarray    # (c, m) N, along sliding
    power: np.ndarray       # (3, m) W, of normal forces on the pads, of friction on the pads, of friction on the slip
    patch: np.ndarray       # (p, 4, m) N, normal force of each sub-disc on each pad
    separated: float        # share of the samples without contact
    outside: float          # share of the friction evaluations outside the friction table


def contact_history(contact, pad, pads, time, displacement, velocity):
    """ContactHistory of the motion ``displacement``, ``velocity`` (m, n) at ``time`` (m,).

    ``pad`` (c,) is the number of the pad of each contact, out of ``pads``. Contacts that remember need every step.
    """
    step = float(time[1] - time[0]) if len(time) > 1 else 0.0
    return _history(*begun_contact(contact, displacement[0], step), pad, pads, time, displacement, velocity, step)


@njit
def _history(contact, memory, pad, pads, time, displacement, velocity, step):
    size, samples = pad.size, time.size
    normal, friction = np.empty((size, samples)), np.empty((size, samples))
    power = np.zeros((3, samples))
    patch, separated, outside, evaluations = np.zeros((pads, SUB_DISCS, samples)), 0, 0, 0
    recalls = contact.states.kind.size > 0 or contact.wear.any()
    for k in range(samples):
        if k > 0 and recalls:
            state = accept_contact(contact, memory, time[k], displacement[k], velocity[k], step)
        else:
            state = contact_state(contact, time[k], displacement[k], velocity[k])
        opening, along, aside = (contact.rows[0] @ velocity[k], contact.rows[1] @ velocity[k],
                                 contact.rows[2] @ velocity[k])
        for i in range(size):
            normal[i, k], friction[i, k] = state.normal[i], state.friction[i, 0]
            if state.normal[i] == 0.0:
                separated += 1
                continue
            slip_x, (drawn, swept) = contact.disc_speed * contact.radius[i] - along[i], state.friction[i]
            slip = np.hypot(slip_x, aside[i])
            power[0, k] += state.normal[i] * opening[i]
            power[1, k] += drawn * along[i] + swept * aside[i]
            power[2, k] += drawn * slip_x - swept * aside[i]
            for d in range(SUB_DISCS):
                patch[pad[i], d, k] += state.share[i, d] * state.normal[i]
                if state.share[i, d] > 0.0:
                    evaluations += 1
                    outside += characteristic(contact.dry, i, state.normal[i] / contact.law.area[i], slip,
                                              contact.bedding[d] + contact.bedding_speed * time[k], 1.0)[3]
    return ContactHistory(normal, friction, power, patch, separated / (size * samples), outside / max(evaluations, 1))

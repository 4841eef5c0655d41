"""Growth rate of small motions of the pads about steady sliding on the rigid disc, over the stiffness of the joints."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots, upper_half
from pipeline.physics.pads.patch_contact import SUB_DISCS
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import linearised, sliding_state, static_start
from pipeline.physics.time_stepping.element_forces import WAVE

#: parameter of a wave that says how large it is
AMPLITUDE = 2


def sliding_roots(system, highest_frequency=np.inf, correction_damping=0.3):
    """Roots s (1/s) of the linearised system about steady sliding, one of each conjugate pair.

    Friction and its slopes over pressure and slip are those of the law at the sliding state, averaged over the
    four sub-discs. ``highest_frequency`` (Hz) bounds the preloaded modes in which the roots are sought,
    beside static answers with the damping ratio ``correction_damping``.
    """
    averaged = on_average(system)
    start = static_start(averaged, "stability map: static start")
    modal, _ = preloaded_modes(averaged, start, highest_frequency, correction_damping)
    state = sliding_state(modal, "stability map: steady sliding")
    stiffness, damping = linearised(modal, state)
    roots = quadratic_roots(modal.mass, damping, stiffness)
    return roots[upper_half(roots)]


def on_average(system):
    """The same system where every patch spans one round of the four sub-discs: all have equal shares at all times.

    What turns with the disc or shakes the pads drops out.
    """
    contact, elements = system.contact, system.elements
    whole_round = np.full_like(contact.half_angle, SUB_DISCS * np.pi / contact.sectors)
    parameter = elements.law.parameter.copy()
    parameter[elements.law.kind == WAVE, AMPLITUDE] = 0.0
    return system._replace(
        contact=contact._replace(half_angle=whole_round, waviness=contact.waviness[:0], scatter=contact.scatter[:0]),
        elements=elements._replace(law=elements.law._replace(parameter=parameter)))


def stability_map(build, caliper_factors, abutment_factors, highest_frequency=np.inf, correction_damping=0.3):
    """(largest growth rate in 1/s, frequency of its root in Hz), both (caliper, abutment).

    ``build(caliper factor, abutment factor)`` is the PadSystem. Roots beyond ``highest_frequency`` (Hz) belong to the
    static answers, whose frequencies mean nothing, and do not count. Raises ConfigError where no root is left.
    """
    fastest = np.array([[_fastest(sliding_roots(build(caliper, abutment), highest_frequency, correction_damping),
                                  highest_frequency) for abutment in abutment_factors] for caliper in caliper_factors])
    return fastest.real, fastest.imag / (2 * np.pi)


def _fastest(roots, highest_frequency):
    meant = roots[np.abs(roots) < 2 * np.pi * highest_frequency]
    if not meant.size:
        raise ConfigError("stability map: highest frequency", f"above {np.abs(roots).min() / (2 * np.pi):.4g} Hz,"
                          " the lowest root", f"{highest_frequency:g} Hz")
    return meant[np.argmax(meant.real)]

"""Newmark's rule for one time step (ASCE J. Eng. Mech. Div. 85 (1959) 67), with beta = (gamma + 1/2)^2 / 4.

    q1 = q0 + h v0 + h^2 ((1/2 - beta) a0 + beta a1),   v1 = v0 + h ((1 - gamma) a0 + gamma a1);

gamma = 1/2 is the trapezoidal (average-acceleration) rule, second order and without numerical damping; a larger gamma
damps the highest modes.
"""

from pipeline.physics.numerics.compiled import njit


def beta_of(gamma):
    """beta that makes the highest modes decay fastest without a spurious root."""
    return (gamma + 0.5) ** 2 / 4


def predicted(displacement, velocity, acceleration, step, gamma=0.5):
    """(displacement, velocity) at the end of a ``step`` in s without the acceleration there; scalars or arrays."""
    ahead = displacement + step * velocity + step**2 * (0.5 - (gamma + 0.5) ** 2 / 4) * acceleration
    return ahead, velocity + step * (1 - gamma) * acceleration


def corrected(displacement, velocity, acceleration, step, gamma=0.5):
    """The ``predicted`` displacement and velocity with the acceleration at the end of the step."""
    return (displacement + step**2 * ((gamma + 0.5) ** 2 / 4) * acceleration,
            velocity + step * gamma * acceleration)


#: the same for scalars in compiled code
predict, correct = njit(predicted), njit(corrected)

"""Stick-slip cycle of an undamped mass on a belt under Coulomb friction, in closed form.

Mass m on a spring k, belt speed v, normal force N, friction static_friction N at rest and friction N in sliding. With
w = sqrt(k / m) the mass breaks loose A = (static_friction - friction) N / k beyond the place about which it slides, and
moves on a circle of radius R = sqrt(A^2 + (v / w)^2) until it has the speed of the belt again, at -A; then it is
carried back over 2 A (Den Hartog, Mechanical Vibrations; the cycle exists once sticking is reached).
"""

import numpy as np


def overshoot(stiffness, normal_force, static_friction, friction):
    """A in m."""
    return (static_friction - friction) * normal_force / stiffness


def amplitude(mass, stiffness, normal_force, static_friction, friction, speed):
    """R in m: half of the way from one turning point to the other."""
    return np.hypot(overshoot(stiffness, normal_force, static_friction, friction), speed * np.sqrt(mass / stiffness))


def backward_speed(mass, stiffness, *friction_and_speed):
    """w R in m/s: largest speed against the belt; further arguments as of ``amplitude``."""
    return np.sqrt(stiffness / mass) * amplitude(mass, stiffness, *friction_and_speed)


def stick_time(stiffness, normal_force, static_friction, friction, speed):
    """2 A / v in s."""
    return 2 * overshoot(stiffness, normal_force, static_friction, friction) / speed


def period(mass, stiffness, normal_force, static_friction, friction, speed):
    """(pi + 2 arctan(v / (w A))) / w + 2 A / v in s."""
    angular = np.sqrt(stiffness / mass)
    beyond = overshoot(stiffness, normal_force, static_friction, friction)
    return ((np.pi + 2 * np.arctan2(speed / angular, beyond)) / angular
            + stick_time(stiffness, normal_force, static_friction, friction, speed))

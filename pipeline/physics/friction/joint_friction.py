"""Friction laws of one joint with states, compiled: forces over one step from what they remember at its begin.

    presliding  F = F_c (y + tau y') + c v,   y' = (v - |v| y / g(v)) / L,   g = 1 + r exp(-(v / v_s)^2)
    rate_state  F = F_0 a arcsinh(v / (2 v_0) exp((1 + b psi) / a)),         psi = ln(v_0 theta / D_c)
                ageing  theta' = 1 - |v| theta / D_c,    slip  theta' = -(|v| theta / D_c) ln(|v| theta / D_c)
    positional  F = F_c max(0, 1 + g e) v / hypot(v, creep)

Presliding is Dahl's law for r = tau = c = 0 and LuGre's otherwise (Canudas de Wit et al., IEEE Trans. Autom. Control 40
(1995) 419). Rate-and-state friction is regularised (Rice, Lapusta & Ranjith, J. Mech. Phys. Solids 49 (2001) 1865); far
from rest it is F_0 (1 + a ln(v / v_0) + b ln(v_0 theta / D_c)). States are exact for a constant speed over the step.
"""

import numpy as np

from pipeline.physics.numerics.compiled import borrowing

#: reference speed v_0 of rate-and-state friction, m/s
REFERENCE_SPEED = 1e-6
#: argument beyond which arcsinh(exp(x)) is x + ln 2 to the last bit
_LARGE = 20.0


@borrowing
def presliding(moved, rate, remembered, memory, p):
    """F in N after ``moved`` m, at ``rate`` m/s; ``memory`` (2,) gets y and the rate.

    ``p``: F_c N, L m, r, v_s m/s, tau s, c N s/m.
    """
    length, slowest = p[1], p[3]
    mean, last = (0.5 * (remembered[1] + rate) / slowest) ** 2, (rate / slowest) ** 2
    slides = (1.0 + p[2] * np.exp(-mean)) * np.sign(moved)
    memory[0], memory[1] = remembered[0], rate
    if moved != 0.0:
        memory[0] = slides + (remembered[0] - slides) * np.exp(-moved / (slides * length))
    change = (rate - abs(rate) * memory[0] / (1.0 + p[2] * np.exp(-last))) / length
    return p[0] * (memory[0] + p[4] * change) + p[5] * rate


@borrowing
def settled(speed):
    """psi in steady sliding at ``speed`` m/s, of either sign, at least the reference speed."""
    return -np.log(max(abs(speed), REFERENCE_SPEED) / REFERENCE_SPEED)


@borrowing
def rate_state(rate, time, remembered, memory, p):
    """F in N at ``rate`` m/s and ``time`` s; ``memory`` (3,) gets psi, the time and the speed; speed 0: not yet begun.

    ``p``: F_0 N, a, b, D_c m, 1 for the slip law and 0 for ageing. A motion begins settled at its first speed.
    """
    speed, passed = max(abs(rate), 1e-300), time - remembered[1]
    if remembered[2] == 0.0:
        memory[0] = settled(speed)
    else:
        memory[0] = _aged(remembered[0], 0.5 * (remembered[2] + speed), passed, p[3], p[4])
    memory[1], memory[2] = time, speed
    if rate == 0.0 or p[0] == 0.0:
        return 0.0
    exponent = np.log(speed / (2 * REFERENCE_SPEED)) + (1.0 + p[2] * memory[0]) / p[1]
    value = exponent + np.log(2.0) if exponent > _LARGE else np.arcsinh(np.exp(exponent))
    return p[0] * p[1] * value * np.sign(rate)


@borrowing
def _aged(psi, speed, passed, length, slip_law):
    """psi after ``passed`` s at a constant ``speed`` m/s."""
    way = speed * passed / length
    if slip_law > 0.0:
        steady = -np.log(speed / REFERENCE_SPEED)
        return steady + (psi - steady) * np.exp(-way)
    # theta' = 1 - |v| theta / L: what has been is forgotten with the way, the contact ages with the time
    share = -np.expm1(-way) / way if way > 0.0 else 1.0
    return np.log(np.exp(psi - way) + REFERENCE_SPEED * passed / length * share)


@borrowing
def positional(elongation, rate, p):
    """F in N; ``p``: F_c N, gradient g 1/m, creep m/s."""
    if rate == 0.0:
        return 0.0
    return p[0] * max(0.0, 1.0 + p[1] * elongation) * rate / np.hypot(rate, p[2])

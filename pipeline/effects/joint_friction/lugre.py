"""LuGre friction in a joint: bristles that bend, break away and slide with less force as the speed rises.

    F = F_c (y + tau y') + c v,    y' = (v - |v| y / g(v)) / L,    g(v) = 1 + r exp(-(v / v_s)^2)

The damping of the bristles is that which is critical with the mass felt along the joint, tau = sqrt(m L / F_c), as the
authors take it.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.effects.resolved import felt_mass, resolved_stiffness
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Power, Presliding


def parameters(typical):
    way, drag = 0.05 * typical.length, 0.1 * typical.force / typical.speed
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("rise", "1", 0.4, LogNormal(0.4, 0.7)),
            Parameter("speed", "m/s", 0.1 * typical.speed, LogNormal(0.1 * typical.speed, 1.0)),
            Parameter("length", "m", way, LogNormal(way, 1.0)),
            Parameter("damping", "N s/m", drag, HalfNormal(2 * drag), null=0.0))


def apply(bench, location, values):
    force, damping, row = values["force"], values["damping"], bench.joint(location)[0]
    if force == 0:
        return bench if damping == 0 else beside_joint(bench, "lugre", location, Power(damping, 1.0))
    length = max(values["length"], force / resolved_stiffness(bench, row))
    time = np.sqrt(felt_mass(bench, row) * length / force)
    return beside_joint(bench, "lugre", location,
                        Presliding(force, length, values["rise"], values["speed"], time, damping))


EFFECT = Effect(
    name="lugre", summary="friction of bristles that break away and slide with less force", location="joint",
    stage="friction", parameters=parameters, apply=apply, small=False, elaborate=True,
    extends=("dahl", "coulomb"),
    family="dry friction",
    source="C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419",
    valid="Valid while the normal force in the joint stays the same; bristles that the step does not resolve are taken"
          " as the stiffest that it does.")

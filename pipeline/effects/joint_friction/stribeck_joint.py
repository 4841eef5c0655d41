"""Stribeck friction in a joint: dry friction that falls as a film builds up, and drag of the film.

    F = F_c (1 + r exp(-|v| / v_s)) sgn(v) + c v
"""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Dry, Element, Power


def parameters(typical):
    drag = 0.1 * typical.force / typical.speed
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("rise", "1", 0.4, LogNormal(0.4, 0.7)),
            Parameter("speed", "m/s", 0.1 * typical.speed, LogNormal(0.1 * typical.speed, 1.0)),
            Parameter("damping", "N s/m", drag, HalfNormal(2 * drag), null=0.0))


def apply(bench, location, values):
    row, force = bench.joint(location)[0], values["force"]
    dry = Dry(forward=force, backward=force, rise=values["rise"], decay_speed=values["speed"])
    return bench.with_elements(Element(f"stribeck_joint {location}", row, dry),
                               Element(f"stribeck_joint film {location}", row, Power(values["damping"], 1.0)))


EFFECT = Effect(
    name="stribeck_joint", summary="dry friction that falls with speed, and drag of a film", location="joint",
    stage="friction", parameters=parameters, apply=apply, linear=("damping",), elaborate=True,
    extends=("coulomb", "joint_damping"),
    family="dry friction",
    source="R. Stribeck, Z. VDI 46 (1902) 1341; B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30"
           " (1994) 1083: exponential drop",
    valid="Valid while the normal force in the joint stays the same and the film follows the speed at once.")

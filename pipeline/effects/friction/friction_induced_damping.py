"""Friction-induced damping: friction turns in its plane when the contact moves sideways.

    F = -s (mu N / |slip|) l q'

along the lateral row l, a damper that grows with load and falls with sliding speed; s = 1 is Coulomb friction along the
slip, s = 0 friction that keeps the direction of the drive.
"""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Turning


def parameters(typical):
    return (Parameter("share", "1", 1.0, Uniform(0.0, 1.5), null=0.0),)


def apply(bench, location, values):
    lateral = bench.model.contacts.lateral
    return bench.with_elements(*(Element(f"friction_induced_damping {i}", lateral[i], Turning(int(i), values["share"]))
                                 for i in bench.contacts(location) if lateral[i].any()))


EFFECT = Effect(
    name="friction_induced_damping", summary="friction that turns against sideways motion", location="sideways contact",
    stage="friction", parameters=parameters, apply=apply, linear=("share",),
    source="J. Kang, C. M. Krousgrill, F. Sadeghi, J. Sound Vib. 316 (2008) 164; equation (3) of the sliding model",
    valid="Valid while sideways motion is slow against sliding; simulation, roots and equation see it.")

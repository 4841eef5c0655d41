"""A contact stiffness in series with a joint that has dry friction: 1 / k_c = s in series with (k beside F_c).

    sticking  F = k_c de,    sliding  F = (k e + F_c sgn(v)) / (1 + k s)

which is k / (1 + k s) beside a Jenkins element of stiffness k_c - k / (1 + k s) and limit F_c / (1 + k s). The damper
of the joint goes on in parallel. A contact stiffer than the step of the bench resolves is as stiff as it does.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.effects.resolved import resolved_stiffness
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.time_stepping.elements import Sliders


def parameters(typical):
    give = 0.1 / typical.holding
    return (Parameter("compliance", "m/N", give, HalfNormal(2 * give), null=0.0),
            Parameter("friction", "N", 0.1 * typical.force, HalfNormal(0.15 * typical.force), null=0.0))


def apply(bench, location, values):
    row, stiffness, _ = bench.joint(location)
    if values["compliance"] == 0 and values["friction"] == 0:
        return bench
    series = 1 + stiffness * values["compliance"]
    softer = stiffness / series
    stiffest = resolved_stiffness(bench, row) + softer
    contact = min(1 / values["compliance"], stiffest) if values["compliance"] > 0 else stiffest
    law = Sliders(np.array([contact - softer]), np.array([values["friction"] / series]), softer - stiffness)
    return beside_joint(bench, "series_stiffness", location, law)


EFFECT = Effect(
    name="series_stiffness", summary="a joint with dry friction behind a contact stiffness", location="joint",
    stage="structure", parameters=parameters, apply=apply, elaborate=True,
    extends=("coulomb",),
    family="dry friction",
    source="E. J. Berger, Appl. Mech. Rev. 55 (2002) 535: friction in series with contact compliance",
    valid="Valid while the mass between contact and joint is negligible.")

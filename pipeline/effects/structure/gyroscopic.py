"""Rotation of a body: its two modes of one frequency are coupled by the Coriolis force 2 n W sqrt(m_1 m_2).

    m_1 q_1'' + 2 n W m q_2' + k_1 q_1 = 0,    m_2 q_2'' - 2 n W m q_1' + k_2 q_2 = 0

Seen from where the body turns, two equal modes w become sqrt(w^2 + n^2 W^2) -+ n W: waves that run against and with
the rotation. n is the number of nodal diameters of a disc in flexure, its sign the order of the two modes; a rigid thin
disc that tilts has n = 1.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter


def parameters(typical):
    return (Parameter("order", "1", 2.0, Normal(0.0, 3.0), null=0.0),)


def apply(bench, location, values):
    mass, _, pair = bench.doublet(location)
    coupling = 2 * values["order"] * np.sqrt(mass.prod())
    changed = bench.model.gyroscopic.copy()
    changed[np.ix_(pair, pair)] += coupling * np.array([[0.0, 1.0], [-1.0, 0.0]])
    return replace(bench, model=replace(bench.model, gyroscopic=changed))


EFFECT = Effect(
    name="gyroscopic", summary="a rotation that couples two modes by Coriolis forces", location="doublet",
    stage="structure", parameters=parameters, apply=apply, linear=("order",),
    source="H. Lamb, R. V. Southwell, Proc. R. Soc. Lond. A 99 (1921) 272: vibrations of a spinning disk",
    valid="Valid while n W is small against the frequency (squares of the speed are left out), at the speed with which"
          " a run begins.")

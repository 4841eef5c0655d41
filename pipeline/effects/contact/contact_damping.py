"""Damping of the normal contact: N = k c (1 + s c'), s in s/m, which vanishes with the closure c.

A table takes s into its damping speed v_0 (1 / v_0 grows by s); a penalty contact gets a damper k c_0 s at its typical
closure c_0 = length.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.simulate import Penalty, Table


def parameters(typical):
    size = 0.5 * typical.force / max(typical.stiffness * typical.length, typical.force) / typical.speed
    return (Parameter("loss", "s/m", size, HalfNormal(2 * size), null=0.0),
            Parameter("length", "m", typical.length, LogNormal(typical.length, 0.1)))


def apply(bench, location, values):
    return bench.with_law(location, lambda law: _damped(law, values["loss"], values["length"]))


def _damped(law, loss, length):
    if isinstance(law, Table):
        speed = law.damping_speed
        together = speed / (1 + loss * speed) if np.isfinite(speed) else (1 / loss if loss > 0 else np.inf)
        return replace(law, damping_speed=together)
    if not isinstance(law, Penalty):
        raise ConfigError("effect contact_damping", "contacts that yield", type(law).__name__)
    return replace(law, damping=np.asarray(law.damping, float) + np.asarray(law.stiffness, float) * length * loss)


EFFECT = Effect(
    name="contact_damping", summary="damping of contacts along their normals", location="pressed contact",
    stage="contact", parameters=parameters, apply=apply, linear=("loss",),
    family="damping",
    source="K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440",
    valid="Valid while contacts do not stick to each other: the force never pulls.")

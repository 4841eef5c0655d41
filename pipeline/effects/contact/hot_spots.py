"""Hot spots: waves of the surface that grow as it warms up and follow the angle of the drive.

    gap_i + a (1 - exp(-t / tau)) cos(n (theta - theta_i) - phase)

n is the number of spots around the disc, a the height that they reach.
"""

import numpy as np

from pipeline.effects.contact.contact_surface import with_wave
from pipeline.effects.effect import Effect
from pipeline.effects.warming import warming_time
from pipeline.inference.priors import HalfNormal, Parameter, Uniform


def parameters(typical):
    size = 0.1 * typical.length
    return (Parameter("amplitude", "m", size, HalfNormal(2 * size), null=0.0),
            Parameter("order", "1", 6.0, Uniform(2.5, 20.5)), Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)),
            warming_time(typical))


def apply(bench, location, values):
    return with_wave(bench, location, values["amplitude"], values["order"], values["phase"], values["time"])


EFFECT = Effect(
    name="hot_spots", summary="a surface whose waves grow as it warms up", location="pressed contact",
    stage="excitation", parameters=parameters, apply=apply, small=False,
    source="J. R. Barber, Proc. R. Soc. Lond. A 312 (1969) 381; K. Lee, J. R. Barber, J. Tribol. 115 (1993) 607",
    valid="Valid below the critical speed, where spots do not grow by themselves; heating steady, every run starts"
          " cold.")

"""Thermal coning: the disc tilts into a cone as it warms up, which opens or closes the gaps of a group.

    gap_i + d (r_i / r) (1 - exp(-t / tau))

r_i is the radius of contact i, r the mean of the group.
"""

import numpy as np

from pipeline.effects.contact.contact_surface import with_wave
from pipeline.effects.effect import Effect
from pipeline.effects.warming import warming_time
from pipeline.inference.priors import Normal, Parameter


def parameters(typical):
    size = 0.3 * typical.length
    return (Parameter("shift", "m", size, Normal(0.0, size), null=0.0),
            warming_time(typical))


def apply(bench, location, values):
    radius = np.abs(bench.model.contacts.lever[bench.contacts(location)])
    return with_wave(bench, location, values["shift"] * radius / (radius.mean() or 1.0), 0.0, 0.0, values["time"])


EFFECT = Effect(
    name="thermal_coning", summary="contacts that open or close as the disc warms up", location="pressed contact",
    stage="excitation", parameters=parameters, apply=apply, small=False, extends=("clearance",),
    source="R. Limpert, Brake Design and Safety, 2nd ed. (1999), chapter 3: coning of rotors",
    valid="Valid while heating is steady from the begin of each run, which starts cold; a belt shifts evenly.")

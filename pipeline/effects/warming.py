"""How long what warms up takes: the parameter that effects of temperature share."""

import numpy as np

from pipeline.inference.priors import LogNormal, Parameter

#: shortest time constant over the longest run: what has settled sooner is another value from the begin, which nothing
#: but a first moment tells from it
_SHORTEST = 0.05


def warming_time(typical):
    """Parameter ``time``, the time constant in s of an effect that warms up, on a bench of the ``typical`` sizes."""
    return Parameter("time", "s", 0.5 * typical.time, LogNormal(0.5 * typical.time, 1.0),
                     within=(_SHORTEST * typical.time, np.inf))

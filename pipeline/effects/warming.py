"""How long what warms up takes: the parameter that effects of temperature share."""

from pipeline.inference.priors import LogUniform, Parameter

#: shortest and longest time constant over the longest run: what has settled sooner is another value from the begin,
#: which nothing but a first moment tells from it; what takes longer rises as a straight line
_RANGE = (0.05, 10.0)


def warming_time(typical):
    """Parameter ``time``, the time constant in s of an effect that warms up, on a bench of the ``typical`` sizes."""
    return Parameter("time", "s", 0.5 * typical.time, LogUniform(*(share * typical.time for share in _RANGE)))

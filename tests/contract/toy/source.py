"""First stage of the toy chain."""

import numpy as np

from pipeline.contract import Context, Quantity, Section, option, stage
from tests.contract.toy.products import Inner, Source


class Settings(Section):
    """Length of the signals."""

    duration: Quantity("s", gt=0) = option("4 s", "length of the signals")
    level: Quantity("Pa") = option("1 kPa", "level of the signals")


@stage
def source(settings: Settings, context: Context) -> Source:
    """Make signals.

    Method:
    Signals of {duration} were made.
    """
    time = np.arange(settings.duration)
    return Source(time=time, label=["a", "b"], signal=settings.level * np.ones((2, len(time))), root=[1j, 2 + 3j],
                  flag=[0, 1], scale=2.0, inner=Inner(position=np.zeros((0, 3))))

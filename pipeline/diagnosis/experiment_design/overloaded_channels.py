"""Which recorded channels are overloaded, in words."""

from pipeline.contract.mapped import blocks
from pipeline.physics.signals.overload import overload

#: what channels measure that swing about a middle
_SWINGING = ("sound_pressure", "acceleration", "velocity", "force", "strain")


def overload_told(channel):
    """What to say of a Channel that swings and is held at the end of its range; '' of any other."""
    if str(channel.measures) not in _SWINGING and not channel.heard():
        return ""
    found = overload(lambda: blocks(channel.samples))
    return "" if found is None else (
        f"{100 * found.share:.2g} % of the samples stand at the end of the range, {found.limit:.4g} {channel.unit}:"
        " overloaded, so that levels are lower bounds, and harmonics may come from clipping")

"""How effects are attached to a bench: a law beside a joint, a mass or a spring at a point, a factor of a channel."""

from dataclasses import replace

import numpy as np

from pipeline.physics.time_stepping.elements import Element


def beside_joint(bench, effect, joint, law):
    """The bench with an element of this ``law`` between the ends of ``joint``; ``effect`` names it."""
    return bench.with_elements(Element(f"{effect} {joint}", bench.joint(joint)[0], law))


def at_point(bench, matrix, sensor, value):
    """The bench with ``value`` along the direction of ``sensor`` added to its mass or stiffness ``matrix``."""
    model, row = bench.model, bench.sensor(sensor)
    return replace(bench, model=replace(model, **{matrix: getattr(model, matrix) + value * np.outer(row, row)}))


def scaled_channel(bench, name, factor):
    """The bench whose channel ``name`` shows ``factor`` times what it did."""
    return bench.with_channels(lambda c: replace(c, gain=c.gain * factor) if c.name == name else c)

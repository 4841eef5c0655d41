"""Micro-slip of a sliding contact: friction builds up over a way, dT/ds = k (1 - T / (mu N))^m, m = 1.

The compliance 1 / k adds to what the contact has; at 0 the contact sticks without giving way.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    size = typical.length / typical.force
    return (Parameter("compliance", "m/N", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    added = values["compliance"]
    return bench if added == 0 else bench.with_friction(location, lambda friction: _yielding(friction, added))


def _yielding(friction, added):
    before = 0.0 if friction.description == "rigid" else 1 / np.asarray(friction.stiffness, float)
    description = "evolution" if friction.description == "rigid" else friction.description
    return replace(friction, description=description, stiffness=1 / (before + added))


EFFECT = Effect(
    name="micro_slip", summary="contacts that give way before they slide", location="contacts", stage="friction",
    parameters=parameters, apply=apply, small=False,
    family="dry friction",
    source="M. Allgaier, L. Gaul, W. Keiper, K. Willner, Mode lock-in and friction modelling (1999), section 4",
    valid="Valid while the way before sliding is short against the vibration along the contact.")

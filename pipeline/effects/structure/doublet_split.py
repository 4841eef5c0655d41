"""Mistuning of a disc: two modes of one frequency become two of different frequencies, by a symmetric perturbation.

    dK = [[a k_1, b sqrt(k_1 k_2)], [b sqrt(k_1 k_2), -a k_2]]

For two equal modes w^2 (1 -+ sqrt(a^2 + b^2)): the frequencies part by the share sqrt(a^2 + b^2); atan2(b, a) / 2 is
the angle between the modes that split and those of the model.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Parameter, Uniform

#: a^2 + b^2 stays below 1, the stiffness positive
_LARGEST = 0.2


def parameters(typical):
    return tuple(Parameter(name, "1", 0.02, Uniform(-_LARGEST, _LARGEST), null=0.0) for name in ("along", "across"))


def apply(bench, location, values):
    _, stiffness, pair = bench.doublet(location)
    root, a, b = np.sqrt(stiffness), values["along"], values["across"]
    changed = bench.model.stiffness.copy()
    changed[np.ix_(pair, pair)] += np.outer(root, root) * np.array([[a, b], [b, -a]])
    return replace(bench, model=replace(bench.model, stiffness=changed))


EFFECT = Effect(
    name="doublet_split", summary="a disc that is not quite round: two equal modes part", location="doublet",
    stage="structure", parameters=parameters, apply=apply, linear=("along", "across"),
    source="S. A. Tobias, R. N. Arnold, Proc. IMechE 171 (1957) 669: dynamical imperfection of discs",
    valid="Valid while the imperfection stands still against the contacts, as that of a disc that hardly turns.")

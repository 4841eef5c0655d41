"""Material transfer: a share f of what the pad loses sticks to the disc where the two touch.

    disc  dh = (k_disc - f k_pad) p ds,     pad  dh = k_pad p ds

Where the share exceeds the ratio of both wear coefficients, the disc grows at its spots.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.effects.typical import ASPERITIES
from pipeline.inference.priors import Parameter, Uniform


def parameters(typical):
    return (Parameter("share", "1", 0.3, Uniform(0.0, 1.0), null=0.0),)


def apply(rubbing, location, values):
    wearing = rubbing.wearing
    left = wearing.disc_coefficient - values["share"] * wearing.pad_coefficient
    return replace(rubbing, wearing=replace(wearing, disc_coefficient=left))


EFFECT = Effect(
    name="material_transfer", summary="pad material that sticks to the disc", location=ASPERITIES, stage="contact",
    parameters=parameters, apply=apply,
    source="M. G. Jacko, P. H. S. Tsang, S. K. Rhee, Wear 133 (1989) 23: friction films of brake linings; M. Kerridge,"
           " J. K. Lancaster, Proc. R. Soc. A 236 (1956) 250: transfer as a stage of wear",
    valid="Valid while what sticks is as stiff and as strong as what it covers.")

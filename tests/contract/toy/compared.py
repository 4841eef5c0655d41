"""Last stage of a toy chain: compares the case with variants of it."""

from pipeline.contract import Context, Section, Variants, stage
from tests.contract.toy.products import Compared, Doubled


class Settings(Section):
    """None."""


def _variants(sections):
    return {"louder": {"source.level": f"{3 * sections['source'].level} Pa"}, "stronger": {"doubled.factor": 5.0}}


@stage(variants=_variants)
def compared(given: Doubled, others: Variants[Doubled], settings: Settings, context: Context) -> Compared:
    """Compare.

    Method:
    The case was compared with its variants.
    """
    return Compared(variant=list(others), ratio=[other.signal[0, 0] / given.signal[0, 0] for other in others.values()])

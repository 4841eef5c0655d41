"""Last stage of a toy chain: compares the case with variants of it."""

from pipeline.contract import ConfigError, Context, Section, Variants, option, stage
from tests.contract.toy.products import Compared, Doubled, Source


class Settings(Section):
    """A variant beside the two that are always there."""

    further: dict = option({}, "what a third variant changes")


def _variants(sections):
    further = sections["compared"].further
    return {"louder": {"source.level": f"{3 * sections['source'].level} Pa"}, "stronger": {"doubled.factor": 5.0},
            **({"further": further} if further else {})}


def _check_variants(sections, varied):
    for name, settings in varied.items():
        if settings["source"].duration != sections["source"].duration:
            raise ConfigError(f"compared: {name}", "the duration of the case", "another")


@stage(variants=_variants, check_variants=_check_variants)
def compared(given: Doubled, others: Variants[Doubled], sources: Variants[Source], settings: Settings,
             context: Context) -> Compared:
    """Compare.

    Method:
    The case was compared with its variants.
    """
    assert list(sources) == list(others)
    return Compared(variant=list(others), ratio=[other.signal[0, 0] / given.signal[0, 0] for other in others.values()])

"""Last stage of a toy chain: searches for the level at which the first signal is 8 kPa, a variant after the other."""

from pipeline.contract import Context, Section, Variants, option, stage
from tests.contract.toy.products import Doubled, Sought, Source


class Settings(Section):
    """How many variants."""

    most: int = option(6, "variants at most", ge=1)
    aim: float = option(8000.0, "signal that is sought, in Pa")
    end: str = option("2 kPa", "a level that must be possible")


def _walked(settings, first, signal_of):
    """[(level, signal or None)]: each level by the signals of those before, to the first that is not known."""
    path = [(1000.0, first)]
    while path[-1][1] not in (None, settings.aim) and len(path) <= settings.most:
        level = path[-1][0] * settings.aim / path[-1][1] if len(path) > 1 else 3000.0
        path.append((level, signal_of(f"level.{level:g}", {"source.level": f"{level:g} Pa"})))
    return path


def _further(sections, given, computed):
    def signal_of(name, changes):
        found = computed(name, changes)
        return found and found["others"].signal[0, 0]

    path = _walked(sections["sought"], given["given"].signal[0, 0], signal_of)
    return {f"level.{level:g}": {"source.level": f"{level:g} Pa"} for level, _ in path[1:]}


@stage(variants=lambda sections: {}, further=_further,
       only_checked=lambda sections: {"end": {"source.level": sections["sought"].end}})
def sought(given: Doubled, others: Variants[Doubled], sources: Variants[Source], settings: Settings,
           context: Context) -> Sought:
    """Search.

    Method:
    Levels were tried until the signal was {aim}.
    """
    assert list(sources) == list(others)
    path = _walked(settings, given.signal[0, 0], lambda name, _: others[name].signal[0, 0])
    return Sought(level=[level for level, _ in path])

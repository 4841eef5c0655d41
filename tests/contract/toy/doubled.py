"""Second stage of the toy chain: fans out over the channels."""

from functools import partial

from pipeline.contract import Context, Section, option, stage
from tests.contract.toy.products import Doubled, Source


class Settings(Section):
    """By how much."""

    factor: float = option(2.0, "factor on the signals")


def _times(factor, signal):
    return factor * signal


def _companions(product, case):
    return {"doubled.csv": "\n".join(",".join(map(str, row)) for row in product.signal)}


@stage(companions=_companions, alone=True)
def doubled(given: Source, settings: Settings, context: Context) -> Doubled:
    """Multiply the signals.

    Method:
    Signals were multiplied by {factor}.
    """
    context.log(f"{len(given.signal)} channels")
    return Doubled(signal=context.map(partial(_times, settings.factor), given.signal, "channels"))

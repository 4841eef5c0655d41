"""A stage of the toy chain beside ``doubled``: both read the same."""

from pipeline.contract import Context, ConvergenceError, Section, option, stage
from tests.contract.toy.products import Mean, Source


class Settings(Section):
    """What may go wrong."""

    fails: bool = option(False, "find no answer")


@stage
def mean(given: Source, settings: Settings, context: Context) -> Mean:
    """Average the signals.

    Method:
    Signals were averaged.
    """
    if settings.fails:
        raise ConvergenceError("mean", "an answer", "none")
    return Mean(level=given.signal.mean(axis=1))

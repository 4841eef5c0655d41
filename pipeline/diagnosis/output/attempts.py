"""Chapters of a diagnosis that may fail without taking its verdict away."""

import logging
from dataclasses import dataclass, field

from pipeline.contract.errors import sentence_of


@dataclass(frozen=True)
class Attempts:
    """Calls chapters; ``failures`` says of each that failed, whatever with, what could not be computed and why."""

    failures: list = field(default_factory=list)

    def __call__(self, what, chapter, *arguments, otherwise=None):
        """``chapter(*arguments)``, or ``otherwise``."""
        try:
            return chapter(*arguments)
        except Exception as error:
            logging.getLogger(__name__).debug(what, exc_info=error)
            self.failures.append(f"{what} could not be computed: {sentence_of(error)}")
            return otherwise

"""Errors say where, what was expected, what was found and what to do.

Each class has its exit code: 2 for input, 3 for non-convergence, 4 for files.
"""

import traceback
from functools import wraps
from pathlib import Path

#: characters of a message, and of each of its parts
LONGEST, _PART = 2000, 600


def shortened(text, most=LONGEST):
    """``text`` of at most ``most`` characters, its end cut; what steers a terminal is written out."""
    text = "".join(c if c.isprintable() or c in "\n\t" else repr(c)[1:-1] for c in str(text)[:most + 1])
    return text if len(text) <= most else f"{text[:most - 4]} ..."


def first_of(texts, most, separator=", "):
    """The first ``most`` of ``texts`` in a line, and how many more there are."""
    more = f" and {len(texts) - most} more" if len(texts) > most else ""
    return separator.join(texts[:most]) + more


class BrakechainError(Exception):
    """Base of every error that a user can correct; ``str(error)`` is the complete message."""

    exit_code = 1
    #: whether a shorter time step may do
    shorter_step = False

    def __init__(self, where, expected=None, found=None, remedy=None):
        self.where, self.expected, self.found, self.remedy = where, expected, found, remedy
        expected, found, remedy = (part and shortened(part, _PART) for part in (expected, found, remedy))
        parts = [f"expected {expected}" * bool(expected), f"found {found}" * bool(found)]
        sentence = ", ".join(part for part in parts if part)
        message = f"{where}: {sentence}" if sentence else str(where)
        super().__init__(shortened(f"{message}; {remedy}" if remedy else message))

    def __reduce__(self):
        return type(self), (self.where, self.expected, self.found, self.remedy)


class ConfigError(BrakechainError):
    """A setting or an input is missing, unknown, of the wrong unit or out of range."""

    exit_code = 2


class ConvergenceError(BrakechainError):
    """An iteration stopped short of its tolerance; unconverged results are never returned."""

    exit_code = 3


class LongStepError(ConfigError):
    """A time step is too long for what it has to follow."""

    shorter_step = True


class UnsettledStepError(ConvergenceError):
    """An iteration within a time step stopped short of its tolerance; a shorter one may do."""

    shorter_step = True


class ProductError(BrakechainError):
    """A file or a data product breaks its contract: name, version, unit, shape, finiteness."""

    exit_code = 4


def sentence_of(error):
    """An error in one sentence; of one that no user can correct, what and where it is, and whom it concerns."""
    if isinstance(error, BrakechainError):
        return str(error)
    frames = traceback.extract_tb(error.__traceback__)
    own = [f for f in frames if "pipeline" in Path(f.filename).parts and "site-packages" not in Path(f.filename).parts]
    where = ""
    if own or frames:
        frame = (own or frames)[-1]
        parts = Path(frame.filename).parts
        where = f" ({'/'.join(parts[parts.index('pipeline'):] if own else parts[-1:])}:{frame.lineno})"
    return (f"internal error {type(error).__name__}: {shortened(error, _PART)}{where}; this is a fault of the program,"
            " please report it with the case")


def instead(answer):
    """Decorator: a function that fails, whatever with, returns ``answer(error, *its arguments)``."""
    def decorated(function):
        @wraps(function)
        def safe(*arguments, **named):
            try:
                return function(*arguments, **named)
            except Exception as error:
                return answer(error, *arguments, **named)
        return safe
    return decorated

"""Stages that cannot be finished: what needs their products is left out, all else of the chain goes on."""

from collections.abc import Callable, Iterable
from contextlib import contextmanager

from pipeline.contract.errors import ConvergenceError


class Unfinished:
    """``errors`` {name of a stage: what it raised}; ``tell(name, error)`` is called when one did and the rest goes on.

    A stage goes without those that do not converge. Any other error ends the run, as it may concern all that follows.
    """

    def __init__(self, tell: Callable = lambda name, error: None):
        self.errors, self._tell, self._lost = {}, tell, set()

    def needed_by(self, stage: object, products: Iterable) -> bool:
        """Whether ``stage`` reads one of the lost ``products`` (classes, or None); its own is then lost as well."""
        lacks = bool(self._lost & {product.name for product in products if product})
        self._lost.update({stage.output.name} if lacks else ())
        return lacks

    @contextmanager
    def noted(self, stage: object):
        """What is done inside belongs to ``stage``; a ConvergenceError of it ends here, others are passed on."""
        try:
            yield
        except Exception as error:
            self.errors[stage.name] = error
            if not isinstance(error, ConvergenceError):
                raise
            self._lost.add(stage.output.name)
            self._tell(stage.name, error)

    def end(self):
        """Raise the first of the errors, if there are any."""
        for error in self.errors.values():
            raise error

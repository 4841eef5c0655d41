"""The CPU time that a diagnosis may take: when it is spent fits end where they are, and what was not tried is told.

    budget = TimeBudget(300.0)
    with budget.counting():                      # in this process
        budget.over(fan_out)(function, items)    # in others too

Tasks in several processes count side by side: what the busiest process took is what they took. The verdict of a
diagnosis that was cut short names nothing (``diagnosis.decided``), since what was not tried might have done as well.
"""

import os
import time
from collections import Counter
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from itertools import count

import numpy as np

from pipeline.contract.errors import ConvergenceError

#: whether the time of the diagnosis that runs here is spent
_SPENT = ContextVar("time of a diagnosis", default=lambda: False)
#: seconds of the clock for which what is left is not read again, at most
_LONGEST = 0.1
#: its TimeBudget, in the process that counts it
_BUDGET = ContextVar("budget of a diagnosis", default=None)


class TimeSpentError(ConvergenceError):
    """No prediction is made any more."""

    def __init__(self):
        super().__init__("diagnosis", "a fit within the time of the diagnosis", "none: it was spent before",
                         "allow more by diagnosis.time")


def spent():
    """Whether the time of the diagnosis that runs here is spent; never outside of one."""
    return _SPENT.get()()


class _Gone:
    """Tells whether ``left()`` CPU seconds are gone.

    On virtual machines it takes half a millisecond to read them, as long as a short prediction: they are read no sooner
    than they can be gone, ten times a second at least, and once more when they have ``changed()``.
    """

    def __init__(self, left):
        self._left, self._cores = left, os.cpu_count() or 1
        self.changed()

    def changed(self):
        self._look = -np.inf

    def __call__(self):
        now = time.monotonic()
        if now < self._look:
            return False
        left = self._left()
        self._look = now + min(left / self._cores, _LONGEST)
        return left <= 0


@contextmanager
def until(over):
    """Context in which the time is spent once ``over()`` says so."""
    token = _SPENT.set(over)
    try:
        yield
    finally:
        _SPENT.reset(token)


def within(seconds):
    """Context in which the time is spent after so many CPU ``seconds`` of this process; np.inf: never."""
    end = time.process_time() + seconds
    return until(_Gone(lambda: end - time.process_time()))


@contextmanager
def share(part):
    """Context with this ``part`` of what is left of the time of the diagnosis that runs here, if any is counted."""
    budget = _BUDGET.get()
    if budget is None:
        yield
        return
    whole = budget.seconds
    budget.seconds = budget.used + part * max(whole - budget.used, 0.0)
    budget.gone.changed()
    try:
        yield
    finally:
        budget.seconds = whole
        budget.gone.changed()


class TimeBudget:
    """CPU ``seconds`` of one core; ``by_name`` {hypothesis: CPU seconds} of tasks that were about one."""

    def __init__(self, seconds=np.inf):
        self.seconds, self._begin, self._elsewhere, self.by_name = seconds, time.process_time(), Counter(), Counter()
        self.gone = _Gone(lambda: self.seconds - self.used)

    @property
    def used(self):
        """CPU seconds so far."""
        return time.process_time() - self._begin + max(self._elsewhere.values(), default=0.0)

    @contextmanager
    def counting(self):
        """Context in which the time is spent once this budget is."""
        token = _BUDGET.set(self)
        try:
            with until(self.gone):
                yield
        finally:
            _BUDGET.reset(token)

    def over(self, fan_out):
        """``fan_out``, its tasks within what is left."""
        def counted(function, items):
            results, timed = [], partial(_timed, function, (os.getpid(), next(_ROUNDS)), self.seconds - self.used)
            for result, name, process, took in fan_out(timed, items):
                self.by_name[name] += took
                if process != os.getpid():
                    self._elsewhere[process] += took
                results.append(result)
            self.gone.changed()
            return results

        return counted


#: numbers of the rounds of tasks that this process hands out
_ROUNDS = count()
#: the round that this process has its share of, and its CPU time when that began
_ROUND = [None, 0.0]


def _timed(function, this_round, seconds, item):
    """(``function(item)``, name of the hypothesis that it is about, process, CPU seconds); all tasks of one round in
    one process have so many ``seconds`` together."""
    begin, over = time.process_time(), _SPENT.get()
    if _ROUND[0] != this_round:
        _ROUND[:] = this_round, begin
    end = _ROUND[1] + seconds
    gone = _Gone(lambda: end - time.process_time())
    with until(lambda: over() or gone()):
        result = function(item)
    return result, _name(item), os.getpid(), time.process_time() - begin


def _name(item):
    about = item[0] if isinstance(item, tuple) else item
    about = getattr(about, "hypothesis", about)
    return getattr(about, "name", "")

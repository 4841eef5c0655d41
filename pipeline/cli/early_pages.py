"""The reader first: what is known while a chain runs, as a sentence on the terminal and a page in the run folder."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from pipeline import __version__
from pipeline.case_models.early.first_look import coarse
from pipeline.contract import Products, store
from pipeline.contract.errors import sentence_of, shortened

#: stages whose products change the answer
ANSWERING = ("complex_modes", "convergence", "limit_cycle", "probability", "sensitivities", "design_search",
             "countermeasures")
#: the variant of the case that is a first look, the page, and what other programs read of it
LOOK, PAGE, VERDICT = "first_look", "report.html", "verdict.json"


class EarlyPages:
    """Pages of a run that is under way, each marked; the stage report writes the last one.

    What goes wrong here is said, and leaves the run as it is.
    """

    def __init__(self, job, context, say, failed=()):
        """``job``: a ChainRun, run whole; ``say(text)`` prints a line; ``failed``: names of stages that have, in which
        others may come to be."""
        self._job, self._context, self._say, self._failed = job, context, say, failed
        self._begin, self._stages = time.monotonic(), {stage.name: stage for stage in job.case.stages}
        self._done, self._lock = set(), threading.Lock()
        self._writer, self._page = ThreadPoolExecutor(1), None      # pages are made beside the stage that follows

    def open(self, states):
        """The first look, beside the first stages, unless the planned ``states`` compute no complex modes or the case
        has none."""
        if any(state.reasons for state in states if state.stage.name == "complex_modes"):
            self._try(self._look)

    def follow(self, stage, computed=True):
        """A page after ``stage``, if it was ``computed`` and changed the answer, and others may change it again.

        It is there before this is called for the stage after it, so that none is written after that of the report.
        """
        if self._page:
            self._page.result()
        with self._lock:
            self._done.add(stage.name)
        coming = [name for name in self._stages if name not in self._done and name not in self._failed]
        if computed and stage.name in ANSWERING and coming[:-1] and coming[-1] == "report":
            self._page = self._writer.submit(self._try, partial(self._follow, frozenset(self._done), coming[:-1]))

    def end(self, errors):
        """The page of what is done, where stages raised ``errors`` {name: error}; whether there is one."""
        if self._page:
            self._page.result()
        if "report" in self._stages and self._done and errors:
            self._try(partial(self._end, errors))
            return (self._job.folder / PAGE).exists()
        return False

    def _end(self, errors):
        from pipeline.views.pages.early import unfinished_page

        left = [name for name in self._stages if name not in {*self._done, *errors, "report"}]
        told = {name: sentence_of(error) for name, error in errors.items()}
        page, verdict = unfinished_page(self._products(self._done), self._card(), told, left,
                                        self._job.case.sections["report"])
        self._job.announce(self._stages["report"], PAGE, page)
        self._job.announce(self._stages["report"], VERDICT, verdict)

    def _look(self):
        changes = coarse(self._job.case.sections)
        if not changes:
            return
        last = self._stages["complex_modes"]
        run, task = self._job.ready_to_look(LOOK, changes, last, self._context)
        looked = partial(self._looked, run, last)
        if self._context.spares and self._context.sees_files:
            self._context.begin(*task).add_done_callback(lambda future: self._try(partial(looked, future.result)))
        else:
            looked(partial(*task))

    def close(self):
        """Wait for the page that is being made."""
        self._writer.shutdown()

    def _looked(self, run, last, ended):
        """Tell what a ``run`` found up to the stage ``last``, unless the answer itself is there; ``ended()`` raises
        what went wrong."""
        from pipeline.views.pages.early import first_page

        ended()
        modes = store.read(last.output, run.path(last.output))
        told = first_page(modes, self._card(), [name for name in self._stages if name != "report"])
        with self._lock:
            if last.name not in self._done:
                self._show(*told)

    def _follow(self, done, ahead):
        from pipeline.views.pages.early import later_page

        self._show(*later_page(self._products(done), self._card(), ahead))

    def _products(self, done):
        """Products of the stages named in ``done``."""
        outputs = {name: stage.output for name, stage in self._stages.items() if name in done}
        return Products({name: lambda output=output: store.read(output, self._job.path(output))
                         for name, output in outputs.items()})

    def _card(self):
        return self._job.case.card(__version__)

    def _show(self, sentence, page):
        self._job.announce(self._stages["report"], PAGE, page)
        self._say(f"after {time.monotonic() - self._begin:.0f} s: {sentence}")

    def _try(self, show):
        try:
            show()
        except Exception as error:      # whatever it is: the answer of the case does not depend on it
            self._say(f"note: no page before the end of the run ({shortened(f'{type(error).__name__}: {error}', 300)})")

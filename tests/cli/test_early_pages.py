"""What a reader learns while a chain runs; what goes wrong there leaves the run as it is."""

import json
import re
import threading
from concurrent.futures import Future
from types import SimpleNamespace

import pytest

import stages
from pipeline.cli import early_pages
from pipeline.cli.early_pages import EarlyPages
from pipeline.contract import Context, ConvergenceError
from stages.report import Settings as Figures
from tests.commands import ROOT, brakechain
from tests.views import products_for_views as small

NAMES = "structure", "complex_modes", "convergence", "comparison", "report"


class Job:
    """A ChainRun whose products are at hand."""

    def __init__(self):
        self.stages = [SimpleNamespace(name=name, output=name) for name in NAMES]
        self.case = SimpleNamespace(stages=self.stages, sections={"report": Figures(mode_pictures=0, dots_per_inch=50)},
                                    card=lambda version: small.case())
        self.pages, self.looks = [], 0

    def planned(self, *stale):
        return [SimpleNamespace(stage=stage, reasons=("new",) * (stage.name in stale)) for stage in self.stages]

    def path(self, output):
        return output

    def ready_to_look(self, name, changes, last, context):
        self.looks += 1
        return self, (id, self)

    def announce(self, stage, name, content):
        self.pages.append((stage.name, name, content))

    @property
    def folder(self):
        return ROOT


@pytest.fixture
def products(monkeypatch):
    made = {name: getattr(small, name)() for name in ("structure", "complex_modes", "convergence")}
    monkeypatch.setattr(early_pages.store, "read", lambda product, path: made[path])
    monkeypatch.setattr(early_pages, "coarse", lambda sections: {"surface.nodes": 8})


def opened(job):
    said = []
    return EarlyPages(job, Context(), said.append), said


def test_a_first_look_then_a_page_after_each_stage_that_changes_the_answer(products):
    job = Job()
    early, said = opened(job)
    early.open(job.planned("complex_modes"))
    for stage in job.stages:
        early.follow(stage)
    early.close()
    assert [name for _, name, _ in job.pages] == ["report.html"] * 3 and len(said) == 3
    assert "First look" in said[0] and "convergence: being computed" in said[1] and "Converged" in job.pages[2][2]
    assert all(re.match(r"after \d+ s: ", line) for line in said)


def test_no_look_where_the_modes_are_up_to_date(products):
    job = Job()
    early, said = opened(job)
    early.open(job.planned("report"))
    assert not job.looks and not said and not job.pages


def test_a_look_that_fails_is_one_line_and_no_page(products, monkeypatch):
    job = Job()
    early, said = opened(job)

    def failing(*_):
        raise ConvergenceError("sliding state", "a residual of 1e-8", "2e-3")

    monkeypatch.setattr(job, "ready_to_look", failing)
    early.open(job.planned("complex_modes"))
    assert len(said) == 1 and "no page before the end of the run (ConvergenceError: sliding state" in said[0]
    assert not job.pages
    early.follow(job.stages[0], computed=False)
    early.follow(job.stages[1])
    early.close()
    assert len(job.pages) == 1


def begun(job):
    """(EarlyPages, what they said, Future of the look) of a context that has a process to spare."""
    said, future = [], Future()
    early = EarlyPages(job, SimpleNamespace(spares=True, sees_files=True, begin=lambda *task: future), said.append)
    early.open(job.planned("complex_modes"))
    assert job.looks == 1 and not said
    return early, said, future


@pytest.mark.parametrize("done, said_first", [(1, True), (2, False)])
def test_a_look_beside_the_first_stages_is_told_when_it_is_done_unless_the_answer_is_there(products, done, said_first):
    job = Job()
    early, said, future = begun(job)
    for stage in job.stages[:done]:
        early.follow(stage)
    early.close()
    before = len(said)
    future.set_result([])
    assert ["First look" in line for line in said[before:]] == [True] * said_first


def test_a_look_beside_the_first_stages_that_fails_is_one_line(products):
    job = Job()
    _, said, future = begun(job)
    future.set_exception(ConvergenceError("sliding state", "a residual of 1e-8", "2e-3"))
    assert len(said) == 1 and "ConvergenceError: sliding state" in said[0] and not job.pages


def test_a_stage_that_is_done_after_later_ones_changes_their_page(products, monkeypatch):
    monkeypatch.setattr(early_pages, "ANSWERING", ("complex_modes", "convergence"))
    job = Job()
    early, said = opened(job)
    for k in (0, 1, 3):
        early.follow(job.stages[k], computed=bool(k))
    early.close()
    assert len(said) == 1 and said[0].endswith("Being computed: convergence, comparison.")
    job.stages.insert(4, SimpleNamespace(name="squeal", output="squeal"))
    early, said = opened(job)
    for k in (0, 1, 3, 2):
        early.follow(job.stages[k], computed=bool(k))
    early.close()
    assert len(said) == 2 and said[1].endswith("Being computed: squeal.")


def test_a_stage_that_has_failed_is_not_to_come(products):
    failed = {}
    early, said = EarlyPages(Job(), Context(), (told := []).append, failed), told
    failed["convergence"] = ConvergenceError("a", "b")
    early.follow(early._stages["complex_modes"])
    early.close()
    assert said[0].endswith("Being computed: structure, comparison.")


def test_a_page_is_there_before_the_next_stage_is_done(products, monkeypatch):
    """So that none is written after that of the report."""
    job, order, later = Job(), [], threading.Event()
    early, _ = opened(job)
    monkeypatch.setattr(job, "announce", lambda *page: (later.wait(10), order.append("page")))
    early.follow(job.stages[1])
    next_stage = threading.Thread(target=lambda: (early.follow(job.stages[-2], computed=False), order.append("stage")))
    next_stage.start()
    later.set()
    next_stage.join()
    assert order == ["page", "stage"]


def test_the_names_are_those_of_stages():
    assert set(early_pages.ANSWERING) <= set(stages.NAMES)


def test_a_stage_that_fails_leaves_the_chapters_of_what_is_done(products, monkeypatch):
    monkeypatch.setattr(early_pages, "PAGE", "README.md")      # stands for the page that is there
    job = Job()
    early, _ = opened(job)
    for stage in job.stages[:3]:
        early.follow(stage, computed=False)
    assert early.end({"comparison": ConvergenceError("a balance", "1e-8", "2e-3", "lower comparison.step")})
    (_, _, page), (_, name, verdict) = job.pages
    assert "The stage comparison could not be finished: a balance: expected 1e-8, found 2e-3; lower comparison.step." \
        in page and name == "verdict.json"
    assert 'id="complex_modes"' in page and 'id="convergence"' in page
    assert json.loads(verdict)["warnings"][0].startswith("The stage comparison could not be finished")
    assert not EarlyPages(Job(), Context(), print).end({"structure": ConvergenceError("a", "b")}), "nothing is done"


def test_a_run_that_cannot_be_finished_ends_with_its_error_and_a_report(tmp_path):
    """A time step that is too long for the simulation: modes are there before it."""
    done = brakechain("run", ROOT / "configs" / "two_mode_flutter.yaml", "--run", tmp_path / "run", "--workers", 1,
                      "--set", "transient.step=10 ms", "--set", "complex_modes.friction_steps=3",
                      "--set", "report.dots_per_inch=50", code=2)
    assert "error: transient.step (time stepping): expected at most" in done.stderr
    assert f"report of what was computed: {tmp_path / 'run' / 'report.html'}" in done.stdout
    page = (tmp_path / "run" / "report.html").read_text()
    assert "The stage transient could not be finished: transient.step (time stepping): expected at most" in page
    assert "Not computed: comparison." in page and 'id="complex_modes"' in page and 'id="transient"' not in page

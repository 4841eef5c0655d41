"""A long stage runs beside those that do not read it: the same product, none lost, errors told."""

import time
from concurrent.futures import Future
from dataclasses import dataclass, field

import pytest
from click.testing import CliRunner

from pipeline.cli.console import Bars, RunContext
from pipeline.cli.main import cli
from pipeline.contract import Context, ConvergenceError, case, runner, store
from pipeline.contract.executors import choose, run_task
from pipeline.contract.executors.long_tasks import Work, made
from tests.commands import ROOT
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Compared, Doubled


class Late(Future):
    """Done only once it is asked for."""

    def __init__(self, function, item):
        super().__init__()
        self._work = function, item

    def result(self, timeout=None):
        return run_task(*self._work)


@dataclass(frozen=True)
class Beside(Context):
    """A context with a process to spare."""

    told: list = field(default_factory=list)
    spares = True

    def begin(self, function, item):
        return Late(function, item)

    def log(self, message):
        self.told.append(message)

    remark = log


@pytest.fixture
def job(tmp_path):
    def made(chain, *overrides, folder="run"):
        (tmp_path / "toy.yaml").write_text(f"chain: {chain}\nsource: {{duration: 3 s}}\n")
        return runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load, overrides), tmp_path / folder, "superlu")
    return made


def told(run, context):
    names = []
    run.execute(context, report=lambda state, seconds: names.append((state.stage.name, seconds is not None)))
    return names


def test_what_does_not_read_it_goes_on_meanwhile(job):
    context = Beside()
    assert told(job("beside"), context) == [("source", True), ("mean", True), ("doubled", True)]
    assert told(job("beside", folder="other"), Context()) == [("source", True), ("doubled", True), ("mean", True)]
    here, there = (store.provenance(job("beside", folder=each).folder / "doubled.h5") for each in ("run", "other"))
    assert here["fingerprint"] == there["fingerprint"] and here["cpu_seconds"] > 0
    assert context.told == ["2 channels"] and (job("beside").folder / "doubled.csv").exists()
    assert told(job("beside"), context) == [(name, False) for name in CHAINS["beside"]]


def test_what_it_remarks_is_told_as_such():
    def stage(context):
        context.log("an aside")
        context.remark("k.mtx is taken as it stands")

    done = made(Work(stage, {}, "superlu", Context().case))
    assert done.told == (("log", "an aside"), ("remark", "k.mtx is taken as it stands"))


def test_what_reads_it_waits_and_so_do_variants(job):
    assert told(job("varied"), Beside())[:2] == [("source", True), ("doubled", True)]
    assert store.read(Compared, job("varied").folder / "compared.h5").ratio == pytest.approx([3.0, 2.5])


def test_it_is_kept_where_another_stage_fails(job):
    run = job("beside", "mean.fails=true")
    with pytest.raises(ConvergenceError, match="mean"):
        run.execute(Beside())
    assert (store.read(Doubled, run.folder / "doubled.h5").signal == 2000.0).all()


def test_what_it_raises_is_raised(job, monkeypatch):
    monkeypatch.setattr(Late, "result", lambda self: (_ for _ in ()).throw(ConvergenceError("doubled", "some", "none")))
    with pytest.raises(ConvergenceError, match="doubled"):
        job("beside").execute(Beside())
    assert (job("beside").folder / "mean.h5").exists() and not (job("beside").folder / "doubled.h5").exists()


def test_a_process_of_its_own_gives_the_same(job):
    work = choose(2, None)
    try:
        job("beside").execute(RunContext(executor=work, bars=Bars()))
    finally:
        work.close()
    assert (store.read(Doubled, job("beside").folder / "doubled.h5").signal == 2000.0).all()


def test_nobody_waits_for_it_after_an_interrupt(monkeypatch):
    """The command would end with the task otherwise, after ten minutes."""
    begun = []

    def execute(run, context, *_):
        begun.append(context.begin(time.sleep, 600.0))
        raise KeyboardInterrupt

    monkeypatch.setattr(runner.ChainRun, "execute", execute)
    assert CliRunner().invoke(cli, ["run", str(ROOT / "configs" / "belt.yaml"), "--workers", "2"]).exit_code == 1
    assert begun[0].done()

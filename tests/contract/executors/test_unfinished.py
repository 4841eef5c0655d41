"""Stages that fail: what needs them is left out, what does not need them goes on, the error is raised at the end."""

from types import SimpleNamespace

import pytest

from pipeline.contract import ConfigError, Context, ConvergenceError, case, runner, store
from pipeline.contract.executors.unfinished import Unfinished
from tests.contract.executors.test_long_tasks import Beside
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Mean


def stage_of(name):
    return SimpleNamespace(name=name, output=SimpleNamespace(name=name))


def test_what_needs_a_lost_product_is_lost_too():
    told, unfinished = [], Unfinished(lambda *each: told.append(each))
    first, second, third = map(stage_of, ("first", "second", "third"))
    error = ConvergenceError("first", "an answer", "none")
    with unfinished.noted(first):
        raise error
    assert told == [("first", error)] and unfinished.errors == {"first": error}
    assert unfinished.needed_by(second, [None, first.output]) and unfinished.needed_by(third, [second.output])
    assert not unfinished.needed_by(stage_of("other"), [stage_of("another").output])
    with pytest.raises(ConvergenceError, match="first: expected an answer"):
        unfinished.end()


def test_other_errors_end_the_run_and_are_noted():
    unfinished = Unfinished()
    for error in (ConfigError("a", "b", "c"), ValueError("d")):
        with pytest.raises(type(error)), unfinished.noted(stage_of(type(error).__name__)):
            raise error
    assert list(unfinished.errors) == ["ConfigError", "ValueError"]
    Unfinished().end()


@pytest.mark.parametrize("context", [Context(), Beside()], ids=["here", "beside"])
@pytest.mark.parametrize("error, goes_on", [(ConvergenceError, True), (ConfigError, False)])
def test_a_chain_goes_on_without_what_does_not_converge(tmp_path, monkeypatch, context, error, goes_on):
    """``mean`` does not read what ``doubled`` before it fails to make."""
    def fail(*_):
        raise error("doubled", "an answer", "none")

    monkeypatch.setattr("tests.contract.toy.doubled._times", fail)
    (tmp_path / "toy.yaml").write_text("chain: beside\nsource: {duration: 3 s}\n")
    run = runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load), tmp_path / "run", "superlu")
    done, unfinished = [], Unfinished()
    with pytest.raises(error, match="doubled: expected an answer"):
        run.execute(context, report=lambda state, seconds: done.append(state.stage.name), unfinished=unfinished)
    assert list(unfinished.errors) == ["doubled"] and not (tmp_path / "run" / "doubled.h5").exists()
    assert ("mean" in done) == (goes_on or isinstance(context, Beside))
    monkeypatch.undo()
    assert run.execute(context) == 2 - ("mean" in done)
    assert len(store.read(Mean, tmp_path / "run" / "mean.h5").level) == 2


def test_what_needs_it_is_not_begun(tmp_path, monkeypatch):
    def fail(*_):
        raise ConvergenceError("doubled", "an answer", "none")

    monkeypatch.setattr("tests.contract.toy.doubled._times", fail)
    (tmp_path / "toy.yaml").write_text("chain: varied\nsource: {duration: 3 s}\n")
    run = runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load), tmp_path / "run", "superlu")
    done = []
    with pytest.raises(ConvergenceError, match="doubled"):
        run.execute(Context(), report=lambda state, seconds: done.append(state.stage.name))
    assert done == ["source"]

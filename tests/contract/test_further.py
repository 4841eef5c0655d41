"""Variants that a stage asks for by what came of others: computed in turn, resumed, and computed anew when stale."""

import pytest

from pipeline.cli.console import Bars, RunContext
from pipeline.contract import ConfigError, Context, case, further, runner, store
from pipeline.contract.executors import choose
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Doubled, Sought


@pytest.fixture
def searched(tmp_path):
    path = tmp_path / "searched.yaml"
    path.write_text("chain: searched\n")
    return path


def job(config, *overrides, folder="run"):
    return runner.ChainRun(case.load(config, CHAINS, load, overrides), config.parent / folder, "superlu")


def told_by(run, context=None):
    told = []
    run.execute(context or Context(), report=lambda state, seconds: told.append((state.variant, state.stage.name))
                if seconds is not None else None)
    return told


def test_each_variant_follows_from_those_before(searched):
    assert told_by(job(searched)) == [
        ("", "source"), ("", "doubled"), ("level.3000", "source"), ("level.3000", "doubled"), ("level.4000", "source"),
        ("level.4000", "doubled"), ("", "sought")]
    assert list(store.read(Sought, searched.parent / "run" / "sought.h5").level) == [1000.0, 3000.0, 4000.0]
    assert told_by(job(searched)) == []


def test_a_stopped_search_goes_on(searched):
    assert [name for name, _ in told_by(job(searched, "sought.most=1"))][2:] == ["level.3000", "level.3000", ""]
    assert told_by(job(searched)) == [("level.4000", "source"), ("level.4000", "doubled"), ("", "sought")]


def test_what_is_stale_is_computed_anew_before_it_leads_on(searched):
    told_by(job(searched))
    changed = job(searched, "doubled.factor=4")
    stage = changed.case.stages[-1]
    assert list(further.asked(changed, stage)) == ["level.3000", "level.4000"], "what the files lead to"
    assert list(further.asked(changed, stage, set())) == ["level.3000"], "what is known without them"
    assert told_by(changed) == [("", "doubled"), ("level.3000", "doubled"), ("level.2000", "source"),
                                ("level.2000", "doubled"), ("", "sought")]
    assert list(store.read(Sought, searched.parent / "run" / "sought.h5").level) == [1000.0, 3000.0, 2000.0]


def test_before_its_inputs_are_there_a_search_asks_for_nothing(searched):
    run = job(searched)
    assert further.asked(run, run.case.stages[-1]) == {}
    assert run.plan()[-1].reasons and further.read(Doubled, run.path(Doubled)) is None
    assert further.read(Doubled, searched) is None


def test_variants_that_are_only_checked_are_refused_and_not_computed(searched):
    with pytest.raises(ConfigError, match="variant end of sought: .*source.level: expected a quantity in Pa"):
        job(searched, "sought.end=2 kg")
    told_by(job(searched))
    assert not (searched.parent / "run" / "variants" / "end").exists()


def test_a_search_in_other_processes_is_the_same(searched):
    told_by(job(searched))
    work = choose(2, None)
    try:
        told = told_by(job(searched, folder="beside"), RunContext(executor=work, bars=Bars()))
    finally:
        work.close()
    assert told[-2:] == [("level.4000", "doubled"), ("", "sought")]
    one, other = (store.read(Sought, searched.parent / folder / "sought.h5") for folder in ("run", "beside"))
    assert list(one.level) == list(other.level)

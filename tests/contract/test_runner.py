"""Resume: what is up to date stays; what changed runs again and says why."""

import ast
import multiprocessing
import os
import pickle
from dataclasses import replace
from pathlib import Path

import pytest

import stages
from pipeline import sources
from pipeline.cli.console import Bars, RunContext
from pipeline.contract import ConfigError, Context, ProductError, case, fingerprint, runner, store
from pipeline.contract.executors import choose
from pipeline.contract.integrity import kept
from pipeline.contract.integrity.lock import locked
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Compared, Doubled

ROOT = Path(__file__).parents[2]


@pytest.fixture
def config(tmp_path):
    path = tmp_path / "toy.yaml"
    path.write_text("chain: toy\nsource: {duration: 3 s}\n")
    return path


def job(config, *overrides, solver="superlu"):
    return runner.ChainRun(case.load(config, CHAINS, load, overrides), config.parent / "run", solver)


def why(run):
    return {state.stage.name: state.reasons for state in run.plan()}


def test_a_second_run_computes_nothing(config):
    assert job(config).execute(Context()) == 2
    assert job(config).execute(Context()) == 0
    assert why(job(config)) == {"source": (), "doubled": ()}
    assert store.read(Doubled, config.parent / "run" / "doubled.h5").signal[0, 0] == 2000.0
    assert (config.parent / "run" / "doubled.csv").exists()


def test_a_changed_setting_reruns_its_stage_and_what_follows(config):
    job(config).execute(Context())
    changed = job(config, "doubled.factor=3")
    assert why(changed) == {"source": (), "doubled": ("setting factor: 2.0 -> 3.0",)}
    changed = job(config, "source.level=2 kPa")
    assert why(changed)["doubled"] == ("input source is computed anew",)
    told = []
    assert changed.execute(Context(), report=lambda state, seconds: told.append((state.stage.name, state.reasons))) == 2
    assert told == [("source", ("setting level: 1000.0 -> 2000.0",)), ("doubled", ("input given changed",))]


def test_what_a_killed_run_kept_is_used_and_gone_with_the_product(config, monkeypatch):
    """A run that ends while it writes its product: what its tasks gave is not computed again."""
    monkeypatch.setattr(kept, "_SHORTEST", 0.0)
    write, folder = store.write, config.parent / "run"

    def refuse(item, path, *more):
        if path.stem == "doubled":
            raise KeyboardInterrupt
        return write(item, path, *more)

    monkeypatch.setattr(store, "write", refuse)
    with pytest.raises(KeyboardInterrupt):
        job(config).execute(Context())
    assert os.listdir(folder / ".doubled.kept") and not (folder / ".source.kept").exists()
    monkeypatch.setattr(store, "write", write)
    monkeypatch.setattr("tests.contract.toy.doubled._times", lambda factor, signal: pytest.fail("computed again"))
    job(config).execute(Context())
    assert store.read(Doubled, folder / "doubled.h5").signal[0, 0] == 2000.0
    assert not list(folder.glob(".*.kept"))


def test_the_same_content_upstream_spares_what_follows(config):
    job(config).execute(Context())
    assert job(config).execute(Context(), force={"source"}) == 1


def test_solver_version_and_code_join_the_hash(config, monkeypatch):
    job(config).execute(Context())
    assert why(job(config, solver="pypardiso"))["source"] == ("solver superlu -> pypardiso",)
    known = fingerprint.code_of
    monkeypatch.setattr(fingerprint, "code_of", lambda module: {**known(module), "pipeline.contract.units": "other"})
    assert why(job(config))["source"] == ("code pipeline.contract.units changed",)


def test_code_is_followed_through_imports():
    code = fingerprint.code_of("tests.contract.toy.doubled")
    assert {"tests.contract.toy.doubled", "pipeline.contract.units", "pipeline.contract.stage"} <= set(code)
    assert "pipeline.cli.main" not in code and "pipeline.contract.runner" not in code


def test_code_of_a_catalogue_holds_every_effect():
    """Effects are loaded by name, not by an import statement; what has them runs again when one of them changes."""
    code = fingerprint.code_of("stages.transient")
    names = ("joint.coulomb", "friction.moisture", "sensor.clipping")
    assert {f"pipeline.effects.{name}" for name in names} <= set(code)


def test_imports_are_those_of_the_syntax_tree():
    for path in [*(ROOT / "pipeline").rglob("*.py"), *(ROOT / "stages").rglob("*.py")]:
        nodes = list(ast.walk(ast.parse(path.read_text())))
        names = {a.name for n in nodes if isinstance(n, ast.Import) for a in n.names}
        for node in (n for n in nodes if isinstance(n, ast.ImportFrom)):
            names |= {node.module, *(f"{node.module}.{a.name}" for a in node.names)}
        project = {n for n in names if n.split(".")[0] in ("pipeline", "stages") and n != "stages"}
        assert project == set(sources.imports(path)), path


def test_code_that_changes_while_it_runs_is_refused(config, monkeypatch):
    known, calls = fingerprint.code_of, []
    monkeypatch.setattr(fingerprint, "code_of", lambda module: {**known(module), "n": calls.append(1) or len(calls)})
    with pytest.raises(ProductError, match="code that changed meanwhile; run again"):
        job(config).execute(Context())
    assert not (config.parent / "run" / "source.h5").exists()


def test_death_between_product_and_companion_is_noticed(config, monkeypatch):
    job(config).execute(Context())
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(store, "write_companion", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
        job(config, "doubled.factor=3").execute(Context())
    assert job(config).execute(Context()) == 1
    assert "2000.0" in (config.parent / "run" / "doubled.csv").read_text()


def test_earlier_stages_that_are_out_of_date_are_told(config):
    job(config).execute(Context())
    stale = job(config, "source.level=2 kPa").stale_before("doubled")
    assert [s.stage.name for s in stale] == ["source"] and not job(config).stale_before("doubled")


def test_damage_and_missing_companions_are_repaired(config):
    job(config).execute(Context())
    folder = config.parent / "run"
    (folder / "doubled.csv").unlink()
    assert why(job(config))["doubled"] == ("a companion file is missing",)
    (folder / "source.h5").write_bytes((folder / "source.h5").read_bytes()[:500])
    assert why(job(config))["source"] == ("its file is damaged",)
    (folder / ".source.h5.partial").write_bytes(b"half")
    assert job(config).execute(Context()) == 2 and not list(folder.glob(".*.partial"))


def test_from_takes_earlier_products_as_they_are(config):
    with pytest.raises(ProductError, match="expected the product source, found no file"):
        job(config).execute(Context(), first="doubled")
    job(config).execute(Context())
    assert job(config, "source.level=2 kPa").execute(Context(), first="doubled") == 0
    assert job(config, "source.level=2 kPa").execute(Context(), last="source") == 1


@pytest.mark.parametrize("first, last", [("sauce", None), (None, "sauce"), ("doubled", "source")])
def test_bad_ends_are_refused(config, first, last):
    with pytest.raises(ConfigError):
        job(config).plan(first, last)


@pytest.fixture
def varied(tmp_path):
    path = tmp_path / "varied.yaml"
    path.write_text("chain: varied\nsource: {level: {value: 1 kPa, origin: stated}}\n")
    return path


def test_variants_of_a_case_are_computed_for_the_stage_that_compares_them(varied):
    told, folder = [], varied.parent / "run"
    assert job(varied).execute(Context(), report=lambda state, _: told.append((state.variant, state.stage.name))) == 6
    assert told == [("", "source"), ("", "doubled"), ("louder", "source"), ("louder", "doubled"),
                    ("stronger", "doubled"), ("", "compared")]
    found = store.read(Compared, folder / "compared.h5")
    assert dict(zip(found.variant, found.ratio, strict=True)) == {"louder": 3.0, "stronger": 2.5}
    assert not (folder / "variants" / "stronger" / "source.h5").exists()
    assert job(varied).execute(Context()) == 0 and not any(why(job(varied)).values())


def test_a_variant_that_is_out_of_date_is_told_and_computed_anew(varied):
    job(varied).execute(Context())
    changed = job(varied, "doubled.factor=5")
    assert why(changed)["compared"] == ("input doubled is computed anew", "input others of louder is computed anew")
    assert changed.execute(Context()) == 3      # "stronger" leads where the case stands by now: its file is as it was
    (varied.parent / "run" / "variants" / "louder" / "doubled.h5").unlink()
    assert changed.execute(Context()) == 1


def test_variants_run_side_by_side_as_one_after_the_other(varied):
    """In processes of their own: what is told, and every product, is the same."""
    told, alone, beside = [], varied.parent / "run", varied.parent / "beside"
    job(varied).execute(Context())
    work = choose(2, None)
    try:
        context = RunContext(executor=work, bars=Bars())
        run = replace(job(varied), folder=beside)
        assert run.execute(context, report=lambda state, _: told.append((state.variant, state.stage.name))) == 6
        assert run.execute(context) == 0
    finally:
        work.close()
    assert told[2:] == [("louder", "source"), ("louder", "doubled"), ("stronger", "doubled"), ("", "compared")]
    one, other = (store.read(Compared, folder / "compared.h5") for folder in (alone, beside))
    assert list(one.ratio) == list(other.ratio)


def test_variants_run_in_turn_where_workers_do_not_see_the_run_folder(varied, monkeypatch):
    monkeypatch.setattr(Context, "sees_files", False)
    told, sent = [], Context.map
    monkeypatch.setattr(Context, "map", lambda *its: told.append(its[3]) or sent(*its))
    assert job(varied).execute(Context()) == 6 and set(told) == {"channels"}


def test_an_error_names_the_variant_that_it_is_of(varied, monkeypatch):
    known = runner.ChainRun._compute

    def failing(run, stage, context):
        if run.variant == "stronger":
            raise ConfigError("doubled.factor", "less", "5")
        return known(run, stage, context)

    monkeypatch.setattr(runner.ChainRun, "_compute", failing)
    with pytest.raises(ConfigError, match="variant stronger: doubled.factor: expected less, found 5"):
        job(varied).execute(Context())


def test_settings_of_stages_that_another_is_built_from_reach_it_and_join_its_hash(config):
    run = job(config)
    run.execute(Context())
    first, stage = run.case.stages[0], replace(run.case.stages[1], built_from=(run.case.stages[0].name,))
    plain, joined = (run.fingerprint(each).settings for each in (run.case.stages[1], stage))
    known = fingerprint.settings_of(run.case.sections[first.name])
    assert known and joined == plain | {f"{first.name}.{key}": value for key, value in known.items()}
    assert run._inputs(stage, False)["sections"] == {first.name: run.case.sections[first.name]}
    assert "sections" not in run._inputs(run.case.stages[1], False)


def test_variants_of_the_default_case_go_to_other_processes():
    """With all that was filled in here, and back: the same settings."""
    given = case.load(ROOT / "configs" / "disc_brake.yaml", stages.CHAINS, stages.load).varied({
        "countermeasures.variants": {"shim": {"change": {"structure.pad.backplate_loss_factor": 0.1}}}})
    run = runner.ChainRun(given, Path("nowhere"), "superlu")
    varied = run.variants(next(stage for stage in given.stages if stage.name == "countermeasures"))
    assert {name for name, *_ in varied} == {"countermeasures.shim"}
    for _, variant, last, _ in varied:
        here = variant.case.sections
        there, same = pickle.loads(pickle.dumps((variant, last)))
        assert same is last and there.code == variant.code
        assert {name: s.model_dump() for name, s in there.case.sections.items()} == {
            name: s.model_dump() for name, s in here.items()}


def _hold(folder, ready, free):
    with locked(Path(folder)):
        ready.set()
        free.wait(20)


def test_two_runs_on_one_folder(config):
    spawn = multiprocessing.get_context("spawn")
    ready, free = spawn.Event(), spawn.Event()
    other = spawn.Process(target=_hold, args=(str(config.parent / "run"), ready, free))
    other.start()
    assert ready.wait(20)
    with pytest.raises(ProductError, match=f"another run on it .process {other.pid}."):
        job(config).execute(Context())
    free.set()
    other.join()
    assert job(config).execute(Context()) == 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_told(config):
    config.parent.chmod(0o500)
    with pytest.raises(ProductError, match="a run folder that can be written"):
        job(config).execute(Context())


def test_a_file_in_place_of_the_folder_is_told(config):
    (config.parent / "run").write_text("")
    with pytest.raises(ProductError, match="a run folder that can be written"):
        job(config).execute(Context())


def test_provenance_says_how_it_was_made(config):
    job(config).execute(Context())
    told = store.provenance(config.parent / "run" / "source.h5")
    assert told["stage"] == "source" and '"duration": "3 s"' in told["settings"] and told["wall_seconds"] >= 0
    assert {"git_commit", "packages", "kernels", "python", "cpu_seconds", "brakechain"} <= set(told)


def test_a_look_ahead_computes_a_variant_with_what_it_shares_and_nothing_else(config):
    run = job(config)
    with locked(run.folder):
        look, (compute, item) = run.ready_to_look("look", {"doubled.factor": 3}, run.case.stages[1], Context())
        compute(item)
    assert store.read(Doubled, look.path(Doubled)).signal[0, 0] == 3000.0
    assert sorted(path.name for path in run.folder.glob("*.h5")) == ["source.h5"], "shared, and computed once"
    before = look.path(Doubled).stat().st_mtime_ns
    again, (compute, item) = job(config).ready_to_look("look", {"doubled.factor": 3}, run.case.stages[1], Context())
    assert not compute(item)
    assert again.path(Doubled).stat().st_mtime_ns == before
    assert run.execute(Context()) == 1


def test_what_is_announced_replaces_what_the_stage_wrote(config):
    run = job(config)
    run.execute(Context())
    run.announce(run.case.stages[1], "doubled.csv", "to come")
    assert (run.folder / "doubled.csv").read_text() == "to come" and not (run.folder / "doubled.h5").exists()
    assert job(config).execute(Context()) == 1
    assert "2000.0" in (run.folder / "doubled.csv").read_text()


def test_what_opens_a_run_is_called_before_its_stages(config):
    told = []
    job(config).execute(Context(), report=lambda state, seconds: told.append(state.stage.name),
                        opening=lambda: told.append("opening"))
    assert told == ["opening", "source", "doubled"]

"""The command line, derived from the stages. The door of click."""

import logging
import os
import sys
import traceback
from functools import partial
from pathlib import Path

import click

import stages
from pipeline import __version__
from pipeline.cli.bench.catalogue import catalogue
from pipeline.cli.bench.check import check
from pipeline.cli.bench.data import data
from pipeline.cli.facts import facts, modes
from pipeline.cli.first_use import compiled
from pipeline.cli.new_case import new
from pipeline.cli.options import options
from pipeline.cli.run_export import export as run_export
from pipeline.cli.surface_fit import with_fit
from pipeline.cli.trial import trial

RUNS = Path("data/runs")
#: a stage that took less leaves the page to the next one (s)
_WORTH_A_PAGE = 0.1


class Derived(click.Group):
    """A group whose stage commands are created on demand: '--help' imports no stage."""

    def list_commands(self, ctx):
        return [*self.commands, *(name.replace("_", "-") for name in stages.NAMES)]

    def get_command(self, ctx, name):
        stage = name.replace("-", "_")
        return _stage_command(stage) if stage in stages.NAMES else super().get_command(ctx, name)


@click.group(cls=Derived, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(__version__, prog_name="brakechain")
def cli():
    """brakechain: from asperities to brake squeal, one HDF5 file per step.

    'brakechain run CONFIG' runs the chain of a case; every stage is a command of its own.
    Products are written to data/runs/<case>/; 'brakechain inspect FILE' shows what is in one.
    """


_CONFIG = click.argument("config", type=click.Path(path_type=Path))
_FAN_OUT = ("dry", "workers", "scheduler", "debug")


@cli.command()
@_CONFIG
@options("run", "set", "from", "until", "force", *_FAN_OUT)
def run(config, folder, overrides, first, last, force, dry_run, workers, scheduler):
    """Run the chain of CONFIG; stages that are up to date are skipped."""
    _run(config, folder, overrides, first, last, force, dry_run, workers, scheduler)


def _stage_command(name):
    """The command of one stage; all have the same form."""

    @click.command(name.replace("_", "-"), help=stages.summary(name), short_help=stages.summary(name))
    @_CONFIG
    @options("run", "set", "again", *_FAN_OUT)
    def command(config, folder, overrides, again, dry_run, workers, scheduler):
        _run(config, folder, overrides, name, name, (name,) if again else (), dry_run, workers, scheduler)

    return with_fit(command) if name == "surface" else command


@cli.command()
@_CONFIG
@click.argument("variants", metavar="VARIANT...", nargs=-1, required=True, type=click.Path(path_type=Path))
@options("run", "set", *_FAN_OUT)
def compare(config, variants, folder, overrides, dry_run, workers, scheduler):
    """Compare CONFIG with each VARIANT, a case of the same chain: unstable modes and probability of squeal.

    What a VARIANT states otherwise becomes a variant in the section countermeasures of CONFIG, whose chain then runs.
    """
    from pipeline.cli import compare as variant_files

    others = [_loaded(file, overrides, ("countermeasures",)) for file in variants]
    job = _job_of(variant_files.with_variants(_loaded(config, overrides), others), folder)
    _execute(job, None, None, (), dry_run, workers, scheduler)
    if not dry_run:
        variant_files.show(job)


def _run(config, folder, overrides, first, last, force, dry_run, workers, scheduler):
    _execute(_job(config, folder, overrides), first, last, force, dry_run, workers, scheduler)


def _execute(job, first, last, force, dry_run, workers, scheduler):
    from pipeline.cli.console import Bars, RunContext
    from pipeline.cli.early_pages import EarlyPages
    from pipeline.cli.pace import Pace
    from pipeline.contract import executors
    from pipeline.contract.executors.unfinished import Unfinished

    first, last, *force = (name and name.replace("-", "_") for name in (first, last, *force))
    names = [s.name for s in job.case.stages]
    for name in force:
        if name not in names:
            raise click.BadParameter(f"expected one of {', '.join(names)}, found {name!r}", param_hint="--force")
    for stale in job.stale_before(first):
        why = _because(stale.reasons)
        click.echo(f"note: {stale.stage.name} is out of date ({why}) and is used as it is", err=True)
    if dry_run:
        _show_plan(job.plan(first, last, frozenset(force)))
        return
    work, early, unfinished = executors.choose(workers or os.cpu_count() or 1, scheduler), None, Unfinished(_go_on)
    try:
        context = RunContext(solver=job.solver, case=job.case.card(__version__), executor=work, bars=Bars())
        early = EarlyPages(job, context, click.echo, unfinished.errors) if first is None and last is None else None
        pace = Pace(job, getattr(work, "workers", 1))
        computed = job.execute(context, first, last, frozenset(force), partial(_report, early, pace),
                               lambda: _open(early, pace, job.plan(first, last, frozenset(force))), unfinished)
    except KeyboardInterrupt:       # nobody waits for a long task
        work.stop()
        raise
    except Exception:
        if early and early.end(unfinished.errors):
            click.echo(f"report of what was computed: {job.folder / 'report.html'}")
        raise
    finally:
        work.close()
        if early:
            early.close()
    if not computed:
        click.echo(f"nothing to compute: everything asked for is up to date in {job.folder}")
    elif (job.folder / "report.html").exists() and (last in (None, "report")):
        click.echo(_headline(job.folder / "verdict.json"))
        click.echo(f"report: {job.folder / 'report.html'}")


def _headline(file):
    """What the first screen of the report says, by the verdict beside it, as far as the terminal can show it."""
    import json

    said = json.loads(file.read_text(encoding="utf-8"))["headline"].replace("\u202f", " ")
    shows = sys.stdout.encoding or "ascii"
    return f"verdict: {said.encode(shows, 'replace').decode(shows)}"


def _job(config, folder, overrides):
    """The case and its run folder, checked, with the sparse solver resolved."""
    return _job_of(_loaded(config, overrides), folder)


def _loaded(config, overrides, unread=()):
    from pipeline.contract import case
    from pipeline.recordings import registry

    return case.load(config, stages.CHAINS, stages.load, overrides, registry.path, unread)


def _job_of(chosen, folder):
    from pipeline.contract import runner
    from pipeline.physics.numerics import sparse_solver

    solver = sparse_solver.available()[0] if chosen.solver == "auto" else chosen.solver
    if solver not in sparse_solver.available():
        raise click.BadParameter(f"{chosen.path}: solver: expected one of {', '.join(sparse_solver.available())} on"
                                 f" this machine, found {solver!r}")
    return runner.ChainRun(chosen, folder or RUNS / chosen.name, solver)


def _open(early, pace, states):
    """Say how long the planned ``states`` will take, and have a first look where there is one."""
    for told in filter(None, (pace.forecast(states), pace.short_of_memory(states))):
        click.echo(told)
    if early:
        early.open(states)
    pace.begin()


def _report(early, pace, state, seconds):
    pace.note(state, seconds)
    if seconds is not None:
        name = f"  {state.variant}: {state.stage.name}" if state.variant else state.stage.name
        click.echo(f"{name:<16} {seconds:8.1f} s   {_because(state.reasons)}")
    if early and not state.variant:
        early.follow(state.stage, computed=seconds is not None and seconds > _WORTH_A_PAGE)


def _go_on(name, error):
    """Say that the chain goes on without a stage; what it raised is told at the end."""
    click.echo(f"{name:<16} not finished; what does not need it goes on ({_because([str(error)])})", err=True)


def _because(reasons, most=3, longest=100):
    """The first reasons in one line."""
    from pipeline.contract.errors import first_of

    return first_of([reason if len(reason) <= longest else f"{reason[:longest]} ..." for reason in reasons], most, "; ")


def _show_plan(states):
    for state in states:
        status = f"would run: {_because(state.reasons)}" if state.reasons else "up to date"
        click.echo(f"{state.stage.name:<16} {status}")
    if not any(state.reasons for state in states):
        click.echo("nothing to compute")


@cli.command()
@_CONFIG
@options("run", "set", "debug")
@click.option("--dot", is_flag=True, help="print the graph in the language of Graphviz")
def chain(config, folder, overrides, dot):
    """List the stages of CONFIG, their state, and why each would run again."""
    job = _job(config, folder, overrides)
    states = job.plan()
    if not dot:
        _show_plan(states)
        return
    click.echo("digraph chain {\n  rankdir=LR; node [shape=box, fontname=\"sans-serif\"];")
    for state in states:
        style = "dashed" if state.reasons else "solid"
        click.echo(f"  {state.stage.name} [style={style}];")
        for product in job.filled(state.stage).values():
            if product:
                click.echo(f"  {product.name} -> {state.stage.name};")
    click.echo("}")


@cli.command()
@click.argument("file", type=click.Path(path_type=Path))
@options("debug")
def inspect(file):
    """Show what is in a product FILE: tree, dimensions, units, ranges, provenance."""
    from pipeline.cli.inspect import describe

    for line in describe(file):
        click.echo(line)


@cli.command()
@click.argument("folder", metavar="RUN", type=click.Path(path_type=Path))
@options("debug")
def verify(folder):
    """Verify that every product, table and page in the folder RUN is as it was written: all are hashed."""
    from pipeline.contract import ProductError
    from pipeline.contract.integrity.verify import verify as verified

    files = verified(folder)
    for file in files:
        click.echo(f"{file.name:<32} {file.flaw or 'as it was written'}")
    damaged = [file.name for file in files if file.flaw]
    if damaged:
        raise ProductError(folder, f"{len(files)} files as they were written", f"{len(damaged)} that are not:"
                           f" {', '.join(damaged)}", "'brakechain run' computes them again")


@cli.command()
@click.argument("name", required=False)
@options("debug")
def schema(name):
    """Print the JSON schema of the YAML of chain NAME, for editors  [default: all chains]."""
    from pydantic_core import to_json

    from pipeline.cli.schema import case_schema

    names = [name] if name else list(stages.CHAINS)
    if name and name not in stages.CHAINS:
        raise click.BadParameter(f"expected one of {', '.join(stages.CHAINS)}, found {name!r}", param_hint="NAME")
    chains = {n: [stages.load(s) for s in stages.CHAINS[n]] for n in names}
    click.echo(to_json(case_schema(chains), indent=2))


@cli.command()
@_CONFIG
@options("set", "debug")
@click.option("--csv", "file", metavar="FILE", type=click.Path(path_type=Path), help="write the table there too")
def plan(config, overrides, file):
    """Plan a campaign: which planned run of CONFIG can identify which effect, and the cheapest set for all of them."""
    from pipeline.case_models import effect_block, virtual_rig
    from pipeline.cli.console import table
    from pipeline.contract import ConfigError, case
    from pipeline.contract.store import write_companion
    from pipeline.diagnosis import campaign_planning
    from pipeline.recordings import registry

    given = case.load(config, stages.CHAINS, stages.load, overrides, registry.path, unread=("recording",))
    if given.document["chain"] != "lumped_bench":
        raise ConfigError(f"{config}: chain", "lumped_bench, whose runs can be planned", given.document["chain"])
    chosen = given.sections
    model = stages.load("reduced_model")(stages.load("lumped")(settings=chosen["lumped"]),
                                         settings=chosen["reduced_model"])
    whole = effect_block.with_effects(virtual_rig.built(model, chosen["bench"]),
                                      effect_block.product(chosen["effects"]))
    result = campaign_planning.plan(whole, campaign_planning.channel_units(whole), chosen["diagnosis"])
    head, rows = campaign_planning.table(result)
    table("d: standard deviations that each effect leaves beside the nominal values", head, rows,
          campaign_planning.conclusion(result))
    if file is not None:
        write_companion(file, "\n".join(",".join(row) for row in (head, *rows)) + "\n")


cli.add_command(data)
cli.add_command(check)
cli.add_command(catalogue)
cli.add_command(run_export)
cli.add_command(facts)
cli.add_command(modes)
cli.add_command(compiled)
cli.add_command(new)
cli.add_command(trial)


@cli.command()
@options("debug")
def completion():
    """Print how to switch on command completion in your shell."""
    for shell, file in (("bash", "~/.bashrc"), ("zsh", "~/.zshrc")):
        click.echo(f"{shell}: add to {file}:   eval \"$(_BRAKECHAIN_COMPLETE={shell}_source brakechain)\"")
    click.echo("fish: run once:   _BRAKECHAIN_COMPLETE=fish_source brakechain >"
               " ~/.config/fish/completions/brakechain.fish")


def main():
    """Run a command: errors become one sentence and an exit code; --debug shows the traceback."""
    debug = "--debug" in sys.argv
    for name in ("pipeline", "stages"):     # failures that a command survives
        log = logging.getLogger(name)
        log.setLevel(logging.DEBUG if debug else logging.NOTSET)
        log.handlers = [logging.StreamHandler()] if debug else []
    try:
        sys.exit(cli(standalone_mode=False))
    except click.exceptions.Exit as stop:
        sys.exit(stop.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except (click.Abort, KeyboardInterrupt):
        click.echo("stopped; finished stages are kept, run the same command to continue", err=True)
        sys.exit(130)
    except Exception as error:
        _fail(error)


def _fail(error):
    """End with one line about an error of the user's; of any other, the last resort, the traceback is on request."""
    from pipeline.contract.errors import BrakechainError, shortened

    if "--debug" in sys.argv:
        traceback.print_exception(error)
    known = isinstance(error, BrakechainError)
    message = str(error) if known else (f"internal error: {shortened(f'{type(error).__name__}: {error}', 1000)};"
                                        " run again with --debug for the traceback")
    click.echo(f"error: {message}", err=True)
    sys.exit(error.exit_code if known else 1)


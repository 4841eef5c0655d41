"""The commands of a blind trial: make, seal, solve, score, verify, show, remake."""

import os
from pathlib import Path

import click

from pipeline.cli.options import options

_SET = click.argument("folder", metavar="SET", type=click.Path(path_type=Path))
_KEY = click.option("--key", "key_file", metavar="FILE", type=click.Path(path_type=Path),
                    help="the key, outside the set  [default: in the user's data folder, by the name of the set]")


@click.group()
def trial():
    """The blind trial: cases with hidden physics, solved without their ground truth and scored once.

    A set is a folder of cases/NNN/{nominal.yaml, recordings.h5}; docs/trial_sets.md explains how to make one yourself.
    """


@trial.command()
@_SET
@click.option("--cases", type=click.IntRange(1), default=40, show_default=True, help="number of cases")
@click.option("--systems", metavar="A,B", help="systems to draw cases from  [default: all]")
@click.option("--seed", type=click.IntRange(0), help="seed of an open set  [default: 0]")
@click.option("--sealed", is_flag=True, help="seal the truth; seeds are then drawn from the operating system")
@_KEY
@options("workers", "scheduler", "debug")
def make(folder, cases, systems, seed, sealed, key_file, workers, scheduler):
    """Make SET: an open one with its truth beside it, or a sealed one. An interrupted run is continued."""
    from pipeline.blind_trial.generators.systems import SYSTEMS
    from pipeline.blind_trial.protocol import making, sealing

    if sealed and seed is not None:
        raise click.UsageError("--seed belongs to open sets: seeds of a sealed one are secret")
    if key_file and not sealed:
        raise click.UsageError("--key belongs to sealed sets: add --sealed")
    names = tuple(systems.split(",")) if systems else tuple(SYSTEMS)
    path = sealing.key_path(folder, key_file) if sealed else None

    def key(begun):
        return sealing.read_key(path) if begun else sealing.new_key(path)

    with _working(workers, scheduler) as work:
        making.make(folder, cases, names, work, None if sealed else seed or 0, key if sealed else None,
                    _counter("made"))
    _summarise(folder, path)


@trial.command()
@_SET
@_KEY
@options("debug")
def seal(folder, key_file):
    """Seal an open SET that has not been solved: encrypt its truth.json and commit to it."""
    from pipeline.blind_trial.protocol import making, sealing

    path = sealing.key_path(folder, key_file)
    making.seal(folder, lambda: sealing.new_key(path))
    _summarise(folder, path)


@trial.command()
@_SET
@click.option("--methods", metavar="A,B", help="the diagnosis and baselines by name  [default: all]")
@click.option("--limit", type=click.FloatRange(min=0, min_open=True), default=3600.0, show_default=True,
              metavar="SECONDS", help="time limit per case; a slower one counts as unanswered")
@options("workers", "scheduler", "debug")
def solve(folder, methods, limit, workers, scheduler):
    """Solve SET, each case in an isolated process that is given only its two files. An interrupted run is continued."""
    from pipeline.blind_trial.protocol import solving

    names = tuple(methods.split(",")) if methods else solving.METHODS
    with _working(workers, scheduler) as work:
        count = solving.solve(folder, work, names, limit, _counter("solved"))
    click.echo(f"{count} new answers; next: brakechain trial score {folder}")


@trial.command()
@_SET
@_KEY
@click.option("--truth", "truth_file", metavar="FILE", type=click.Path(path_type=Path),
              help="truth of an open set, if stored elsewhere  [default: SET/truth.json]")
@options("debug")
def score(folder, key_file, truth_file):
    """Score a solved SET: unseal its truth, once, and publish it with the key and the result."""
    from pipeline.blind_trial.metrics.summary import lines
    from pipeline.blind_trial.protocol import scoring, sealing
    from pipeline.blind_trial.protocol.case_set import TrialSet

    key = sealing.key_path(folder, key_file) if TrialSet(folder).sealed else None
    click.echo("\n".join(lines(scoring.score(folder, key, truth_file))))


@trial.command()
@_SET
@options("debug")
def verify(folder):
    """Verify that a published SET is consistent: truth, key, commitment, answers and result."""
    from pipeline.blind_trial.protocol.verifying import verify as checked

    for sentence in checked(folder):
        click.echo(sentence)


@trial.command()
@_SET
@click.option("--markdown", is_flag=True, help="print the table of rates as Markdown instead")
@options("debug")
def show(folder, markdown):
    """Write the page of a scored SET, trial.html."""
    from pipeline.blind_trial.metrics.summary import as_markdown
    from pipeline.blind_trial.protocol.case_set import TrialSet, in_format
    from pipeline.contract.store import write_companion
    from pipeline.views.pages.trial import page

    result = TrialSet(folder).read("result.json")
    with in_format(folder):
        shown = as_markdown(result) if markdown else page(result)
    if markdown:
        click.echo(shown)
        return
    write_companion(folder / "trial.html", shown)
    click.echo(f"page: {folder / 'trial.html'}")


@trial.command()
@_SET
@click.argument("into", metavar="[NEW]", required=False, type=click.Path(path_type=Path))
@_KEY
@options("workers", "scheduler", "debug")
def remake(folder, into, key_file, workers, scheduler):
    """Make the cases of SET again: in SET itself if they were lost, or as the open set NEW, to be solved again.

    NEW requires a published set. Only sets made by 'trial make' can be made again. An interrupted run is continued.
    """
    from pipeline.blind_trial.protocol import remaking, sealing

    if into and key_file:
        raise click.UsageError("--key is not needed for NEW: it is made from a published set, whose key is public")
    with _working(workers, scheduler) as work:
        if into:
            same = remaking.repeat(folder, into, work, _counter("made"))
            click.echo("the files are identical to those of the set" if same else
                       "the files differ from those of the set: other package versions or another processor")
        else:
            remaking.restore(folder, work, sealing.key_path(folder, key_file), _counter("made"))
    click.echo(f"next: brakechain trial solve {into or folder}")


def _working(workers, scheduler):
    from contextlib import closing

    from pipeline.contract import executors

    return closing(executors.choose(workers or os.cpu_count() or 1, scheduler))


def _counter(action):
    def report(done, total):
        click.echo(f"{done} of {total} {action}")

    return report


def _summarise(folder, key_file):
    from pipeline.blind_trial.protocol.case_set import TrialSet

    trial_set = TrialSet(folder)
    classes = ", ".join(f"{count} {name}" for name, count in trial_set.about["classes"].items())
    click.echo(f"{trial_set.about['cases']} cases: {classes}")
    if trial_set.sealed:
        click.echo(f"commitment {trial_set.about['commitment']}\nkey: {key_file} (keep it secret until scoring)")
    click.echo(f"next: brakechain trial solve {folder}")

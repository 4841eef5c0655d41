"""The commands that show numbers of a run: published facts beside ours, which are recorded too, and the modes."""

import json
import re
from pathlib import Path

import click

from pipeline.cli.options import options


@click.command()
@click.argument("sources", metavar="RUN...", nargs=-1, required=True, type=click.Path(exists=True, path_type=Path))
@click.option("--only", metavar="A,B", help="keys of the facts to show, in this order  [default: all testable ones]")
@click.option("--markdown", is_flag=True, help="print the table as Markdown, as in README.md")
@click.option("--record", "file", metavar="FILE", type=click.Path(path_type=Path),
              help="write the numbers to FILE, e.g. data/reference/computed/disc_brake_paper_joints.json")
@options("debug")
def facts(sources, only, markdown, file):
    """Show published facts beside the numbers of RUN, with the product field that each comes from.

    RUN is a run folder, or a record written with --record. Several folders of one case, e.g. computed on different
    processors, give ranges.
    """
    from pipeline.cli.console import table
    from pipeline.contract.errors import ConfigError
    from pipeline.contract.store import write_companion
    from pipeline.views.pages import facts as page

    record = _record(sources)
    if file is not None:
        _committed(record["runs"])
        write_companion(file, json.dumps(record, indent=1, ensure_ascii=False) + "\n")
        click.echo(f"{len(record['facts'])} facts of {len(record['runs'])} runs: {file}")
        return
    keys = only.split(",") if only else ()
    for key in keys:
        if key not in record["facts"]:
            raise ConfigError(f"--only {key}", "the key of a testable fact", "none of this name",
                              f"keys are {', '.join(record['facts'])}")
    if markdown:
        click.echo(page.markdown(record["facts"], keys))
        return
    table("published facts", *page.table(record["facts"], keys))


def _committed(runs):
    """ConfigError if no commit holds the code of a run: its numbers could not be computed again."""
    from pipeline.contract.errors import ConfigError

    for commit in sorted({commit for run in runs for commit in run["commits"]}):
        if not re.fullmatch("[0-9a-f]{40}", commit):
            raise ConfigError("--record", "runs of committed code", f"products of {commit}",
                              "commit the change ('+' marks one that is not), and run the case again")


def _record(sources):
    """The record in ``sources[0]``, or that of the run folders ``sources``."""
    from pipeline.contract.errors import ConfigError
    from pipeline.views.pages import facts as page

    if sources[0].is_file():
        if len(sources) > 1:
            raise click.UsageError("one record, or run folders: they cannot be mixed")
        return _stored(sources[0])
    comparisons, runs = zip(*map(_computed, sources), strict=True)
    keys = [list(map(str, comparison.key)) for comparison in comparisons]
    for source, its_keys in zip(sources, keys, strict=True):
        if its_keys != keys[0]:
            raise ConfigError(source, f"the facts of {sources[0]}", "others", "give run folders of one case")
    return page.record(comparisons, list(runs))


def _stored(file):
    from pipeline.contract.errors import ConfigError

    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        return {"runs": record["runs"], "facts": record["facts"]}
    except (ValueError, KeyError, TypeError, UnicodeDecodeError):
        raise ConfigError(file, "a record of facts (JSON)", "something else", "write one with 'facts RUN --record FILE'"
                          ) from None


def _computed(folder):
    """(Comparison, {commits, kernels} of all products) of a run folder."""
    from pipeline.contract import store
    from pipeline.products import Comparison

    comparison = store.read(Comparison, folder / f"{Comparison.name}.h5")
    origins = [store.provenance(path) for path in sorted(folder.glob("*.h5"))]
    kernels = {kernel for origin in origins for kernel in json.loads(origin.get("kernels", "[]"))}
    return comparison, {"commits": sorted({origin["git_commit"] for origin in origins}), "kernels": sorted(kernels)}


@click.command()
@click.argument("folder", metavar="RUN", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--heard", multiple=True, metavar="F", help="a frequency that was measured, such as \"2.75 kHz\": how far"
              " from a mode, and how often by chance; may be repeated")
@click.option("--near", type=click.FloatRange(0, 0.3, True, True), default=0.03, show_default=True,
              help="share of its frequency within which a mode is near")
@options("debug")
def modes(folder, heard, near):
    """Show the unstable modes of the folder RUN: growth, damping ratios, onset over friction, and why they grow.

    Where none is unstable, the least stable ones.
    """
    import numpy as np

    from pipeline import products
    from pipeline.case_models.named_modes import named_modes
    from pipeline.cli.console import table
    from pipeline.contract import ProductError, store
    from pipeline.contract.units import to_si
    from pipeline.views.pages import modes as page

    def stored(product):
        file = folder / f"{product.name}.h5"
        return store.read(product, file) if file.exists() else None

    measured = [to_si(given, "Hz", "--heard") for given in heard]
    of_case, of_matrices = stored(products.ComplexModes), stored(products.MatrixModes)
    if of_case is None and of_matrices is None:
        raise ProductError(folder, "complex_modes.h5 or matrix_modes.h5", "neither", "run a case up to its modes")
    title, rows, reasons = page.of_matrices(of_matrices) if of_case is None else page.of_case(of_case)
    motion = next(filter(None, map(stored, (products.LimitCycle, products.Transient))), None)
    table(title, page.HEAD, rows)
    unstable = (of_matrices.roots if of_case is None else of_case).unstable_root.imag / (2 * np.pi)
    told = [*reasons, *page.matters(stored(products.Sensitivities)), *page.cycles(motion, unstable)]
    if measured:
        file = folder / f"{(of_matrices if of_case is None else of_case).name}.h5"
        told += page.beside(named_modes({}, file, folder), measured, near)
    for sentence in (*told, page.CONVENTIONS):
        click.echo(sentence.replace("\u202f", " "))

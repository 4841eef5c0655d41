"""A case beside variants that are case files: what differs between the files becomes variants of the first."""

from dataclasses import replace

import click

from pipeline.contract import settings
from pipeline.contract.errors import ConfigError

#: the stage that compares, and the keys of its section that a variant states of itself
STAGE, OF_ITSELF = "countermeasures", ("cost", "note")


def with_variants(base, others):
    """The CaseFile ``base`` with ``others``, CaseFiles, as variants of its stage countermeasures; checked."""
    if STAGE not in [stage.name for stage in base.stages]:
        raise ConfigError(f"{base.path}: chain", f"a chain with the stage {STAGE}: own_brake or brake_squeal",
                          repr(base.document["chain"]), "choose one of these chains")
    section = dict(base.document.get(STAGE) or {})
    declared = dict(section.get("variants") or {})
    for other in others:
        if other.name in declared:
            raise ConfigError(other.path, "a variant of another name than the others", repr(other.name),
                              "rename the file")
        declared[other.name] = _variant(base, other)
    made = replace(base, document={**base.document, STAGE: {**section, "variants": declared}})
    made.check()
    return made


def _variant(base, other):
    """The variant {change, cost, note} that a CaseFile is of another."""
    if other.document["chain"] != base.document["chain"]:
        raise ConfigError(f"{other.path}: chain", f"{base.document['chain']}, as in {base.path}",
                          other.document["chain"], "compare cases of one chain")
    names = [stage.name for stage in base.stages if stage.name != STAGE]
    given, known = ({n: settings.without_origins(case.document.get(n) or {}, f"{case.path}: {n}") for n in names}
                    for case in (other, base))
    change = {key: value for name in names for key, value in differences(name, known[name], given[name]).items()}
    if not change:
        raise ConfigError(other.path, f"settings that differ from those of {base.path}", "none", "leave it out")
    said = settings.without_origins(other.document.get(STAGE) or {}, f"{other.path}: {STAGE}")
    title = other.document.get("title", "")
    note = {"note": title} if title != base.document.get("title", "") else {}
    return {"change": change, **note, **{key: said[key] for key in OF_ITSELF if key in said}}


def differences(key, before, after):
    """{dotted key: value} that turns the plain document ``before`` at ``key`` into ``after``.

    A mapping from which a key is taken away is given as a whole.
    """
    if before == after:
        return {}
    if not isinstance(before, dict) or not isinstance(after, dict) or before.keys() - after.keys():
        return {key: after}
    return {inner: value for name in after
            for inner, value in (differences(f"{key}.{name}", before[name], after[name]) if name in before
                                 else {f"{key}.{name}": after[name]}).items()}


def show(job):
    """Print what the product of a ChainRun says, its table, and where all of it is."""
    from pipeline.cli.console import table
    from pipeline.contract import store
    from pipeline.products import Countermeasures
    from pipeline.views.chapters.models.countermeasures import statement, summary_table

    product = store.read(Countermeasures, job.folder / f"{STAGE}.h5")
    shown = summary_table(product)
    table(shown.title, shown.head, shown.rows, statement(product))
    click.echo(f"every mode: {job.folder / f'{STAGE}.csv'}")

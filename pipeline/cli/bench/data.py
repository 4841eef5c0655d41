"""Commands 'data': sets of recordings, public and one's own, where they lie and how they are written."""

from pathlib import Path

import click

from pipeline.cli.export import export
from pipeline.cli.options import options


class Sets(click.Group):
    """A group whose other names are those of sets: 'data NAME' fetches one."""

    def get_command(self, ctx, name):
        known = super().get_command(ctx, name)
        if known is not None or name.startswith("-"):
            return known

        @click.command(name, help=f"Fetch the set {name} and print where it lies.")
        @options("debug")
        def command():
            fetch(name)

        return command


@click.group(cls=Sets, subcommand_metavar="NAME | COMMAND [ARGS]...")
def data():
    """Recordings: 'data NAME' fetches a registered set, checks it by its SHA-256 and prints where it lies."""


def fetch(name):
    """Print where the files of a set lie, fetched where they are not there yet, and under which licence."""
    from pipeline.recordings import registry

    entries = registry.of_set(name)
    for entry in entries:
        click.echo(registry.path(entry.name))
    click.echo(f"licence: {'; '.join(dict.fromkeys(entry.licence for entry in entries))}")
    click.echo(f"in a case: measured:{entries[0].name}; a first case of it: brakechain new NAME --from FILE")


@data.command("list")
@options("debug")
def list_data():
    """List the registered files: name, content, what is not documented, licence."""
    from pipeline.recordings import registry

    for entry in registry.entries().values():
        click.echo(f"{entry.name}\n    {entry.content}\n    lacks: {entry.lacks}\n    licence: {entry.licence}")


@data.command("add")
@click.argument("files", metavar="FILE...", nargs=-1, required=True,
                type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--name", required=True, help="name of the set: letters, digits, - and _")
@click.option("--licence", required=True, help="under which others may use it, as CC-BY-4.0, or 'not public'")
@click.option("--source", required=True, help="where it is from: bench, people, date, address")
@click.option("--lacks", default="not stated", help="what is not documented of it")
@options("debug")
def add(files, name, licence, source, lacks):
    """Register files of your own as the set NAME, by their SHA-256: cases find them as measured:NAME/FILE."""
    from pipeline.recordings import registry

    for entry in registry.added(files, name, licence, source, lacks):
        click.echo(f"measured:{entry.name}   SHA-256 {entry.sha256}")
    click.echo(f"noted in {registry.own_registry()}; the files stay where they are")


@data.command("path")
@click.argument("name")
@options("debug")
def data_path(name):
    """Print the path of the registered file NAME; it is downloaded unless BRAKECHAIN_DATA names a folder."""
    from pipeline.recordings import registry

    click.echo(registry.path(name))


@data.command("format")
@options("debug")
def data_format():
    """Print the format of plain HDF5 recordings that any program can write."""
    import inspect as source

    from pipeline.recordings.neutral import read_neutral

    click.echo(source.cleandoc(read_neutral.__doc__))


data.add_command(export)

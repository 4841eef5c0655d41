"""Options that several commands share."""

from pathlib import Path

import click


def options(*which):
    """Options that several commands share, by name."""
    table = {
        "run": click.option("--run", "folder", metavar="DIR", type=click.Path(path_type=Path),
                            help="folder of the products  [default: data/runs/<case>]"),
        "set": click.option("--set", "overrides", multiple=True, metavar="A.B=V",
                            help="override one setting, e.g. multibody.duration=\"0.1 s\"; may be repeated"),
        "from": click.option("--from", "first", metavar="STAGE",
                             help="start here; earlier products are used as they are"),
        "until": click.option("--until", "last", metavar="STAGE", help="stop after this stage"),
        "force": click.option("--force", multiple=True, metavar="STAGE", help="compute this stage even if up to date"),
        "again": click.option("--force", "again", is_flag=True, help="compute even if up to date"),
        "dry": click.option("--dry-run", is_flag=True, help="show what would be computed and why; compute nothing"),
        "workers": click.option("--workers", type=click.IntRange(1), metavar="N", envvar="BRAKECHAIN_WORKERS",
                                show_envvar=True, help="processes for independent tasks  [default: one per core]"),
        "scheduler": click.option("--scheduler", metavar="ADDRESS",
                                  help="use the Dask cluster at this address instead"),
        "debug": click.option("--debug", is_flag=True, expose_value=False, help="show the traceback of an error"),
    }

    def decorate(function):
        for name in reversed(which):
            function = table[name](function)
        return function

    return decorate

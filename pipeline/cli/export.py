"""Command 'data export': the channels of a recording as a file that other programs read."""

from pathlib import Path

import click

from pipeline.cli.options import options

#: suffix of a file -> what it is
KINDS = {".uff": "universal file (58b)", ".unv": "universal file (58b)", ".wav": "sound, 24 bits",
         ".csv": "text table", ".h5": "plain HDF5"}


@click.command("export")
@click.argument("recording", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--run", "name", metavar="RUN", help="run to export  [default: the only one]")
@click.option("--channels", metavar="A,B", help="channels to export  [default: all]")
@click.option("--full-scale", type=float, help="value at full scale of a sound file  [default: the largest sample]")
@options("debug")
def export(recording, file, name, channels, full_scale):
    """Write a run of RECORDING (a product recording.h5) to FILE: .uff, .wav, .csv or .h5 in plain HDF5."""
    from pipeline.contract import store
    from pipeline.products import Recording

    run, kind = _chosen(store.read(Recording, recording).runs, name, channels, recording), _kind(file)
    _WRITERS[kind](file, run, full_scale)
    left_out = [] if kind in (".uff", ".unv") else list(run.frf)
    click.echo(f"{file}: {', '.join([*run.channels, *([] if left_out else run.frf)])}"
               + (f"; not written, frequency responses: {', '.join(left_out)}" if left_out else ""))


def _kind(file):
    from pipeline.contract import ConfigError

    if file.suffix.lower() not in KINDS:
        raise ConfigError(file, f"a name that ends in {', '.join(KINDS)}", repr(file.suffix))
    return file.suffix.lower()


def _chosen(runs, name, channels, recording):
    """The Run of this name with these channels alone."""
    from dataclasses import replace

    from pipeline.contract import ConfigError

    name = name or (next(iter(runs)) if len(runs) == 1 else None)
    if name not in runs:
        raise ConfigError(f"{recording}: --run", f"one of {', '.join(runs)}", repr(name) if name else "none")
    run, wanted = runs[name], [c.strip() for c in (channels or "").split(",") if c.strip()]
    strange = set(wanted) - set(run.channels)
    if strange:
        raise ConfigError(f"{recording}: --channels", f"some of {', '.join(run.channels)}", ", ".join(sorted(strange)))
    return replace(run, channels={c: run.channels[c] for c in wanted or run.channels}, frf={} if wanted else run.frf)


def _as_uff(file, run, _):
    from pipeline.recordings.uff_writer import write_uff

    write_uff(file, run)


def _as_sound(file, run, full_scale):
    from pipeline.contract import ConfigError
    from pipeline.recordings.audio import write_audio
    from pipeline.recordings.samples import with_gaps

    begins = {float(c.begin) for c in run.channels.values()}
    if len(begins) > 1:
        raise ConfigError(file, "channels that begin at one instant", f"{min(begins):.9g} s to {max(begins):.9g} s",
                          "choose some of them, or cut the run in its case where all are")
    largest = max((abs(c.samples).max() for c in run.channels.values()), default=0.0)
    write_audio(file, {n: (with_gaps(c), float(c.rate)) for n, c in run.channels.items()}, full_scale or largest or 1.0)


def _as_table(file, run, _):
    from pipeline.contract import ConfigError
    from pipeline.recordings.columns import write_table

    if not run.channels:
        raise ConfigError(file, "a run with channels", "none")
    write_table(file, run.channels)


def _as_neutral(file, run, _):
    from pipeline.recordings.sep005 import save, signals_of

    save(signals_of(run), file, description=str(run.description))


_WRITERS = {".uff": _as_uff, ".unv": _as_uff, ".wav": _as_sound, ".csv": _as_table, ".h5": _as_neutral}

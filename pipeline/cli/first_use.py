"""The command 'compile': what would cost the first run a minute, once for this user and machine."""

import tempfile
import time
from pathlib import Path

import click

import stages
from pipeline.cli.options import options

#: a brake of a few elements at one operating point, the settings of 'new --quick' otherwise
_SMALLEST = ("structure.pressures=[3 MPa]", "complex_modes.speeds=[10 rad/s]", "complex_modes.friction_steps=2",
             "limit_cycle.duration=3 ms", "limit_cycle.window=1 ms")


@click.command("compile")
@options("debug")
def compiled():
    """Compile, once for this user and machine, what a first run of a brake would compile: about a minute.

    'make setup' does it. Compiled code is kept in ~/.cache/brakechain and made anew where sources change.
    """
    from pipeline.cli.new_case import quick_text, text
    from pipeline.contract import Context, case, runner
    from pipeline.physics.numerics import sparse_solver

    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        whole, quick = (Path(folder) / name for name in ("brake.yaml", "brake_quick.yaml"))
        whole.write_text(text(whole, {}), encoding="utf-8")
        quick.write_text(quick_text(whole), encoding="utf-8")
        smallest = case.load(quick, stages.CHAINS, stages.load, _SMALLEST)
        run = runner.ChainRun(smallest, Path(folder) / "run", sparse_solver.available()[0])
        run.execute(Context(solver=run.solver), last="limit_cycle")
    click.echo(f"compiled, and a brake of a few elements computed, in {time.monotonic() - begin:.0f} s")

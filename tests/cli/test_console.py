"""Lines beside the bars: notes are told in a pipe too, other lines on a terminal alone."""

import io

import pytest
from rich.console import Console

from pipeline.cli.console import Bars, RunContext

LONG = "matrices.stiffness.K: k.mtx " + "is taken as it stands " * 10


@pytest.mark.parametrize("terminal", [True, False], ids=["terminal", "pipe"])
def test_notes_are_told_in_a_pipe_too(terminal):
    shown = io.StringIO()
    context = RunContext(bars=Bars(Console(file=shown, force_terminal=terminal, width=80)))
    context.log("an aside")
    context.note(f"{LONG}[/1]")
    lines = shown.getvalue().splitlines()
    assert ("an aside" in lines) == terminal
    assert " ".join(line.strip() for line in lines).endswith(f"note: {LONG}[/1]")
    assert terminal or len(lines) == 1

"""Lines beside the bars: what a stage says reaches a pipe too, each in one line; remarks are told apart."""

import io

import pytest
from rich.console import Console

from pipeline.cli.console import Bars, RunContext

LONG = "matrices.stiffness.K: k.mtx [line]: " + "is taken as it stands " * 10


@pytest.mark.parametrize("terminal", [True, False], ids=["terminal", "pipe"])
def test_what_is_said_is_told_in_a_pipe_too(terminal):
    shown = io.StringIO()
    context = RunContext(bars=Bars(Console(file=shown, force_terminal=terminal, width=80, color_system=None)))
    context.log("2 runs: early, late")
    context.remark(f"{LONG}[/1]")
    lines = shown.getvalue().splitlines()
    assert lines[0] == "2 runs: early, late"
    assert " ".join(line.strip() for line in lines).endswith(f"note: {LONG}[/1]")
    assert terminal or len(lines) == 2

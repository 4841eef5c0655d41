"""What a run says on a terminal and in a pipe."""

import io

from rich.console import Console

from pipeline.cli.console import Bars, RunContext


def said(terminal):
    """What reaches a console of 60 letters."""
    stream = io.StringIO()
    context = RunContext(bars=Bars(Console(file=stream, force_terminal=terminal, width=60, color_system=None)))
    context.log("2 runs: early, late")
    context.remark("a.mf4: [line]: 38400 of 153600 samples are missing: the file marks them as invalid")
    return stream.getvalue()


def test_remarks_are_said_in_a_pipe_in_one_line_each():
    assert said(False) == "a.mf4: [line]: 38400 of 153600 samples are missing: the file marks them as invalid\n"


def test_a_terminal_shows_more():
    assert "2 runs: early, late" in said(True) and "38400 of 153600" in said(True).replace("\n", " ")

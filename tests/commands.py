"""Commands as a user types them, run in this process: only what a process is needed for is worth the start of one."""

import io
import os
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

from pipeline.cli.main import main

ROOT = Path(__file__).parents[1]


class _Text(io.TextIOWrapper):
    """A stream of text that takes bytes as well, as that of a process does."""

    def __init__(self):
        super().__init__(io.BytesIO(), encoding="utf-8", write_through=True)

    def told(self):
        return self.buffer.getvalue().decode()


def brakechain(*args, code=0, cwd=ROOT):
    """What a command prints, which must exit with ``code`` (None = with any): a CompletedProcess of texts."""
    command = ["brakechain", *map(str, args)]
    with redirect_stdout(_Text()) as out, redirect_stderr(_Text()) as err, chdir(cwd), \
            mock.patch.object(sys, "argv", command), mock.patch.dict(os.environ):
        try:
            main()
        except SystemExit as stop:
            found = stop.code or 0
    return _checked(subprocess.CompletedProcess(command, found, out.told(), err.told()), code)


def _checked(done, code):
    assert code is None or done.returncode == code, done.stdout + done.stderr
    return done

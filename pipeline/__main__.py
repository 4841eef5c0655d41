"""Entry point of ``brakechain`` and ``python -m pipeline``."""

import os

from pipeline.environment import ONE_THREAD


def main():
    """Fix the numerical environment, then hand over to the command line (numpy loads after this)."""
    os.environ.update(ONE_THREAD)
    from pipeline.cli.main import main as command_line

    command_line()


if __name__ == "__main__":
    main()

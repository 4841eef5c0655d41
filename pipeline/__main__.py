"""Entry point of ``brakechain`` and ``python -m pipeline``."""

import gc

from pipeline.environment import fix


def main():
    """Fix the numerical environment, then hand over to the command line (numpy loads after this)."""
    fix()
    gc.set_threshold(100_000)       # modules and settings stay: looking through them again and again costs .1 s
    from pipeline.cli.main import main as command_line

    command_line()


if __name__ == "__main__":
    main()

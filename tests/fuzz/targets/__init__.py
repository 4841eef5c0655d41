"""What is fuzzed: every reader, cases, quantities and products."""

from importlib import import_module

_FILES = ("tables", "vectors", "bench_files", "models", "cases", "products")


def all_targets():
    """{name: Target}, made when asked for: it loads every reader."""
    return {target.name: target for name in _FILES for target in import_module(f"{__name__}.{name}").TARGETS}

"""What is fuzzed: every reader, cases, quantities and products."""

import warnings
from functools import cache
from importlib import import_module

import stages
from pipeline.contract.units import to_si

#: what readers load at their first file: once in the parent, and not in every child
_LOADED = ("asammdf", "meshio", "nptdms", "pint", "pyuff", "scipy.io", "scipy.ndimage", "scipy.sparse.csgraph",
           "scipy.spatial", "soundfile", "SurfaceTopography", "pipeline.physics.fem.reference_cells")
_FILES = ("tables", "vectors", "bench_files", "models", "cases", "products", "trial_sets",
          "meanings")


@cache
def all_targets():
    """{name: Target}, made when asked for: it loads every reader."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in _LOADED:
            import_module(name)
    to_si("1 furlong/fortnight", "m/s", "")     # pint makes its registry
    for name in stages.NAMES:
        stages.load(name).settings()
    return {target.name: target for name in _FILES for target in import_module(f"{__name__}.{name}").TARGETS}

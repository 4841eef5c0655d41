"""What fixes the bits: one thread per process, one code path of MKL, and compiled code that belongs to its source."""

import os
from pathlib import Path

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1",
              "MKL_CBWR": "AUTO"}
CACHE = "NUMBA_CACHE_DIR"
#: names of numba's locators of compiled code; ours comes first
LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
_LOCATORS = ("pipeline.physics.numerics.compiled_cache.SourceLocator", "UserProvidedCacheLocator", "InTreeCacheLocator",
             "UserWideCacheLocator")


def own_compiled_code(environment=os.environ):
    """Keep the code that numba compiles in a folder of the user, each file's by the state of its sources.

    A folder or locators that the user names are kept. Must come before numba is loaded.
    """
    environment.setdefault(LOCATORS, ",".join(_LOCATORS))
    if CACHE in environment:
        return
    home = Path(environment.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "brakechain"
    try:
        (home / "compiled").mkdir(parents=True, exist_ok=True)
    except OSError:
        return      # numba then finds a place of its own
    environment[CACHE] = str(home / "compiled")

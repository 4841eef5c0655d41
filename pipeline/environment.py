"""What makes results reproducible to the bit: one thread per process, one code path of MKL; the cache of kernels."""

import os
from pathlib import Path

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1",
              "MKL_CBWR": "AUTO"}
CACHE = "NUMBA_CACHE_DIR"
#: numba's locators of compiled code, ours first
LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
_LOCATORS = ("pipeline.physics.numerics.compiled_cache.SourceLocator", "UserProvidedCacheLocator", "InTreeCacheLocator",
             "UserWideCacheLocator")


def use_compiled_cache(environment=os.environ):
    """Cache compiled code in a folder of the user, keyed by the state of its sources.

    A folder or locators that the user names are left as they are. Must be called before numba is loaded.
    """
    environment.setdefault(LOCATORS, ",".join(_LOCATORS))
    if CACHE in environment:
        return
    home = Path(environment.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "brakechain"
    try:
        (home / "compiled").mkdir(parents=True, exist_ok=True)
    except OSError:
        return      # numba then chooses a folder itself
    environment[CACHE] = str(home / "compiled")

"""What makes results reproducible to the bit: one thread per process, one code path of MKL; the cache of kernels."""

import ctypes
import os
import sys
from contextlib import suppress
from pathlib import Path

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1",
              "MKL_CBWR": "AUTO"}
#: nothing in the folder where a process starts is imported: modules there may be named like ours or any other; nor
#: does HDF5 load a library that a file asks for
SAFE = {"PYTHONSAFEPATH": "1", "HDF5_PLUGIN_PRELOAD": "::"}
#: what glibc's malloc does with freed memory, by the names of variables and by mallopt's numbers: arrays of up to 32 MB
#: are made of memory freed before, of which it keeps up to 512 MB; else each is new to the kernel, a tenth of the time
_MALLOC = {("MALLOC_MMAP_THRESHOLD_", -3): 32 << 20, ("MALLOC_TRIM_THRESHOLD_", -1): 512 << 20}
FREED_MEMORY = {name: str(size) for (name, _), size in _MALLOC.items()}
_ROOT = Path(__file__).resolve().parents[1]
CACHE = "NUMBA_CACHE_DIR"
#: numba's locators of compiled code, ours first
LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
_LOCATORS = ("pipeline.physics.numerics.compiled_cache.SourceLocator", "UserProvidedCacheLocator", "InTreeCacheLocator",
             "UserWideCacheLocator")


def of_children(environment=os.environ):
    """Variables of a process of our own: one thread, and its modules from where this one has them."""
    paths = (str(_ROOT), *filter(None, environment.get("PYTHONPATH", "").split(os.pathsep)))
    return {**environment, **ONE_THREAD, **SAFE, **FREED_MEMORY, "PYTHONPATH": os.pathsep.join(paths)}


def fix(environment=os.environ, path=sys.path):
    """Fix the environment of this process and of those that it starts; called before anything heavy is loaded.

    The current folder, which ``python -m`` puts first on the ``path`` of modules, is taken from it unless it is ours.
    """
    environment.update(ONE_THREAD | SAFE | FREED_MEMORY)
    with suppress(AttributeError, OSError, TypeError):      # the C library of this system may have no such function
        mallopt = ctypes.CDLL(None).mallopt
        for (_, number), size in _MALLOC.items():
            mallopt(number, size)
    here = Path.cwd()
    if here != _ROOT:
        path[:] = [folder for folder in path if folder and Path(folder).absolute() != here]


def user_folder(environment=os.environ):
    """Folder of the user for what can be computed again."""
    return Path(environment.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "brakechain"


def use_compiled_cache(environment=os.environ):
    """Cache compiled code in a folder of the user, keyed by the state of its sources.

    A folder or locators that the user names are left as they are. Must be called before numba is loaded.
    """
    environment.setdefault(LOCATORS, ",".join(_LOCATORS))
    if CACHE in environment:
        return
    home = user_folder(environment)
    try:
        (home / "compiled").mkdir(parents=True, exist_ok=True)
    except OSError:
        return      # numba then chooses a folder itself
    environment[CACHE] = str(home / "compiled")

"""What fixes the bits: one thread per process, one code path of MKL, and compiled code that belongs to its source."""

import hashlib
import os
from pathlib import Path

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1",
              "MKL_CBWR": "AUTO"}
CACHE = "NUMBA_CACHE_DIR"


def own_compiled_code(environment=os.environ):
    """Keep the code that numba compiles in a folder of this state of its sources, unless the user names one.

    numba renews a compiled function when its own file changes, but not when a function that it calls changes in
    another file; old code would then go on running. Must come before numba is loaded.
    """
    if CACHE in environment:
        return
    home = Path(environment.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "brakechain"
    folder = home / f"compiled-{state_of(Path(__file__).parent)}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return      # numba then finds a place of its own
    environment[CACHE] = str(folder)


def state_of(package):
    """Short digest of all files below ``package`` that hold compiled functions."""
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py")):
        source = file.read_bytes()
        if b"njit" in source:
            digest.update(file.name.encode() + source)
    return digest.hexdigest()[:16]

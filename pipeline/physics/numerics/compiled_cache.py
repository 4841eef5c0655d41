"""Where numba caches compiled code: under a digest of all sources that the code was compiled from.

By itself numba recompiles a function when its file changes, but not when a function or a constant changes that it
imports from another file. Here the folder of a file is named after its content and that of all project files that it
imports: a change recompiles what depends on it, and nothing else.
"""

import hashlib
import shutil
from pathlib import Path

from numba import config
from numba.core.caching import _CacheLocator

from pipeline import sources

#: states of one file whose code is kept, the last used ones
_STATES = 8


def state_of(path):
    """Digest of the file ``path`` and of all project files that it imports."""
    module = ".".join(Path(path).relative_to(sources.ROOT).with_suffix("").parts)
    files = sources.files_of(module)
    content = "".join(f"{name} {sources.digest(file)}\n" for name, file in sorted(files.items()))
    return hashlib.sha256(content.encode()).hexdigest()[:16]


def _last_used(folder):
    try:
        return folder.stat().st_mtime
    except FileNotFoundError:       # another process removed it
        return 0.0


class SourceLocator(_CacheLocator):
    """Cache locator of numba (NUMBA_CACHE_LOCATOR_CLASSES) for functions of this project."""

    def __init__(self, py_func, py_file):
        self._py_file, self._line = py_file, py_func.__code__.co_firstlineno
        self._state = state_of(py_file)

    def get_cache_path(self):
        """Folder of the compiled functions of one file in one state."""
        module = ".".join(Path(self._py_file).relative_to(sources.ROOT / "pipeline").with_suffix("").parts)
        return str(Path(config.CACHE_DIR) / f"{module}-{self._state}")

    def ensure_cache_path(self):
        """Make the folder; when it is new, remove those of the states of this file that were not used for longest."""
        path = Path(self.get_cache_path())
        if not path.is_dir():
            others = sorted(path.parent.glob(f"{path.name.rpartition('-')[0]}-*"), key=_last_used)
            for folder in others[:max(0, len(others) + 1 - _STATES)]:
                shutil.rmtree(folder, ignore_errors=True)
        super().ensure_cache_path()     # also writes a file for a moment: the folder's time is that of its last use

    def get_source_stamp(self):
        """Digest of the sources."""
        return self._state

    def get_disambiguator(self):
        """The first line of the function."""
        return str(self._line)

    @classmethod
    def from_function(cls, py_func, py_file):
        """The locator; None for functions outside this project, or if the folder cannot be written."""
        if not config.CACHE_DIR or not Path(py_file).is_relative_to(sources.ROOT / "pipeline"):
            return None
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()
        except OSError:
            return None
        return locator

"""The project files that a module depends on: itself and everything that it imports, transitively."""

import hashlib
import os
import re
from functools import cache
from importlib.util import find_spec
from pathlib import Path

PROJECT = ("pipeline", "stages")
ROOT = Path(__file__).parents[1]
#: an import statement of project modules, at any indentation; names in parentheses may span lines
_IMPORT = re.compile(rf"^[ \t]*(?:import[ \t]+(?P<plain>(?:{'|'.join(PROJECT)})\b[^\n#]*)|"
                     rf"from[ \t]+(?P<module>(?:{'|'.join(PROJECT)})\b[\w.]*)[ \t]+import[ \t]*"
                     r"(?:\((?P<lines>[^)]*)\)|(?P<line>[^\n#]*)))", re.MULTILINE)


@cache
def files_of(module):
    """{module: path} of ``module`` and of every project module that it imports, transitively; not to be changed."""
    files, waiting = {}, [module]
    while waiting:
        name = waiting.pop()
        if name not in files:
            path = file_of(name)
            if path:
                files[name] = path
                waiting += [*imports(path), *listed(name, path)]
    return files


def changed_since(module, instant):
    """True if a file that ``module`` depends on was written after ``instant`` (s since the epoch)."""
    return any(path.stat().st_mtime > instant for path in files_of(module).values())


@cache
def file_of(module):
    """Path of a module or of the ``__init__`` of a package; None where there is none."""
    if module.split(".")[0] in PROJECT:
        path = os.path.join(ROOT, *module.split("."))
        return next((Path(p) for p in (f"{path}/__init__.py", f"{path}.py") if os.path.isfile(p)), None)
    try:
        spec = find_spec(module)
    except (ModuleNotFoundError, AttributeError):
        return None
    return Path(spec.origin) if spec and spec.origin and spec.has_location else None


@cache
def imports(path):
    """Project modules named in the import statements of a file, also inside functions; with names of their contents."""
    names = set()
    for match in _IMPORT.finditer(path.read_text(encoding="utf-8")):
        if match["plain"]:
            names.update(_words(match["plain"]))
        else:
            listed_names = re.sub(r"#[^\n]*", "", match["line"] if match["lines"] is None else match["lines"])
            names.update({match["module"], *(f"{match['module']}.{n}" for n in _words(listed_names))})
    return tuple(n for n in sorted(names) if n != "stages")


def _words(names):
    """Imported names in ``a, b as c``, without their aliases."""
    return [part.split()[0] for part in names.split(",") if part.split()]


@cache
def listed(name, path):
    """Modules of a package that loads them by name: a catalogue, which has no import statements for them."""
    if path.name != "__init__.py" or name == "stages" or "import_module(" not in path.read_text(encoding="utf-8"):
        return ()
    files = (f.relative_to(path.parent).with_suffix("") for f in sorted(path.parent.rglob("*.py")))
    return tuple(".".join((name, *f.parts)).removesuffix(".__init__") for f in files)


def digest(path):
    """SHA-256 of one file."""
    name = os.fspath(path)
    status = os.stat(name)
    return _digest(name, status.st_mtime_ns, status.st_size)


@cache
def _digest(path, _modified, _size):
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()

"""What decides whether a stage must run again: settings, inputs' content, solver and code."""

import hashlib
import re
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from pipeline.contract.settings import leaves

_PROJECT = ("pipeline", "stages")
_ROOT = Path(__file__).parents[2]
#: an import statement of project modules, wherever it stands; names may go on over lines in parentheses
_IMPORT = re.compile(rf"^[ \t]*(?:import[ \t]+(?P<plain>(?:{'|'.join(_PROJECT)})\b[^\n#]*)|"
                     rf"from[ \t]+(?P<module>(?:{'|'.join(_PROJECT)})\b[\w.]*)[ \t]+import[ \t]*"
                     r"(?:\((?P<lines>[^)]*)\)|(?P<line>[^\n#]*)))", re.MULTILINE)


@dataclass(frozen=True)
class Fingerprint:
    """Everything that a stage's output depends on, in a form that JSON keeps."""

    version: int        # of the product written
    solver: str
    settings: dict      # dotted key -> value; files by their SHA-256
    inputs: dict        # argument -> [product, content hash]
    code: dict          # module -> SHA-256
    case: str           # SHA-256 of the whole YAML for a stage that reads it, else ""


def reasons(before, now):
    """Why ``now`` differs from the stored ``before`` (a dict or None), one phrase each."""
    if before is None:
        return ["not computed yet"]
    told = [f"{name} {before.get(name)} -> {getattr(now, name)}" for name in ("version", "solver")
            if before.get(name) != getattr(now, name)]
    settings, code = before.get("settings", {}), before.get("code", {})
    told += [_setting(key, settings.get(key), now.settings.get(key)) for key in _changed(settings, now.settings)]
    told += [f"input {key} changed" for key in _changed(before.get("inputs", {}), now.inputs)]
    told += [f"code {', '.join(_changed(code, now.code))} changed"] if code != now.code else []
    if before.get("case") != now.case and not told:
        told.append("the case file changed")
    return told


def _changed(before, now):
    return [key for key in {**before, **now} if before.get(key) != now.get(key)]


def _setting(key, before, now, most=60):
    """'setting duration: 0.3 -> 0.1', or only that it changed where the values are long."""
    values = f"{before} -> {now}"
    return f"setting {key}: {values}" if len(values) <= most else f"setting {key} changed"


def settings_of(section):
    """Dotted settings in JSON form; a file stands as the digest of its content."""
    return {key: _plain(value) for key, value, _, _ in leaves(section)}


def _plain(value):
    if isinstance(value, Path):
        return f"file {digest(value)[:16]}"
    if isinstance(value, (tuple, list)):
        return [_plain(v) for v in value]
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    return value


def digest(path):
    """SHA-256 of one file."""
    stat = Path(path).stat()
    return _digest(Path(path), stat.st_mtime_ns, stat.st_size)


@cache
def _digest(path, _modified, _size):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def code_of(module):
    """{module: SHA-256} of ``module`` and of every project module that it imports, transitively."""
    return dict(sorted((name, digest(path)) for name, path in _reach(module).items()))


def _reach(module):
    found, waiting = {}, [module]
    while waiting:
        name = waiting.pop()
        if name not in found:
            path = _file(name)
            if path:
                found.update({name: path, **_package_data(name, path)})
                waiting += _imports(path) + _listed(name, path)
    return found


def _package_data(name, path):
    """Files that belong to a package and are no Python: templates, tables."""
    if path.name != "__init__.py":
        return {}
    files = [f for f in path.parent.glob("templates/*") if f.is_file()]
    return {f"{name}/{f.name}": f for f in files}


@cache
def _file(name):
    if name.split(".")[0] in _PROJECT:
        module = _ROOT.joinpath(*name.split("."))
        return next((p for p in (module / "__init__.py", module.with_suffix(".py")) if p.is_file()), None)
    try:
        spec = find_spec(name)
    except (ModuleNotFoundError, AttributeError):
        return None
    return Path(spec.origin) if spec and spec.origin and spec.has_location else None


def _listed(name, path):
    """Modules of a package that loads them by name: a catalogue, of which no import statement tells."""
    if path.name != "__init__.py" or name == "stages" or "import_module(" not in path.read_text(encoding="utf-8"):
        return []
    files = (f.relative_to(path.parent).with_suffix("") for f in sorted(path.parent.rglob("*.py")))
    return [".".join((name, *f.parts)).removesuffix(".__init__") for f in files]


@cache
def _imports(path):
    """Project modules named in the import statements of a file, wherever they stand in it."""
    names = set()
    for match in _IMPORT.finditer(path.read_text(encoding="utf-8")):
        if match["plain"]:
            names.update(_words(match["plain"]))
        else:
            listed = re.sub(r"#[^\n]*", "", match["line"] if match["lines"] is None else match["lines"])
            names.update({match["module"], *(f"{match['module']}.{n}" for n in _words(listed))})
    return [n for n in sorted(names) if n.split(".")[0] in _PROJECT and n != "stages"]


def _words(listed):
    """Names in ``a, b as c``: what is imported, not what it is called here."""
    return [part.split()[0] for part in listed.split(",") if part.split()]


def project_digest():
    """SHA-256 over all Python files of the project: two machines with the same value run the same code."""
    sources = sorted(f for name in _PROJECT for f in _file(name).parent.rglob("*.py"))
    return hashlib.sha256("".join(digest(f) for f in sources).encode()).hexdigest()

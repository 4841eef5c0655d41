"""What decides whether a stage must run again: settings, inputs' content, solver and code."""

import hashlib
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from pipeline import sources
from pipeline.contract.received.includes import following
from pipeline.contract.settings import Section, leaves, statements
from pipeline.sources import digest


@dataclass(frozen=True)
class Fingerprint:
    """Everything that a stage's output depends on, in a form that JSON keeps."""

    version: int        # of the product written
    solver: str
    settings: dict      # dotted key -> value; files by their SHA-256
    inputs: dict        # argument -> [product, content hash]
    code: dict          # module -> SHA-256
    case: str           # SHA-256 of the whole YAML for a stage that reads it, else ""


def reasons(stored, current):
    """What differs between the ``stored`` fingerprint (a dict or None) and the ``current`` one, one phrase each."""
    if stored is None:
        return ["not computed yet"]
    changes = [f"{name} {stored.get(name)} -> {getattr(current, name)}" for name in ("version", "solver")
               if stored.get(name) != getattr(current, name)]
    settings, code = stored.get("settings", {}), stored.get("code", {})
    changes += [_setting(key, settings.get(key), current.settings.get(key))
                for key in _changed(settings, current.settings)]
    changes += [f"input {key} changed" for key in _changed(stored.get("inputs", {}), current.inputs)]
    changes += [f"code {', '.join(_changed(code, current.code))} changed"] if code != current.code else []
    if stored.get("case") != current.case and not changes:
        changes.append("the case file changed")
    return changes


def _changed(stored, current):
    return [key for key in {**stored, **current} if stored.get(key) != current.get(key)]


def _setting(key, stored, current, longest=60):
    """'setting duration: 0.3 -> 0.1', or only that it changed if the values are long."""
    values = f"{stored} -> {current}"
    return f"setting {key}: {values}" if len(values) <= longest else f"setting {key} changed"


def settings_of(section):
    """Dotted settings in JSON form, and which of them are stated, where that decides.

    A file is represented by the digest of its content and of those that it includes.
    """
    return {leaf.key: _plain(leaf.value) for leaf in leaves(section)} | dict(statements(section))


def _plain(value):
    if isinstance(value, Path):
        return " ".join(["file", *(digest(file)[:16] for file in (value, *following(value)))])
    if isinstance(value, (tuple, list)):
        return [_plain(v) for v in value]
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    return settings_of(value) if isinstance(value, Section) else value


def code_of(module):
    """{module: SHA-256} of ``module`` and of every project module that it imports, transitively."""
    return {name: digest(path) for name, path in _files_of(module)}


@cache
def _files_of(module):
    """(name, path) of every file that ``module`` depends on, sorted."""
    files = sources.files_of(module)
    data = {name: path for module, file in files.items() for name, path in _package_data(module, file).items()}
    return tuple(sorted((name, os.fspath(path)) for name, path in (files | data).items()))


def _package_data(name, path):
    """Files of a package that are not Python: templates, tables."""
    if path.name != "__init__.py":
        return {}
    files = [f for f in path.parent.glob("templates/*") if f.is_file()]
    return {f"{name}/{f.name}": f for f in files}


def project_digest():
    """SHA-256 over all Python files of the project: two machines with the same value run the same code."""
    files = sorted(f for name in sources.PROJECT for f in (sources.ROOT / name).rglob("*.py"))
    return hashlib.sha256("".join(digest(f) for f in files).encode()).hexdigest()

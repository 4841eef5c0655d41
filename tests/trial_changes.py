"""``python -m tests.trial_changes``: tests of the trial's generators and of the studies where their sources changed.

A group of tests depends on itself, on every module that it imports, transitively, on the cases and on the installed
packages. Once it passes, the digest of all this is recorded; while it stays, there is nothing to run. ``--always`` runs
both groups anyway.
"""

import ast
import hashlib
import json
import subprocess
import sys
from pathlib import Path

import stages
from pipeline import sources

ROOT = Path(__file__).parents[1]
#: folder of tests -> modules that they run without importing them: studies solve cases by the command line
GROUPS = {"tests/blind_trial/generators": (),
          "tests/studies": ("pipeline.__main__", *(f"stages.{name}" for name in stages.NAMES))}
PASSED = ROOT / "tests" / "trial_passed.json"
#: what stands beside the modules
_BESIDE = ("configs/*.yaml", "requirements-dev.lock", "pyproject.toml", "tests/conftest.py")


def files(group):
    """All files, relative to the root, that decide what the tests of a group say, sorted."""
    tests, waiting, modules = set(), sorted((ROOT / group).rglob("*.py")), set(GROUPS[group])
    while waiting:
        path = waiting.pop()
        if path not in tests:
            tests.add(path)
            named = set(_imported(path))
            waiting += filter(None, map(_test_file, sorted(named)))
            modules |= {name for name in named if name.split(".")[0] in sources.PROJECT}
    project = {path for name in modules for path in sources.files_of(name).values()}
    beside = {path for pattern in _BESIDE for path in ROOT.glob(pattern)}
    return sorted(path.relative_to(ROOT) for path in tests | project | beside)


def digest(group):
    """SHA-256 of the names and contents of these files."""
    told = hashlib.sha256()
    for path in files(group):
        told.update(f"{path.as_posix()} {sources.digest(ROOT / path)}\n".encode())
    return told.hexdigest()


def _imported(path):
    """Names of modules and of what is imported from them."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (node.module, *(f"{node.module}.{alias.name}" for alias in node.names))


def _test_file(name):
    """The file of a module of the tests, None for another name."""
    path = ROOT.joinpath(*name.split(".")).with_suffix(".py")
    return path if name.startswith("tests.") and path.is_file() else None


def main(arguments):
    """Run the groups that changed; the exit code of the first that fails."""
    passed = json.loads(PASSED.read_text()) if PASSED.exists() else {}
    more = [argument for argument in arguments if argument != "--always"]
    for group in GROUPS:
        current = digest(group)
        if "--always" not in arguments and passed.get(group) == current:
            print(f"{group}: nothing that it depends on has changed since it passed", flush=True)
            continue
        code = subprocess.call([sys.executable, "-m", "pytest", "-q", "-rs", "-m", "not slow", "-n", "auto", "--dist",
                                "loadfile", *more, group], cwd=ROOT)
        if code:
            return code
        passed[group] = current
        PASSED.write_text(json.dumps(passed, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

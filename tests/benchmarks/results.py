"""Results of the benchmarks as JSON, one file for each commit, and the comparison of two of them."""

import json
import platform
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from pipeline.contract.integrity.origin import git_commit

FOLDER = Path(__file__).parents[2] / "data" / "runs" / "bench"
#: tables of a file, each {name: row}
TABLES = ("kernels", "peers", "stages", "diagnoses")
_FORMAT = 1
_PACKAGES = ("numpy", "scipy", "numba", "exudyn", "scikit-fem", "tamaas", "pypardiso")


def save(tables, folder=FOLDER):
    """Write ``tables`` to the file of the present commit ('+' where files were changed); other tables in it stay."""
    commit = git_commit() or "no_commit"
    file = folder / f"{commit}.json"
    earlier = json.loads(file.read_text()) if file.exists() else {}
    content = {"format": _FORMAT, "commit": commit, "time": datetime.now(UTC).isoformat(timespec="seconds"),
               "processor": _processor(), "python": platform.python_version(),
               "packages": {name: version(name) for name in _PACKAGES},
               **{name: {**earlier.get(name, {}), **tables.get(name, {})} for name in TABLES}}
    folder.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(content, indent=1) + "\n")
    return file


def load(name, folder=FOLDER):
    """Content of a results file, named by its path or by the beginning of its commit."""
    files = [Path(name)] if Path(name).is_file() else sorted(folder.glob(f"{name}*.json"))
    if len(files) != 1:
        known = ", ".join(f.stem for f in sorted(folder.glob("*.json"))) or "none"
        raise SystemExit(f"bench: {name}: expected one results file, found {len(files)}; in {folder}: {known}")
    content = json.loads(files[0].read_text())
    if content.get("format") != _FORMAT:
        raise SystemExit(f"bench: {files[0]}: expected format {_FORMAT}, found {content.get('format')}")
    return content


def comparison(old, new):
    """Lines of a table: CPU seconds of every row that both hold, and how many times as fast the new one is."""
    lines = [f"{'CPU seconds':<34} {old['commit'][:10]:>10} {new['commit'][:10]:>10}  times as fast"]
    for table in TABLES:
        for name, row in new[table].items():
            if name in old[table] and row["work"] == old[table][name]["work"]:
                before, now = old[table][name]["cpu_seconds"], row["cpu_seconds"]
                lines.append(f"{name:<34} {before:10.4f} {now:10.4f}  {before / now:6.2f}")
    return lines


def _processor():
    try:
        names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    except OSError:
        names = []
    return names[0].partition(":")[2].strip() if names else platform.processor()

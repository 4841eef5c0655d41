"""What was tried, run by run, in data/studies/fuzz.csv, and the inputs that once failed, in seeds.yaml."""

import csv
import subprocess
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from tests.fuzz.trial import BAD, GOOD

ROOT = Path(__file__).parents[2]
LEDGER, SEEDS = ROOT / "data" / "studies" / "fuzz.csv", Path(__file__).with_name("seeds.yaml")
KINDS = (*GOOD, *BAD)
HEAD = ("commit", "target", "seed", "first", "tried", *KINDS, "known", "slowest_s", "seconds")


@dataclass
class Row:
    """What one run tried of one target: ``known`` counts the inputs with a known answer."""

    target: str
    seed: int
    first: int
    counts: Counter = field(default_factory=Counter)
    known: int = 0
    slowest: float = 0.0
    seconds: float = 0.0

    @property
    def tried(self):
        return sum(self.counts.values())

    @property
    def failed(self):
        return sum(self.counts[kind] for kind in BAD)

    def cells(self, commit=""):
        """Its cells, by HEAD."""
        return (
            commit,
            self.target,
            self.seed,
            self.first,
            self.tried,
            *(self.counts[kind] for kind in KINDS),
            self.known,
            round(self.slowest, 2),
            round(self.seconds, 1),
        )


def table(rows):
    """Lines of a table of Rows, with their sum."""
    head = ("target", "tried", *KINDS, "known", "slowest s")
    lines = [
        (row.target, row.tried, *(row.counts[kind] for kind in KINDS), row.known, f"{row.slowest:.1f}") for row in rows
    ]
    total = [
        "all",
        *(sum(int(line[k]) for line in lines) for k in range(1, len(head) - 1)),
        f"{max((row.slowest for row in rows), default=0.0):.1f}",
    ]
    return ["  ".join(f"{cell!s:>{14 if k == 0 else 9}}" for k, cell in enumerate(line)) for line in
            (head, *lines, total)]


def next_number(target, seed):
    """The first number of a target that no run of the ledger tried."""
    return max(
        (
            int(row["first"]) + int(row["tried"])
            for row in _rows()
            if row["target"] == target and int(row["seed"]) == seed
        ),
        default=0,
    )


def _rows():
    if not LEDGER.exists():
        return []
    with LEDGER.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def append(rows):
    """Rows to the ledger."""
    new, commit = not LEDGER.exists(), _commit()
    with LEDGER.open("a", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([HEAD] * new + [row.cells(commit) for row in rows])


def _commit():
    done = subprocess.run(
        ["git", "describe", "--always", "--dirty=+", "--exclude=*"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout.strip()


def seeds():
    """[{target, seed, number, kind, said}] of the inputs that once failed."""
    return yaml.safe_load(SEEDS.read_text(encoding="utf-8")) or []


def keep(failures):
    """Inputs that failed, [{target, seed, number, kind, said}], to the seeds; those that are there stay."""
    known = {(s["target"], s["seed"], s["number"]) for s in seeds()}
    fresh = [f for f in failures if (f["target"], f["seed"], f["number"]) not in known]
    with SEEDS.open("a", encoding="utf-8") as file:
        file.writelines(
            "- " + yaml.safe_dump(f, default_flow_style=True, sort_keys=False, width=10**6, allow_unicode=True)
            for f in fresh
        )

"""Answers of the long studies, one row a case, in data/studies: a study goes on where another machine stopped."""

import csv
from dataclasses import dataclass
from pathlib import Path

from pipeline.contract.integrity.origin import git_commit

FOLDER = Path(__file__).parents[2] / "data" / "studies"
COLUMNS = ("case", "hidden", "noise", "left", "verdict", "named", "cpu_seconds", "commit")


@dataclass(frozen=True)
class Ledger:
    """The rows of the CSV file ``path``; of a case that stands there twice the later one counts."""

    path: Path

    def rows(self):
        """{case: {column: text}}, by name of the case."""
        if not self.path.exists():
            return {}
        with self.path.open(newline="", encoding="utf-8") as file:
            return {row["case"]: row for row in sorted(csv.DictReader(file), key=lambda row: row["case"])}

    def add(self, case, hidden, noise, left, answer):
        """Append the row of an answer (verdict, effects, cpu_seconds), at once, beside other processes."""
        named = "; ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
        row = (case, hidden, f"{noise:g}", f"{left:.1f}", answer["verdict"], named, f"{answer['cpu_seconds']:.0f}",
               git_commit()[:10])
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, row] if file.tell() == 0 else [row])

    def tidy(self):
        """Write the file anew, one row a case, in the order of their names."""
        rows = self.rows()
        if rows:
            partial = self.path.with_suffix(".partial")
            with partial.open("w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows.values())
            partial.replace(self.path)


def answer_of(row):
    """{verdict, effects, cpu_seconds} of a row."""
    effects = [dict(zip(("name", "place"), each.split(" at ", 1), strict=True))
               for each in row["named"].split("; ") if each]
    return {"verdict": row["verdict"], "effects": effects, "cpu_seconds": float(row["cpu_seconds"])}

"""A set of cases: a folder that anyone can make, with or without this program.

    cases/NNN/nominal.yaml, recordings.h5     what the solver sees
    truth.json                                {NNN: truth} of an open set, or of a sealed one after its score
    truth.sealed, set.yaml                    of a sealed set: the truth encrypted, and its commitment
    answers/METHOD/NNN.json, answers.json     what ``solve`` left; all of them in one file once there are all
    opened.yaml, result.json, trial.html      what ``score`` and ``show`` left
    errata.yaml                               what was found to be wrong in a published truth, told beside it

Of these only ``cases`` and a truth are needed; set.yaml is written by ``make`` and ``seal``.
"""

import hashlib
import json
from pathlib import Path

from pipeline.contract import documents
from pipeline.contract.errors import ConfigError
from pipeline.contract.store import write_companion

FORMAT = "brakechain-trial/1"
#: what a case is made of
FILES = ("nominal.yaml", "recordings.h5")


class TrialSet:
    """The set in ``folder``: what it says of itself and what lies in it. ConfigError where it is no set."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.about = documents.read_yaml(self.folder / "set.yaml") if (self.folder / "set.yaml").exists() else {}
        if self.about and self.about.get("format") != FORMAT:
            raise ConfigError(self.folder / "set.yaml", f"format: {FORMAT}", repr(self.about.get("format")))

    @property
    def name(self):
        return self.about.get("name", self.folder.resolve().name)

    @property
    def sealed(self):
        return self.about.get("kind") == "sealed"

    @property
    def cases(self):
        """{number: folder}, each with both files; ConfigError where one lacks any."""
        folders = {p.name: p for p in sorted((self.folder / "cases").glob("*")) if p.is_dir()}
        if not folders:
            raise ConfigError(self.folder / "cases", "folders of cases, such as cases/001", "none",
                              "see docs/trial_sets.md")
        for case in folders.values():
            lacks = [name for name in FILES if not (case / name).is_file()]
            if lacks:
                raise ConfigError(case, " and ".join(FILES), f"no {' and no '.join(lacks)}")
        return folders

    def digest(self):
        """SHA-256 over the names of all cases and the bytes of their files."""
        lines = [f"{number}/{name} {sha256((folder / name).read_bytes())}" for number, folder in self.cases.items()
                for name in FILES]
        return sha256("\n".join(lines).encode())

    def path(self, name):
        return self.folder / name

    def has(self, name):
        return self.path(name).exists()

    def read(self, name):
        """A JSON file of the set; ConfigError where it is none."""
        return read_json(self.path(name))

    def read_yaml(self, name):
        """A YAML file of the set."""
        return documents.read_yaml(self.path(name))

    def write(self, name, values):
        """Write values as JSON, or as YAML where the name says so: whole or not at all."""
        text = documents.yaml_text(values) if name.endswith(".yaml") else json.dumps(values, indent=1) + "\n"
        self.path(name).parent.mkdir(parents=True, exist_ok=True)
        write_companion(self.path(name), text)


def read_json(path):
    """Values of a JSON file; ConfigError where there is none."""
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ConfigError(path, "a readable JSON file", str(error)) from None


def sha256(content):
    """SHA-256 of bytes, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def canonical(values):
    """The one text of JSON values that digests are taken of."""
    return json.dumps(values, sort_keys=True, separators=(",", ":")).encode()

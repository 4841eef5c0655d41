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
from contextlib import contextmanager
from pathlib import Path

from pipeline.contract import documents
from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.received import files, names
from pipeline.contract.store import write_companion

FORMAT = "brakechain-trial/1"
#: what a case is made of
FILES = ("nominal.yaml", "recordings.h5")
#: bytes of a JSON file of a set
_MOST = 200_000_000


class TrialSet:
    """The set in ``folder``: what it says of itself and what lies in it. ConfigError where it is no set."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.about = self.read_yaml("set.yaml") if self.has("set.yaml") else {}
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
        folders = {p.name: p for p in sorted(self.path("cases").glob("*")) if p.is_dir()}
        if not folders:
            raise ConfigError(self.folder / "cases", "folders of cases, such as cases/001", "none",
                              "see docs/trial_sets.md")
        names.checked_all(folders, self.folder / "cases")
        for case in folders.values():
            lacks = [name for name in FILES if not files.is_plain(case / name)]
            if lacks or case.is_symlink():
                raise ConfigError(case, " and ".join(FILES), "a link" if not lacks else f"no {' and no '.join(lacks)}")
        return folders

    def digest(self):
        """SHA-256 over the names of all cases and the bytes of their files."""
        lines = [f"{number}/{name} {sha256((folder / name).read_bytes())}" for number, folder in self.cases.items()
                for name in FILES]
        return sha256("\n".join(lines).encode())

    def path(self, name):
        """Path of a file of the set; ConfigError where a name or a link leads out of it."""
        return names.within(self.folder, name)

    def has(self, name):
        return self.path(name).exists()

    def read(self, name):
        """The mapping in a JSON file of the set; ConfigError where it is none."""
        return _mapping(read_json(self.path(name)), self.path(name))

    def read_yaml(self, name):
        """The mapping in a YAML file of the set."""
        return _mapping(documents.read_yaml(self.path(name)), self.path(name))

    def truth(self, file=None):
        """{number: truth} of truth.json, or of another ``file``: numbers are names, truths mappings."""
        path = file or self.path("truth.json")
        return checked_truth(read_json(path), path)

    def write(self, name, values):
        """Write values as JSON, or as YAML where the name says so: whole or not at all."""
        text = documents.yaml_text(values) if name.endswith(".yaml") else json.dumps(values, indent=1) + "\n"
        self.path(name).parent.mkdir(parents=True, exist_ok=True)
        write_companion(self.path(name), text)


@contextmanager
def in_format(folder):
    """What the files of a set that others made lack, or hold otherwise than docs/trial_sets.md says, as ConfigError."""
    try:
        yield
    except (BrakechainError, OSError):
        raise
    except Exception as error:  # whatever their values lead to
        raise ConfigError(folder, "files of a set as docs/trial_sets.md describes them",
                          f"others ({type(error).__name__}: {error})", "correct the files, or solve and score the set"
                          " again") from error


def read_json(path):
    """Values of a JSON file; ConfigError where there is none."""
    try:
        return json.loads(files.read_regular(path, _MOST).decode("utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ConfigError(path, "a readable JSON file", str(error)) from None


def checked_truth(truth, where):
    """A truth {number: mapping}, whose numbers are names of cases; ConfigError at ``where`` for anything else."""
    for number, case in names.checked_all(truth, where).items():
        _mapping(case, f"{where}: {number}")
    return truth


def _mapping(values, where):
    if not isinstance(values, dict):
        raise ConfigError(where, "a mapping", repr(values)[:60])
    return values


def sha256(content):
    """SHA-256 of bytes, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def canonical(values):
    """The one text of JSON values that digests are taken of."""
    return json.dumps(values, sort_keys=True, separators=(",", ":")).encode()

"""The registry of measurements: address, commit, SHA-256, licence; no bytes.

Public ones are in data/measured. They are read from the folder that the environment variable BRAKECHAIN_DATA names;
without it they are downloaded once into the user's cache. A user's own are in ``own_registry`` and stay where they are.
Either way their SHA-256 must match.
"""

import hashlib
import os
import re
from difflib import get_close_matches
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from pipeline.contract.documents import read_yaml, yaml_text
from pipeline.contract.errors import ConfigError
from pipeline.contract.settings import fill
from pipeline.contract.store import write_companion

REGISTRY = Path(__file__).parents[2] / "data" / "measured"


class Entry(BaseModel):
    """One file: a public one, or a user's own, whose address is its path and whose commit is empty."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str       # path below BRAKECHAIN_DATA, e.g. surfaces/plu-1.plu
    address: str
    commit: str
    sha256: str
    licence: str
    content: str
    lacks: str      # what the file does not document

    @property
    def belongs_to(self):
        """Name of its set: its folder."""
        return Path(self.name).parent.name


def own_registry():
    """The document of the user's own sets."""
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "brakechain" / "recordings.yaml"


def entries():
    """name -> Entry of every file in the registry, a user's own behind the public ones."""
    own = own_registry()
    files = {}
    for document in (*sorted(REGISTRY.glob("*.yaml")), *([own] if own.is_file() else [])):
        for values in read_yaml(document)["files"]:
            entry = fill(Entry, values, str(document))
            files[entry.name] = entry
    return files


def of_set(name):
    """[Entry] of the set, or the file, of this name. ConfigError with near names for any other."""
    known = entries()
    members = [known[name]] if name in known else [e for e in known.values() if e.belongs_to == name]
    if members:
        return members
    raise _unknown(f"data {name}", name, known)


def _unknown(where, name, known):
    sets = list(dict.fromkeys(entry.belongs_to for entry in known.values()))
    near = get_close_matches(name, [*sets, *known], 3, 0.5)
    return ConfigError(where, f"a set, or a file of one: {', '.join(sets)}", "an unregistered name",
                       f"did you mean {' or '.join(repr(n) for n in near)}?" if near else
                       "'brakechain data list' lists all; 'brakechain data add' registers one")


def added(files, name, licence, source, lacks):
    """[Entry] of the user's own ``files``, noted as the set ``name``. ConfigError for a name that is taken or none."""
    if not re.fullmatch(r"[A-Za-z0-9][\w-]*", name):
        raise ConfigError("data add --name", "letters, digits, - and _", repr(name))
    if any(entry.belongs_to == name for entry in entries().values()):
        raise ConfigError("data add --name", "a name that no set has", repr(name), "choose another name")
    if len({file.name for file in files}) < len(files):
        raise ConfigError("data add", "files of different names", ", ".join(file.name for file in files))
    new = [Entry(name=f"{name}/{file.name}", address=str(file.resolve()), commit="", sha256=_digest(file),
                 licence=licence, content=source, lacks=lacks) for file in files]
    own = own_registry()
    known = read_yaml(own)["files"] if own.is_file() else []
    own.parent.mkdir(parents=True, exist_ok=True)
    write_companion(own, yaml_text({"files": [*known, *(entry.model_dump() for entry in new)]}))
    return new


def path(name):
    """Local path of the registered file ``name``, verified. Raises ConfigError if it is not available."""
    known = entries()
    if name not in known:
        raise _unknown(f"measured:{name}", name, known)
    entry, mirror = known[name], os.environ.get("BRAKECHAIN_DATA")
    if not entry.commit:
        return _verified(entry, Path(entry.address), "it was moved: put it back, or add it anew under another name")
    return _verified(entry, Path(mirror) / name, "copy it there, or unset BRAKECHAIN_DATA to download it") if (
        mirror) else _downloaded(entry)


def _verified(entry, local, remedy):
    if not local.is_file():
        raise ConfigError(f"measured:{entry.name}", f"a file at {local}", "none", remedy)
    if (digest := _digest(local)) != entry.sha256:
        raise ConfigError(local, f"SHA-256 {entry.sha256}", digest, "the file was changed; fetch it again")
    return local


def _digest(file):
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _downloaded(entry):
    import pooch

    try:
        cache = pooch.os_cache("brakechain") / Path(entry.name).parent
        return Path(pooch.retrieve(entry.address, f"sha256:{entry.sha256}", Path(entry.name).name, cache))
    except Exception as error:  # pooch passes on whatever its downloader raises
        raise ConfigError(f"measured:{entry.name}", f"a download from {entry.address}", str(error),
                          "set BRAKECHAIN_DATA to a folder that holds it") from None

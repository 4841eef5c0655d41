"""The registry of public measurements in data/measured: address, commit, SHA-256, licence; no bytes.

Files are read from the folder that the environment variable BRAKECHAIN_DATA names; without it
they are downloaded once into the user's cache. Either way their SHA-256 must match.
"""

import hashlib
import os
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from pipeline.contract.documents import read_yaml
from pipeline.contract.errors import ConfigError
from pipeline.contract.settings import fill

REGISTRY = Path(__file__).parents[2] / "data" / "measured"


class Entry(BaseModel):
    """One public file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str       # path below BRAKECHAIN_DATA, e.g. surfaces/plu-1.plu
    address: str
    commit: str
    sha256: str
    licence: str
    content: str
    lacks: str      # what the file does not document


def entries():
    """name -> Entry of every file in the registry."""
    files = {}
    for document in sorted(REGISTRY.glob("*.yaml")):
        for values in read_yaml(document)["files"]:
            entry = fill(Entry, values, str(document))
            files[entry.name] = entry
    return files


def path(name):
    """Local path of the registered file ``name``, verified. Raises ConfigError if it is not available."""
    known = entries()
    if name not in known:
        raise ConfigError(f"measured:{name}", f"one of {', '.join(known)}", "an unregistered name")
    entry, mirror = known[name], os.environ.get("BRAKECHAIN_DATA")
    return _mirrored(entry, Path(mirror) / name) if mirror else _downloaded(entry)


def _mirrored(entry, local):
    if not local.is_file():
        raise ConfigError(f"measured:{entry.name}", f"a file at {local}", "none",
                          "copy it there, or unset BRAKECHAIN_DATA to download it")
    with local.open("rb") as stream:
        digest = hashlib.file_digest(stream, "sha256").hexdigest()
    if digest != entry.sha256:
        raise ConfigError(local, f"SHA-256 {entry.sha256}", digest, "the file was changed; fetch it again")
    return local


def _downloaded(entry):
    import pooch

    try:
        cache = pooch.os_cache("brakechain") / Path(entry.name).parent
        return Path(pooch.retrieve(entry.address, f"sha256:{entry.sha256}", Path(entry.name).name, cache))
    except Exception as error:  # pooch passes on whatever its downloader raises
        raise ConfigError(f"measured:{entry.name}", f"a download from {entry.address}", str(error),
                          "set BRAKECHAIN_DATA to a folder that holds it") from None

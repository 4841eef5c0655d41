"""The registry of public measurements in data/measured: address, commit, SHA-256, licence; no bytes.

A file is looked for in the folder that the environment variable BRAKECHAIN_DATA names; without
that variable it is downloaded once into the user's cache. Either way its SHA-256 must match.
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
    lacks: str      # what the file does not say or is not


def entries():
    """name -> Entry of every file in the registry."""
    found = {}
    for document in sorted(REGISTRY.glob("*.yaml")):
        for values in read_yaml(document)["files"]:
            entry = fill(Entry, values, str(document))
            found[entry.name] = entry
    return found


def path(name):
    """Local path of the registered file ``name``, verified; ConfigError where it cannot be had."""
    known = entries()
    if name not in known:
        raise ConfigError(f"measured:{name}", f"one of {', '.join(known)}", "an unregistered name")
    entry, mirror = known[name], os.environ.get("BRAKECHAIN_DATA")
    return _mirrored(entry, Path(mirror) / name) if mirror else _downloaded(entry)


def _mirrored(entry, local):
    if not local.is_file():
        raise ConfigError(f"measured:{entry.name}", f"a file at {local}", "none",
                          "copy it there, or unset BRAKECHAIN_DATA to download it")
    found = hashlib.sha256(local.read_bytes()).hexdigest()
    if found != entry.sha256:
        raise ConfigError(local, f"SHA-256 {entry.sha256}", found, "the file was changed; fetch it again")
    return local


def _downloaded(entry):
    import pooch

    try:
        cache = pooch.os_cache("brakechain") / Path(entry.name).parent
        return Path(pooch.retrieve(entry.address, f"sha256:{entry.sha256}", Path(entry.name).name, cache))
    except Exception as error:  # pooch passes on whatever its downloader raises
        raise ConfigError(f"measured:{entry.name}", f"a download from {entry.address}", str(error),
                          "set BRAKECHAIN_DATA to a folder that holds it") from None

"""Sealing: the truth encrypted with a key that lies elsewhere, and a commitment to it. The door of cryptography.

The commitment is SHA-256(salt || truth), truth as canonical JSON; a salt of 32 random bytes keeps anyone from trying
truths. Salt and truth are encrypted together by Fernet (AES-128-CBC and HMAC-SHA-256): what was changed does not open.
"""

import json
import os
import secrets
from pathlib import Path

from cryptography.fernet import Fernet, InvalidToken

from pipeline.blind_trial.protocol.case_set import canonical, sha256
from pipeline.contract.errors import ConfigError

_SALT = 32


def commitment(salt, truth):
    """SHA-256 of the salt (hexadecimal) and the truth {case: truth}."""
    return sha256(bytes.fromhex(salt) + canonical(truth))


def sealed(truth, key):
    """(bytes, commitment) of a truth under a key and a fresh salt."""
    salt = secrets.token_hex(_SALT)
    return locked({"salt": salt, "truth": truth}, key), commitment(salt, truth)


def locked(values, key):
    """JSON values encrypted."""
    return _cipher(key).encrypt(json.dumps(values).encode())


def unlocked(content, key, where):
    """JSON values of encrypted ``content``; ConfigError where the key is not theirs."""
    try:
        return json.loads(_cipher(key).decrypt(content))
    except InvalidToken:
        raise ConfigError(where, "what this key opens", "another key, or a file that was changed",
                          "give the key that was written when the set was made") from None


def _cipher(key):
    try:
        return Fernet(key)
    except ValueError:
        raise ConfigError("key", "32 bytes in the Base64 of URLs, as trial make writes them",
                          f"{len(key)} characters") from None


def key_path(folder, given=None):
    """Where the key of the set in ``folder`` lies: as given, or in the user's data folder by the set's name.

    Never inside the set, nor inside a Git repository, from where it would be published with it.
    """
    home = Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "brakechain" / "keys"
    path = Path(given or home / f"{Path(folder).resolve().name}.key").resolve()
    if Path(folder).resolve() in path.parents:
        raise ConfigError("--key", "a file outside the set", str(path), "whoever has the set must not have the key")
    for parent in path.parents:
        if (parent / ".git").exists():
            raise ConfigError("--key", "a file outside every Git repository", f"{path} in {parent}",
                              "it would be published with it")
    return path


def new_key(path):
    """A fresh key, written where only its owner reads it; ConfigError where one lies there already."""
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise ConfigError("--key", "a file that is not there yet", str(path),
                          "it may be the only key of another set: name a new file") from None
    key = Fernet.generate_key()
    with os.fdopen(handle, "wb") as stream:
        stream.write(key + b"\n")
    return key


def read_key(path):
    """The key in a file; ConfigError where there is none."""
    try:
        return Path(path).read_bytes().strip()
    except OSError:
        raise ConfigError("--key", f"the key of the set at {path}", "none",
                          "give the file that trial make or trial seal wrote") from None

"""What a run folder holds, file by file."""

import hashlib

from pipeline.contract import store


def everything(folder):
    """{file: digest} of products, by what they hold (None of damaged ones), and of what stands beside them, byte for
    byte; hidden files are left out."""
    digests = {}
    for path in folder.glob("[!.]*"):
        if path.suffix == ".h5":
            identity = store.identity(path)
            digests[path.name] = identity and identity[2]
        elif path.is_file():
            digests[path.name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return digests

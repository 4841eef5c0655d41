"""What decides the answers and the score of a trial: code, catalogue, thresholds, packages."""

from dataclasses import asdict
from importlib import metadata
from pathlib import Path

from pipeline import __version__, effects
from pipeline.blind_trial.protocol.case_set import canonical, sha256
from pipeline.contract.fingerprint import digest
from pipeline.contract.integrity.origin import git_commit
from pipeline.inference.rules import DEFAULTS

_ROOT = Path(__file__).parents[3]
#: what only makes truths, or shows what was found
_APART = ("pipeline/blind_trial/generators/", "pipeline/views/", "pipeline/cli/")
#: what comes after the answers
#: (pipeline/concealed: their name in the records of sets up to sealed_3)
_AFTER = ("pipeline/blind_trial/protocol/", "pipeline/blind_trial/metrics/", "pipeline/concealed/")
_PACKAGES = ("numpy", "scipy", "numba", "h5py")


def files():
    """{file: SHA-256} of what decides answers and scores."""
    paths = sorted(path for name in ("pipeline", "stages") for path in (_ROOT / name).rglob("*.py"))
    named = ((path.relative_to(_ROOT).as_posix(), path) for path in paths)
    return {name: digest(path) for name, path in named if not name.startswith(_APART)}


def of_answers(code):
    """Digest of the part of ``files()`` that decides answers."""
    return sha256(canonical({name: digest for name, digest in code.items() if not name.startswith(_AFTER)}))


def changed(before, now):
    """Names of the files that differ."""
    return [name for name in sorted({**before, **now}) if before.get(name) != now.get(name)]


def described():
    """What a set records with its commitment, beside the digests of ``files()``."""
    return {"version": __version__, "commit": git_commit(), "catalogue": [e.name for e in effects.CATALOGUE],
            "thresholds": asdict(DEFAULTS), "packages": {name: metadata.version(name) for name in _PACKAGES}}

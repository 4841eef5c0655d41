"""Files of a published trial set, which anyone may have written."""

import json
import shutil
import tempfile
from functools import cache
from pathlib import Path

import yaml

from pipeline.blind_trial.metrics.summary import lines
from pipeline.blind_trial.protocol import making, sealing, solving
from pipeline.blind_trial.protocol.scoring import score
from pipeline.blind_trial.protocol.verifying import verify
from pipeline.contract.executors import InProcess
from tests.blind_trial.protocol.small_set import TOLD, small_set
from tests.fuzz.documents import reshaped
from tests.fuzz.mutation import draw, garbled
from tests.fuzz.trial import Target, Trial

_SEALED = ("set.yaml", "truth.json", "truth.sealed", "code.json", "answers.json", "opened.yaml", "result.json")
_OPEN = ("truth.json", "answers.json")


@cache
def _files(sealed):
    """{name: bytes} of a small set of three cases: sealed and scored, or open and solved."""
    answered, solving.answered = solving.answered, lambda case, method, limit: {**TOLD[case.name], "cpu_seconds": 1.0}
    try:
        with tempfile.TemporaryDirectory() as folder:
            key, made = Path(folder) / "a.key", small_set(Path(folder) / "set")
            if sealed:
                sealing.new_key(key)
                making.seal(made, lambda: sealing.read_key(key))
            solving.solve(made, InProcess())
            if sealed:
                score(made, key)
            return {
                str(path.relative_to(made)): path.read_bytes() for path in sorted(made.rglob("*")) if path.is_file()
            }
    finally:
        solving.answered = answered


def _verified(path, name):
    return [*verify(_laid_out(path, name, True))]


def _scored(path, name):
    return lines(score(_laid_out(path, name, False)))


def _laid_out(path, name, sealed):
    """The folder of a set in which the file at ``path`` is called ``name``."""
    folder = path.parent / "set"
    shutil.rmtree(folder, ignore_errors=True)
    for file, content in _files(sealed).items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_bytes(content)
    (folder / name).write_bytes(path.read_bytes())
    return folder


def _changed(rng, name, sealed):
    content = _files(sealed)[name]
    if name.endswith(".sealed") or rng.random() < 0.3:
        return garbled(rng, content)
    values = yaml.safe_load(content) if name.endswith(".yaml") else json.loads(content)
    values = reshaped(rng, values)
    try:
        return json.dumps(values).encode()  # which is YAML too
    except TypeError:
        return repr(values).encode("utf-8", "replace")


def _verify_damaged(rng):
    name = draw(rng, _SEALED)
    return Trial("file", _changed(rng, name, True), given={"name": name})


def _score_damaged(rng):
    name = draw(rng, _OPEN)
    return Trial("file", _changed(rng, name, False), given={"name": name})


def _verify_value(rng):
    """A true value, an answer or a rate that was changed after the fact is found."""
    name = draw(rng, ("truth.json", "answers.json", "result.json"))
    values = json.loads(_files(True)[name])
    places = [(node, key) for node, key in _leaves(values) if key not in ("digest",)]
    node, key = draw(rng, places)
    node[key] = node[key] + 1 if isinstance(node[key], int | float) and not isinstance(node[key], bool) else "changed"
    return Trial("file", json.dumps(values).encode(), f"a value of {name} changed", {"name": name}, must="refuse")


def _leaves(node):
    for key in list(node) if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ():
        if isinstance(node[key], dict | list):
            yield from _leaves(node[key])
        else:
            yield node, key


def _verify_whole(rng):
    return Trial(
        "file",
        _files(True)["truth.json"],
        "set as it was published",
        {"name": "truth.json"},
        lambda value: "" if len(value) == 6 else str(value),
        "read",
    )


TARGETS = (
    Target("verify set", _verified, _verify_damaged, (_verify_whole, _verify_value, _verify_value)),
    Target("score set", _scored, _score_damaged),
)

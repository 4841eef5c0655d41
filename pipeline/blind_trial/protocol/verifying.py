"""Verifying a published set: that truth, key, commitment, answers and result belong together."""

import json
import math

from pipeline.blind_trial.protocol import code_digest, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, sha256
from pipeline.blind_trial.protocol.scoring import check_commitment, scored_as
from pipeline.contract.errors import ConfigError

#: how far recomputed numbers may lie from published ones: interval bounds of sealed_2 and sealed_3 took z = 1.96, and
#: other processors round otherwise
_AGREE = 1e-4


def verify(folder):
    """Sentences of what was checked; ConfigError at the first thing that does not hold."""
    found = TrialSet(folder)
    if not found.has("result.json"):
        raise ConfigError(found.folder, "a set that was scored", "no result.json",
                          f"run: brakechain trial score {found.folder}")
    truth, kept = found.read("truth.json"), found.read("answers.json")
    told = [*_sealing(found, truth)] if found.sealed else ["open set: nothing was sealed"]
    _check(sha256(canonical(kept["answers"])) == kept["digest"], found, "answers.json is not what was solved")
    told.append(f"answers {kept['digest']} are unchanged")
    other = difference(json.loads(canonical(scored_as(found, truth, kept["answers"]))), found.read("result.json"))
    _check(other is None, found, f"result.json is not the score of these answers by this code: {other}")
    told.append(f"result.json is the score of {len(truth)} cases by this code")
    told += [f"errata.yaml: not compared are {', '.join(one['parameters'])} of {one['system']}: {one['reason']}"
             for one in found.read("result.json").get("errata", ())]
    if (found.folder / "cases").exists() and found.about:
        _check(found.digest() == found.about["digest"], found, "the cases are not those of set.yaml")
        told.append("the files of all cases are those that were committed")
    return told


def _sealing(found, truth):
    """Sentences on key, ciphertext, commitment and code of a sealed set."""
    opened = found.read_yaml("opened.yaml")
    content = sealing.unlocked(found.path("truth.sealed").read_bytes(), opened["key"].encode(),
                               found.path("truth.sealed"))
    _check(content == {"salt": opened["salt"], "truth": truth}, found, "truth.json is not what was sealed")
    yield "the published key opens truth.sealed, which holds truth.json"
    check_commitment(found, opened["salt"], truth)
    yield f"commitment {found.about['commitment']} is the salted SHA-256 of that truth"
    committed = code_digest.of_answers(found.read("code.json"))
    answers = found.read("answers.json")["answers"]
    _check({a["code"] for method in answers.values() for a in method.values()} == {committed}, found,
           "answers were made by other code than that of the commitment")
    yield f"all answers were made by the code of the commitment (commit {found.about.get('commit') or 'not recorded'})"


def _check(holds, found, otherwise):
    if not holds:
        raise ConfigError(found.folder, "a set whose parts belong together", otherwise)


def difference(now, published, path="result"):
    """Where two results first differ, or None: keys, counts and words exactly, other numbers within ``_AGREE``."""
    if isinstance(now, dict) and isinstance(published, dict):
        if now.keys() != published.keys():
            return f"{path}: {', '.join(sorted(now.keys() ^ published.keys()))} on one side only"
        pairs = [(now[key], published[key], f"{path}.{key}") for key in published]
    elif isinstance(now, list) and isinstance(published, list):
        if len(now) != len(published):
            return f"{path}: {len(now)} for {len(published)}"
        pairs = [(a, b, f"{path}.{k}") for k, (a, b) in enumerate(zip(now, published, strict=True))]
    elif isinstance(now, float) and isinstance(published, float):
        close = math.isclose(now, published, rel_tol=_AGREE, abs_tol=_AGREE)
        return None if close else f"{path}: {now} for {published}"
    else:
        same = type(now) is type(published) and now == published
        return None if same else f"{path}: {now!r} for {published!r}"
    return next((found for pair in pairs if (found := difference(*pair))), None)

"""Verifying a published set: that truth, key, commitment, answers and result belong together."""

import json
import math

from pipeline.blind_trial.protocol import code_digest, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, in_format, sha256
from pipeline.blind_trial.protocol.scoring import check_commitment, scored_as
from pipeline.contract.errors import ConfigError

#: how far recomputed numbers may lie from published ones: interval bounds of sealed_2 and sealed_3 took z = 1.96, and
#: other processors round otherwise
_AGREE = 1e-4


def verify(folder):
    """Sentences of what was checked; ConfigError at the first thing that does not hold."""
    with in_format(folder):
        return _verified(TrialSet(folder))


def _verified(trial):
    if not trial.has("result.json"):
        raise ConfigError(trial.folder, "a set that was scored", "no result.json",
                          f"run: brakechain trial score {trial.folder}")
    truth, kept = trial.truth(), trial.read("answers.json")
    sentences = [*_sealing(trial, truth)] if trial.sealed else ["open set: nothing was sealed"]
    _check(sha256(canonical(kept["answers"])) == kept["digest"], trial, "answers.json is not what was solved")
    sentences.append(f"answers {kept['digest']} are unchanged")
    other = difference(json.loads(canonical(scored_as(trial, truth, kept["answers"]))), trial.read("result.json"))
    _check(other is None, trial, f"result.json is not the score of these answers by this code: {other}")
    sentences.append(f"result.json is the score of {len(truth)} cases by this code")
    sentences += [f"errata.yaml: not compared are {', '.join(e['parameters'])} of {e['system']}: {e['reason']}"
             for e in trial.read("result.json").get("errata", ())]
    if (trial.folder / "cases").exists() and trial.about:
        _check(trial.digest() == trial.about["digest"], trial, "the cases are not those of set.yaml")
        sentences.append("the files of all cases are those that were committed")
    return sentences


def _sealing(trial, truth):
    """Sentences on key, ciphertext, commitment and code of a sealed set."""
    opened = trial.read_yaml("opened.yaml")
    content = sealing.unlocked(trial.path("truth.sealed").read_bytes(), opened["key"].encode(),
                               trial.path("truth.sealed"))
    _check(content == {"salt": opened["salt"], "truth": truth}, trial, "truth.json is not what was sealed")
    yield "the published key opens truth.sealed, which holds truth.json"
    check_commitment(trial, opened["salt"], truth)
    yield f"commitment {trial.about['commitment']} is the salted SHA-256 of that truth"
    committed = code_digest.of_answers(trial.read("code.json"))
    answers = trial.read("answers.json")["answers"]
    _check({a["code"] for method in answers.values() for a in method.values()} == {committed}, trial,
           "answers were made by other code than that of the commitment")
    yield f"all answers were made by the code of the commitment (commit {trial.about.get('commit') or 'not recorded'})"


def _check(holds, trial, otherwise):
    if not holds:
        raise ConfigError(trial.folder, "a set whose parts belong together", otherwise)


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
    return next((first for pair in pairs if (first := difference(*pair))), None)

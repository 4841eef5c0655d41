"""Verifying a published set: that truth, key, commitment, answers and result belong together."""

from pipeline.blind_trial.protocol import code_digest, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, sha256
from pipeline.blind_trial.protocol.scoring import check_commitment, scored_as
from pipeline.contract.errors import ConfigError


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
    _check(canonical(scored_as(found, truth, kept["answers"])) == canonical(found.read("result.json")), found,
           "result.json is not the score of these answers by this code")
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

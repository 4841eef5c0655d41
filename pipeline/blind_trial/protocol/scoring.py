"""Scoring: the truth is opened once, beside answers that are complete and were made by the code of the commitment."""

from datetime import UTC, datetime

from pipeline.blind_trial.metrics.result import result
from pipeline.blind_trial.protocol import code_digest, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, checked_truth, in_format, sha256
from pipeline.blind_trial.protocol.solving import METHODS, check_cases, check_code, digest_of_case
from pipeline.blind_trial.protocol.truth_format import check_truth
from pipeline.contract.errors import ConfigError


def score(folder, key_file=None, truth_file=None):
    """Result of a solved set, written with the opened truth and its key; of an open set from its truth alone.

    Refused: a set that is not solved, no key, a truth that does not match its commitment, changed code, answers or
    cases, and a sealed set that was scored before.
    """
    with in_format(folder):
        return _scored(TrialSet(folder), key_file, truth_file)


def _scored(trial, key_file, truth_file):
    answers = _answers(trial)
    opened, key = _opened(trial, key_file) if trial.sealed else (None, None)
    truth = checked_truth(opened["truth"], trial.folder / "truth.sealed") if opened else trial.truth(truth_file)
    check_truth(trial, truth)
    if not trial.sealed:
        _check_current(trial, answers)
    scored = scored_as(trial, truth, answers)
    if opened:
        trial.write("truth.json", truth)
        trial.write("opened.yaml", {"key": key.decode(), "salt": opened["salt"],
                                    "scored": datetime.now(UTC).isoformat(timespec="seconds")})
    trial.write("result.json", scored)
    return scored


def scored_as(trial, truth, answers):
    """The result of a TrialSet of this truth and these answers, but for the errata of the set."""
    return result(trial.about or {"name": trial.name, "kind": "open", "cases": len(truth)}, truth, answers,
                  trial.read_yaml("errata.yaml")["errata"] if trial.has("errata.yaml") else ())


def _answers(trial):
    """{method: {case: answer}}, complete and as they were when the last was found."""
    if not trial.has("answers.json"):
        raise ConfigError(trial.folder, "answers of all cases", f"{_solved(trial)} of {len(trial.cases)}",
                          f"run: brakechain trial solve {trial.folder}")
    kept = trial.read("answers.json")
    if sha256(canonical(kept["answers"])) != kept["digest"]:
        raise ConfigError(trial.path("answers.json"), "answers as they were solved", "answers that were changed")
    if METHODS[0] not in kept["answers"]:
        raise ConfigError(trial.path("answers.json"), f"answers of the {METHODS[0]}", ", ".join(kept["answers"]),
                          f"run: brakechain trial solve {trial.folder}")
    return kept["answers"]


def _solved(trial):
    return len(list(trial.path(f"answers/{METHODS[0]}").glob("*.json")))


def _opened(trial, key_file):
    """({salt, truth}, key) of a sealed set that was not scored, by its committed code on its committed cases."""
    if trial.has("result.json"):
        raise ConfigError(trial.folder, "a sealed set that was not scored", "its result",
                          "check it with: brakechain trial verify SET")
    key = sealing.read_key(key_file)
    check_code(trial, code_digest.files(), "before it was scored")
    check_cases(trial)
    return unsealed(trial, key), key


def unsealed(trial, key):
    """{salt, truth} that a ``key`` opens; ConfigError where it is not the set's, or they are not what was committed."""
    opened = sealing.unlocked(trial.path("truth.sealed").read_bytes(), key, trial.path("truth.sealed"))
    check_commitment(trial, opened["salt"], opened["truth"])
    return opened


def check_commitment(trial, salt, truth):
    """Refuse a truth other than the one that was committed."""
    if sealing.commitment(salt, truth) != trial.about.get("commitment"):
        raise ConfigError(trial.folder / "set.yaml", f"commitment {sealing.commitment(salt, truth)}",
                          trial.about.get("commitment"), "truth or commitment was changed after the set was made")


def _check_current(trial, answers):
    """Refuse to score answers of an open set that other code gave, or to other files."""
    now = code_digest.of_answers(code_digest.files())
    files = {number: digest_of_case(case) for number, case in trial.cases.items()}
    numbered = [(number, answer) for method_answers in answers.values() for number, answer in method_answers.items()]
    for what, apart in (("of other code", sum(answer["code"] != now for _, answer in numbered)),
                        ("to other files", sum(answer["files"] != files.get(number) for number, answer in numbered))):
        if apart:
            raise ConfigError(trial.path("answers.json"), "answers of this code to these cases", f"{apart} {what}",
                              f"run again: brakechain trial solve {trial.folder}")

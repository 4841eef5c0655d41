"""Solving a set: every case by every method, each in a process of its own; what is answered is kept."""

from functools import partial

from pipeline.blind_trial.baselines import BASELINES
from pipeline.blind_trial.protocol import code_digest
from pipeline.blind_trial.protocol.case_set import FILES, TrialSet, canonical, read_json, sha256
from pipeline.blind_trial.protocol.solver_process import answered
from pipeline.contract.errors import ConfigError

METHODS = ("diagnosis", *BASELINES)
#: seconds that one case may take
LIMIT = 3600.0


def solve(folder, work, methods=METHODS, limit=LIMIT, tell=lambda done, total: None):
    """Answer the cases of a set that have no answer yet; returns how many were answered now.

    A sealed set is solved once, with the code of its commitment; methods that were not asked may be added until it is
    scored. Of an open set answers of other code, to other files or within a shorter limit are renewed.
    """
    trial, now = TrialSet(folder), code_digest.files()
    unknown = set(methods) - set(METHODS)
    if unknown:
        raise ConfigError("--methods", f"some of {', '.join(METHODS)}", ", ".join(sorted(unknown)))
    if trial.sealed:
        methods = _unasked(trial, methods)
        check_code(trial, now, "before it was solved")
        check_cases(trial)
    digest = code_digest.of_answers(now)
    asked = {number: None if trial.sealed else (digest, digest_of_case(case), limit)
             for number, case in trial.cases.items()}
    todo = [(number, method) for method in methods for number in asked
            if not _answered(trial, method, number, asked[number])]
    done = iter(range(1, len(todo) + 1))
    work.map(partial(_solve, trial.folder.resolve(), digest, limit), todo, lambda: tell(next(done), len(todo)))
    _close(trial, methods)
    return len(todo)


def _unasked(trial, methods):
    """Those of the methods that have not answered a sealed set: a second look after the first would be no trial."""
    answers = trial.read("answers.json")["answers"] if trial.has("answers.json") else {}
    left = tuple(method for method in methods if method not in answers)
    if not left or trial.has("result.json"):
        raise ConfigError(trial.folder, "a sealed set that was not solved",
                          "its result" if trial.has("result.json") else f"answers of {', '.join(methods)}",
                          "a sealed set is solved once: make a new one")
    return left


def check_code(trial, now, when):
    """Refuse a sealed set whose code is not that of its commitment."""
    before = trial.read("code.json")
    apart = code_digest.changed(before, now)
    if apart:
        raise ConfigError(trial.folder, "the code that the set was committed with",
                          f"{len(apart)} files changed {when}: {', '.join(apart[:6])}{' ...' * (len(apart) > 6)}",
                          f"check out commit {trial.about.get('commit') or '(none recorded)'}, or make a new set")


def check_cases(trial):
    """Refuse a set whose cases are not those of its commitment."""
    if trial.digest() != trial.about["digest"]:
        raise ConfigError(trial.folder / "cases", f"files of digest {trial.about['digest'][:16]}...", "other files",
                          "the cases were changed after the set was made")


def digest_of_case(folder):
    """SHA-256 over both files of a case."""
    return sha256("".join(sha256((folder / name).read_bytes()) for name in FILES).encode())


def _answered(trial, method, number, asked):
    """Whether a case has its answer; where a (code, files, limit) is ``asked``, to these, and not for want of time."""
    path = trial.path(f"answers/{method}/{number}.json")
    if not path.exists() or asked is None:
        return path.exists()
    stored, (code, files, limit) = read_json(path), asked
    return (stored.get("code"), stored.get("files")) == (code, files) and not stored.get("limit", limit) < limit


def _solve(folder, digest, limit, item):
    """Answer one case into its file."""
    number, method = item
    trial = TrialSet(folder)
    if not trial.cases.get(number):
        raise ConfigError(folder, f"the case {number}", "none", "every worker must see the folder of the set")
    answer = answered(trial.cases[number], method, limit)
    if code_digest.of_answers(code_digest.files()) != digest:
        raise ConfigError(f"case {number}", "the same code from begin to end", "code that changed meanwhile",
                          "run again")
    trial.write(f"answers/{method}/{number}.json",
                {**answer, "code": digest, "files": digest_of_case(trial.cases[number])})


def _close(trial, methods):
    """Write answers.json, the answers of all methods that answered every case, once those asked for have."""
    cases = list(trial.cases)
    whole = [method for method in METHODS if all(trial.has(f"answers/{method}/{number}.json") for number in cases)]
    if set(methods) <= set(whole):
        kept = trial.read("answers.json")["answers"] if trial.sealed and trial.has("answers.json") else {}
        answers = kept | {method: {number: trial.read(f"answers/{method}/{number}.json") for number in cases}
                       for method in whole if method not in kept}
        trial.write("answers.json", {"digest": sha256(canonical(answers)), "answers": answers})

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
    found, now = TrialSet(folder), code_digest.files()
    unknown = set(methods) - set(METHODS)
    if unknown:
        raise ConfigError("--methods", f"some of {', '.join(METHODS)}", ", ".join(sorted(unknown)))
    if found.sealed:
        methods = _unasked(found, methods)
        check_code(found, now, "before it was solved")
        check_cases(found)
    digest = code_digest.of_answers(now)
    asked = {number: None if found.sealed else (digest, digest_of_case(case), limit)
             for number, case in found.cases.items()}
    todo = [(number, method) for method in methods for number in asked
            if not _answered(found, method, number, asked[number])]
    done = iter(range(1, len(todo) + 1))
    work.map(partial(_solve, found.folder.resolve(), digest, limit), todo, lambda: tell(next(done), len(todo)))
    _close(found, methods)
    return len(todo)


def _unasked(found, methods):
    """Those of the methods that have not answered a sealed set: a second look after the first would be no trial."""
    told = found.read("answers.json")["answers"] if found.has("answers.json") else {}
    left = tuple(method for method in methods if method not in told)
    if not left or found.has("result.json"):
        raise ConfigError(found.folder, "a sealed set that was not solved",
                          "its result" if found.has("result.json") else f"answers of {', '.join(methods)}",
                          "a sealed set is solved once: make a new one")
    return left


def check_code(found, now, when):
    """Refuse a sealed set whose code is not that of its commitment."""
    before = found.read("code.json")
    apart = code_digest.changed(before, now)
    if apart:
        raise ConfigError(found.folder, "the code that the set was committed with",
                          f"{len(apart)} files changed {when}: {', '.join(apart[:6])}{' ...' * (len(apart) > 6)}",
                          f"check out commit {found.about.get('commit') or '(none recorded)'}, or make a new set")


def check_cases(found):
    """Refuse a set whose cases are not those of its commitment."""
    if found.digest() != found.about["digest"]:
        raise ConfigError(found.folder / "cases", f"files of digest {found.about['digest'][:16]}...", "other files",
                          "the cases were changed after the set was made")


def digest_of_case(folder):
    """SHA-256 over both files of a case."""
    return sha256("".join(sha256((folder / name).read_bytes()) for name in FILES).encode())


def _answered(found, method, number, asked):
    """Whether a case has its answer; where a (code, files, limit) is ``asked``, to these, and not for want of time."""
    path = found.path(f"answers/{method}/{number}.json")
    if not path.exists() or asked is None:
        return path.exists()
    told, (own, files, limit) = read_json(path), asked
    return (told.get("code"), told.get("files")) == (own, files) and not told.get("limit", limit) < limit


def _solve(folder, digest, limit, item):
    """Answer one case into its file."""
    number, method = item
    found = TrialSet(folder)
    if not found.cases.get(number):
        raise ConfigError(folder, f"the case {number}", "none", "every worker must see the folder of the set")
    answer = answered(found.cases[number], method, limit)
    if code_digest.of_answers(code_digest.files()) != digest:
        raise ConfigError(f"case {number}", "the same code from begin to end", "code that changed meanwhile",
                          "run again")
    found.write(f"answers/{method}/{number}.json",
                {**answer, "code": digest, "files": digest_of_case(found.cases[number])})


def _close(found, methods):
    """Write answers.json, the answers of all methods that answered every case, once those asked for have."""
    cases = list(found.cases)
    whole = [method for method in METHODS if all(found.has(f"answers/{method}/{number}.json") for number in cases)]
    if set(methods) <= set(whole):
        kept = found.read("answers.json")["answers"] if found.sealed and found.has("answers.json") else {}
        told = kept | {method: {number: found.read(f"answers/{method}/{number}.json") for number in cases}
                       for method in whole if method not in kept}
        found.write("answers.json", {"digest": sha256(canonical(told)), "answers": told})

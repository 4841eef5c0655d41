"""Solving a set: every case by every method, each in a process of its own; what is answered is kept."""

from functools import partial

from pipeline.baselines import BASELINES
from pipeline.concealed import code
from pipeline.concealed.child import answered
from pipeline.concealed.sets import TrialSet, canonical, read_json, sha256
from pipeline.contract.errors import ConfigError

METHODS = ("diagnosis", *BASELINES)
#: seconds that one case may take
LIMIT = 3600.0


def solve(folder, work, methods=METHODS, limit=LIMIT, tell=lambda done, total: None):
    """Answer the cases of a set that have no answer yet; returns how many were answered now.

    A sealed set is solved once, with the code of its commitment; of an open one, answers of other code are renewed.
    """
    found, now = TrialSet(folder), code.files()
    unknown = set(methods) - set(METHODS)
    if unknown:
        raise ConfigError("--methods", f"some of {', '.join(METHODS)}", ", ".join(sorted(unknown)))
    if found.sealed:
        check_unsolved(found)
        check_code(found, now, "before it was solved")
        check_cases(found)
    digest = code.of_answers(now)
    todo = [(number, method) for method in methods for number in found.cases
            if not _answered(found, method, number, None if found.sealed else digest)]
    done = iter(range(1, len(todo) + 1))
    work.map(partial(_solve, found.folder.resolve(), digest, limit), todo, lambda: tell(next(done), len(todo)))
    _close(found, methods)
    return len(todo)


def check_unsolved(found):
    """Refuse a set that was solved: a second look after the first would be no trial."""
    if found.has("answers.json"):
        raise ConfigError(found.folder, "a sealed set that was not solved", "answers.json of all its cases",
                          "a sealed set is solved once: make a new one")


def check_code(found, now, when):
    """Refuse a sealed set whose code is not that of its commitment."""
    before = found.read("code.json")
    apart = code.changed(before, now)
    if apart:
        raise ConfigError(found.folder, "the code that the set was committed with",
                          f"{len(apart)} files changed {when}: {', '.join(apart[:6])}{' ...' * (len(apart) > 6)}",
                          f"check out commit {found.about.get('commit') or '(none recorded)'}, or make a new set")


def check_cases(found):
    """Refuse a set whose cases are not those of its commitment."""
    if found.digest() != found.about["digest"]:
        raise ConfigError(found.folder / "cases", f"files of digest {found.about['digest'][:16]}...", "other files",
                          "the cases were changed after the set was made")


def _answered(found, method, number, digest):
    """Whether a case has its answer, of this code where a ``digest`` is given."""
    path = found.path(f"answers/{method}/{number}.json")
    return path.exists() and digest in (None, read_json(path).get("code"))


def _solve(folder, digest, limit, item):
    """Answer one case into its file."""
    number, method = item
    found = TrialSet(folder)
    if not found.cases.get(number):
        raise ConfigError(folder, f"the case {number}", "none", "every worker must see the folder of the set")
    answer = answered(found.cases[number], method, limit)
    if code.of_answers(code.files()) != digest:
        raise ConfigError(f"case {number}", "the same code from begin to end", "code that changed meanwhile",
                          "run again")
    found.write(f"answers/{method}/{number}.json", {**answer, "code": digest})


def _close(found, methods):
    """Write answers.json, the answers of all methods that answered every case, once those asked for have."""
    cases = list(found.cases)
    whole = [method for method in METHODS if all(found.has(f"answers/{method}/{number}.json") for number in cases)]
    if set(methods) <= set(whole):
        told = {method: {number: found.read(f"answers/{method}/{number}.json") for number in cases} for method in whole}
        found.write("answers.json", {"digest": sha256(canonical(told)), "answers": told})

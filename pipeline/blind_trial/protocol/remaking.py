"""Cases made again from their truth: of a sealed set whose cases were lost, or of a published one to be tried anew."""

import shutil
from functools import partial
from numbers import Real
from pathlib import Path

from pipeline.blind_trial.generators.systems import SYSTEMS, Draw
from pipeline.blind_trial.protocol import sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, checked_truth
from pipeline.blind_trial.protocol.making import described
from pipeline.blind_trial.protocol.scoring import unsealed
from pipeline.contract.errors import ConfigError
from pipeline.contract.integrity.lock import locked
from pipeline.contract.received import names

#: where cases lie until they are whole
_HALF = ".remaking"


def restore(folder, work, key_file=None, tell=lambda done, total: None):
    """Make the cases of a set again in its own folder, from the truth that lies there or the one that its key opens.

    Refused where they are not, byte for byte, those that the set was committed with. work, tell : see ``making.make``.
    """
    original = TrialSet(folder)
    with locked(folder):
        _make_cases(original.folder, _truth(original, key_file), work, tell)
        shutil.rmtree(original.folder / _HALF)
    if original.digest() != original.about["digest"]:
        raise ConfigError(original.folder / "cases", f"files of digest {original.about['digest'][:16]}...",
                          "other files",
                          f"check out commit {original.about.get('commit') or '(none recorded)'} with the packages "
                          "of set.yaml, remove cases/, and run this again")


def repeat(folder, into, work, tell=lambda done, total: None):
    """Make the cases of a published set again as the open set ``into``; whether they are the same byte for byte.

    Other packages or another processor may change last digits: what is hidden, and how well it shows, stay the same.
    """
    original, into = TrialSet(folder), Path(into)
    if (into / "set.yaml").exists() or (not (into / _HALF).exists() and (
            (into / "cases").exists() or (into / "truth.json").exists())):
        raise ConfigError(into, "a folder without a set", "a set of cases", "name a new folder")
    truth = _truth(original, None)
    into.mkdir(parents=True, exist_ok=True)
    with locked(into):
        _make_cases(into, truth, work, tell)
        made = TrialSet(into)
        made.write("truth.json", truth)
        made.write("set.yaml", described(made, truth, "open"))
        shutil.rmtree(into / _HALF)
    return made.digest() == original.about.get("digest")


def _truth(original, key_file):
    """Truth of a set, each case with the draw that makes it again."""
    if original.has("truth.json"):
        truth = original.truth()
    elif original.has("truth.sealed") and key_file:
        truth = checked_truth(unsealed(original, sealing.read_key(key_file))["truth"], original.folder / "truth.sealed")
    else:
        raise ConfigError(original.folder, "a published set, with its truth.json", "none",
                          "a sealed set is published once it is scored")
    strange = [number for number, case in truth.items() if not _is_draw(case.get("draw"))]
    if strange:
        raise ConfigError(original.folder / "truth.json", "draws of the generators of this program",
                          f"{len(strange)} cases without, such as {strange[0]}",
                          "only sets that 'brakechain trial make' made can be made again")
    return truth


def _is_draw(draw):
    """Whether these are the fields of a Draw, each of its type, of a system that is known."""
    kinds = {"seed": int, "system": str, "kind": str, "hidden": list, "size": Real, "noise": Real}
    return (isinstance(draw, dict) and draw.keys() == kinds.keys() and all(map(isinstance, draw.values(), [
        kinds[key] for key in draw])) and draw["system"] in SYSTEMS and all(isinstance(h, str) for h in draw["hidden"]))


def _make_cases(folder, truth, work, tell):
    """Cases of a truth in a folder, each whole or not at all; those that are there stay."""
    done = iter(range(1, len(truth) + 1))
    half, cases = names.within(folder, _HALF), names.within(folder, "cases")
    half.mkdir(exist_ok=True)
    cases.mkdir(exist_ok=True)
    work.map(partial(_make_case, cases, half), [(n, case["draw"]) for n, case in truth.items()],
             lambda: tell(next(done), len(truth)))


def _make_case(cases, half, item):
    number, draw = item
    case, part = names.within(cases, number), names.within(half, number)
    if not case.exists():
        shutil.rmtree(part, ignore_errors=True)
        SYSTEMS[draw["system"]].write(Draw.read(draw), part)
        part.rename(case)

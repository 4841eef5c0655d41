"""Making a set: cases one by one, each whole or not at all; what is made is kept when the command is run again."""

import secrets
import shutil
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from pipeline.blind_trial.generators.systems import SYSTEMS, Draw
from pipeline.blind_trial.metrics.criteria import VISIBLE
from pipeline.blind_trial.protocol import code_digest, sealing
from pipeline.blind_trial.protocol.case_set import FORMAT, TrialSet, canonical, read_json
from pipeline.blind_trial.protocol.stratification import drawn
from pipeline.blind_trial.protocol.truth_format import check_truth
from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.integrity.lock import locked
from pipeline.contract.received import names
from pipeline.contract.store import write_companion

#: seeds that are tried for a case that cannot be made
_TRIES = 8
#: times as far as without what is hidden that a motion may go: beyond, a law has left the range that it is meant for
_REACH = 5.0


@dataclass(frozen=True)
class Store:
    """Where truths lie while a set is made: JSON, encrypted where there is a ``key``."""

    folder: Path
    key: bytes | None

    def path(self, name):
        return self.folder / f"{name}.{'sealed' if self.key else 'json'}"

    def read(self, name):
        if self.key:
            return sealing.unlocked(self.path(name).read_bytes(), self.key, self.path(name))
        return read_json(self.path(name))

    def write(self, name, values):
        self.folder.mkdir(parents=True, exist_ok=True)
        content = sealing.locked(values, self.key) if self.key else canonical(values)
        write_companion(self.path(name), content)


def make(folder, count, systems, work, seed=None, key=None, tell=lambda done, total: None):
    """Make a set of ``count`` cases of the named ``systems``: open from a ``seed``, or sealed under a ``key``.

    work : executor; key(begun) -> the key, a new one unless the set was begun before; tell(done, total) hears of every
    case that is made.
    """
    folder = Path(folder)
    if (folder / "set.yaml").exists() or ((folder / "cases").exists() and not begun(folder)):
        raise ConfigError(folder, "a folder without a set", "a set of cases", "name a new folder")
    asked = {"cases": count, "systems": list(systems), "seed": seed}
    with locked(folder):
        plan = None if begun(folder) else {"asked": asked, "draws": _planned(asked)}
        store = Store(_making(folder), key and key(begun(folder)))
        if plan:
            store.write("plan", plan)
        draws = _draws(store, asked)
        done = iter(range(1, len(draws) + 1))
        work.map(partial(_made, folder, store), list(draws.items()), lambda: tell(next(done), len(draws)))
        _finish(TrialSet(folder), {number: store.read(number) for number in draws}, store.key)
        shutil.rmtree(store.folder)


def begun(folder):
    """Whether a set was begun here and not finished."""
    return _making(Path(folder)).exists()


def _making(folder):
    return names.within(folder, ".making")


def _planned(asked):
    """{number: fields of a Draw} of a new set."""
    unknown = set(asked["systems"]) - set(SYSTEMS)
    if unknown:
        raise ConfigError("--systems", f"some of {', '.join(SYSTEMS)}", ", ".join(sorted(unknown)))
    random = np.random.default_rng(secrets.randbits(128) if asked["seed"] is None else asked["seed"])
    draws = drawn(asked["cases"], {name: SYSTEMS[name] for name in asked["systems"]}, random)
    digits = max(3, len(str(len(draws))))
    return {f"{k:0{digits}d}": asdict(replace(draw, seed=_seed(random, asked["seed"])))
            for k, draw in enumerate(draws, 1)}


def _draws(store, asked):
    """{number: Draw} as planned when the set was begun."""
    plan = store.read("plan")
    if plan["asked"] != asked:
        raise ConfigError(store.folder.parent, f"the command that began this set: {plan['asked']}", str(asked),
                          "repeat that command, or name a new folder")
    return {number: Draw.read(record) for number, record in names.checked_all(plan["draws"], store.folder).items()}


def _seed(random, given):
    return int(random.integers(2**31)) if given is not None else secrets.randbits(31)


def _made(folder, store, item):
    """Make one case, unless it is there: its truth first, then its folder under its name."""
    number, draw = item
    case, half = names.within(folder, f"cases/{number}"), names.within(store.folder, number)
    if case.exists():
        return
    truth = _drawn(draw, half)
    store.write(number, truth)
    case.parent.mkdir(exist_ok=True)
    half.rename(case)


def _drawn(draw, folder):
    """Truth of a draw whose files are in ``folder`` now; other seeds where the first cannot be made."""
    draws = []
    for attempt in range(_TRIES):
        shutil.rmtree(folder, ignore_errors=True)
        again = replace(draw, seed=int(np.random.SeedSequence([draw.seed, attempt]).generate_state(1)[0]))
        try:
            truth = SYSTEMS[draw.system].write(again, folder)
        except BrakechainError as error:
            draws.append(str(error))
            continue
        if truth.get("reach", 0.0) < _REACH:
            return {**truth, "motion": SYSTEMS[draw.system].motion, "visible": VISIBLE, "draw": asdict(again)}
        draws.append(f"a motion {truth['reach']:.3g} times as far as without what is hidden")
    hidden = " + ".join(draw.hidden)
    raise ConfigError(f"{draw.system}: {draw.kind} {hidden}", f"a case within {_TRIES} seeds", draws[-1])


def _finish(made, truth, key):
    """Write the truth, sealed where there is a key, and what the set says of itself."""
    if key:
        seal_truth(made, truth, key)
    else:
        made.write("truth.json", truth)
        made.write("set.yaml", described(made, truth, "open"))


def seal(folder, new_key):
    """Seal the truth.json of an open set that was not solved under ``new_key()``: it is a sealed one from then on."""
    cases = TrialSet(folder)
    if cases.sealed:
        raise ConfigError(cases.folder, "an open set", "a sealed one")
    if cases.has("answers") or cases.has("answers.json"):
        raise ConfigError(cases.folder, "a set that nobody has solved", "answers",
                          "to seal a truth that was known while it was solved would prove nothing")
    truth = cases.truth()
    check_truth(cases, truth)
    seal_truth(cases, truth, new_key())
    cases.path("truth.json").unlink()


def seal_truth(cases, truth, key):
    """Write truth.sealed, then set.yaml with its commitment."""
    content, commitment = sealing.sealed(truth, key)
    write_companion(cases.path("truth.sealed"), content)
    write_code(cases)
    cases.write("set.yaml", {**described(cases, truth, "sealed"), "commitment": commitment})


def described(cases, truth, kind):
    """What a set says of itself; classes and systems in numbers, nothing of single cases."""
    counted = {what: _counted([case.get(name, "") for case in truth.values()]) for what, name in (
        ("classes", "class"), ("systems", "system"))}
    return {"format": FORMAT, "name": cases.name, "kind": kind, "cases": len(truth), **counted,
            "digest": cases.digest(), **code_digest.described()}


def _counted(names):
    return {name: names.count(name) for name in sorted(set(names))}


def write_code(cases):
    """Write code.json: the digests of what decides answers and scores."""
    cases.write("code.json", code_digest.files())

"""Making sets: whole cases, resumed where they were stopped; seeds of sealed sets are nobody's."""

import json
import secrets

import pytest

from pipeline.blind_trial.generators.systems import System
from pipeline.blind_trial.metrics.criteria import VISIBLE
from pipeline.blind_trial.protocol import making, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.executors import InProcess
from tests.blind_trial.protocol.small_set import small_set

KEY = sealing.Fernet.generate_key()


class Generator:
    """Writes cases that tell their seed, counts them, and fails when told."""

    def __init__(self, fails=lambda call: None, reach=lambda call: 1.0):
        self.calls, self.fails, self.reach = 0, fails, reach

    def write(self, draw, folder):
        self.calls += 1
        folder.mkdir()
        (folder / "nominal.yaml").write_text("{}")
        error = self.fails(self.calls)
        if error:
            raise error
        (folder / "recordings.h5").write_text(str(draw.seed))
        hidden = [{"name": name, "place": "x"} for name in draw.hidden]
        return {"class": draw.kind, "effects": hidden, "system": draw.system, "size": draw.size, "noise": draw.noise,
                "reach": self.reach(self.calls)}


@pytest.fixture
def generator(monkeypatch):
    def put(*asked, **named):
        made = Generator(*asked, **named)
        system = System("toy", made.write, {"control": ((),), "effect": (("a",), ("b",))}, (0.3,), (0.01,))
        monkeypatch.setattr(making, "SYSTEMS", {"toy": system})
        return made
    return put


def make(folder, **asked):
    making.make(folder, **{"count": 5, "systems": ("toy",), "work": InProcess(), "seed": 3, **asked})
    return TrialSet(folder)


def test_an_open_set_is_whole_and_repeatable(tmp_path, generator):
    generator()
    heard = []
    first = make(tmp_path / "a", tell=lambda done, total: heard.append((done, total)))
    assert heard == [(k, 5) for k in range(1, 6)] and list(first.cases) == [f"00{k}" for k in range(1, 6)]
    truth = first.read("truth.json")
    assert set(truth) == set(first.cases) and all(t["motion"] == "forced" for t in truth.values())
    for number, folder in first.cases.items():
        assert sorted(p.name for p in folder.iterdir()) == ["nominal.yaml", "recordings.h5"]
        assert (folder / "recordings.h5").read_text() == str(truth[number]["draw"]["seed"])
    assert first.about["kind"] == "open" and sum(first.about["classes"].values()) == 5
    assert not (first.folder / ".making").exists() and "commitment" not in first.about
    assert make(tmp_path / "b").digest() == first.digest() != make(tmp_path / "c", seed=4).digest()


@pytest.mark.parametrize("key", [None, lambda begun: KEY], ids=["open", "sealed"])
def test_a_set_that_was_stopped_goes_on_with_the_same_draws(tmp_path, generator, key):
    def stop(call):
        return KeyboardInterrupt() if call == 3 else None

    asked = {"key": key, "seed": None if key else 3}
    generator(stop)
    with pytest.raises(KeyboardInterrupt):
        make(tmp_path / "a", **asked)
    half = tmp_path / "a"
    assert len(list((half / "cases").iterdir())) == 2 and not (half / "set.yaml").exists()
    kept = {p.name: (p / "recordings.h5").read_text() for p in (half / "cases").iterdir()}
    with pytest.raises(BrakechainError, match="the command that began this set"):
        make(tmp_path / "a", **{**asked, "count": 6})
    again = generator()
    whole = make(tmp_path / "a", **asked)
    assert again.calls == 3 and len(whole.cases) == 5
    assert all((whole.cases[n] / "recordings.h5").read_text() == text for n, text in kept.items())


def test_a_case_that_cannot_be_made_is_drawn_again_and_then_given_up(tmp_path, generator):
    trouble = ConfigError("a draw", "one that can be made", "none")
    made = generator(lambda call: trouble if call in (1, 2) else None)
    assert len(make(tmp_path / "a").cases) == 5 and made.calls == 7
    generator(lambda call: trouble)
    with pytest.raises(BrakechainError, match="a case within 8 seeds"):
        make(tmp_path / "b")


def test_a_motion_that_runs_away_is_drawn_again_and_every_truth_says_what_is_visible(tmp_path, generator):
    made = generator(reach=lambda call: 30.0 if call == 2 else 2.0)
    truth = make(tmp_path / "a").read("truth.json")
    assert made.calls == 6 and all(one["reach"] == 2.0 and one["visible"] == VISIBLE for one in truth.values())
    generator(reach=lambda call: 30.0)
    with pytest.raises(ConfigError, match="a motion 30 times as far"):
        make(tmp_path / "b")


def test_a_sealed_set_shows_nothing_of_its_truth_and_its_seeds_come_from_the_system(tmp_path, generator, monkeypatch):
    asked = []
    monkeypatch.setattr(secrets, "randbits", lambda bits, real=secrets.randbits: asked.append(bits) or real(bits))
    generator()
    first, second = (make(tmp_path / name, seed=None, key=lambda begun: KEY) for name in "ab")
    assert len(asked) == 2 * (5 + 1) and first.digest() != second.digest()
    assert sorted(p.name for p in first.folder.iterdir()) == [".lock", "cases", "code.json", "set.yaml", "truth.sealed"]
    opened = sealing.unlocked(first.path("truth.sealed").read_bytes(), KEY, "")
    assert sealing.commitment(opened["salt"], opened["truth"]) == first.about["commitment"]
    assert opened["truth"]["001"]["draw"]["seed"] == int((first.cases["001"] / "recordings.h5").read_text())


def test_a_set_is_not_made_over_another_and_systems_must_be_known(tmp_path, generator):
    generator()
    make(tmp_path / "a")
    with pytest.raises(BrakechainError, match="a folder without a set"):
        make(tmp_path / "a")
    with pytest.raises(BrakechainError, match="--systems: expected some of toy"):
        make(tmp_path / "b", systems=("none",))


def test_a_set_of_others_is_sealed(tmp_path):
    folder = small_set(tmp_path / "mine")
    truth = json.loads((folder / "truth.json").read_text())
    making.seal(folder, lambda: KEY)
    found = TrialSet(folder)
    assert found.sealed and not found.has("truth.json")
    assert sealing.unlocked(found.path("truth.sealed").read_bytes(), KEY, "")["truth"] == truth
    with pytest.raises(BrakechainError, match="an open set, found a sealed one"):
        making.seal(folder, lambda: KEY)


def test_a_set_that_was_solved_or_whose_truth_is_of_other_cases_is_not_sealed(tmp_path):
    def never():
        raise AssertionError("no key is made for a set that is refused")

    folder = small_set(tmp_path / "a")
    (folder / "answers").mkdir()
    with pytest.raises(BrakechainError, match="a set that nobody has solved"):
        making.seal(folder, never)
    folder = small_set(tmp_path / "b")
    (folder / "truth.json").write_text('{"001": {}, "009": {}}')
    with pytest.raises(BrakechainError, match="002, 003, 009 in only one of both"):
        making.seal(folder, never)

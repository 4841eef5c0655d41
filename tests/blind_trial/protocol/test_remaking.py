"""Cases made again: the same files in the set's own folder, or an open set of a published one."""

import shutil

import pytest
from click.testing import CliRunner

from pipeline.blind_trial.generators.systems import System
from pipeline.blind_trial.protocol import making, remaking, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.cli.main import cli
from pipeline.contract.errors import ConfigError
from pipeline.contract.executors import InProcess
from tests.blind_trial.protocol.small_set import small_set

KEY = sealing.Fernet.generate_key()


def write(draw, folder, told="{}"):
    folder.mkdir()
    (folder / "nominal.yaml").write_text(told)
    (folder / "recordings.h5").write_text(str(draw.seed))
    return {"class": draw.kind, "effects": [{"name": n, "place": "x"} for n in draw.hidden], "system": draw.system}


@pytest.fixture
def generators(monkeypatch):
    def put(how=write):
        found = {"toy": System("toy", how, {"control": ((),), "effect": (("a",), ("b",))}, (0.3,), (0.01,))}
        monkeypatch.setattr(making, "SYSTEMS", found)
        monkeypatch.setattr(remaking, "SYSTEMS", found)
    put()
    return put


@pytest.fixture
def key_file(tmp_path):
    path = tmp_path / "set.key"
    path.write_bytes(KEY)
    return path


def make(folder, **asked):
    making.make(folder, **{"count": 5, "systems": ("toy",), "work": InProcess(), "seed": None, **asked})
    return TrialSet(folder)


def contents(folder):
    return {path.relative_to(folder): path.read_text() for path in sorted((folder / "cases").rglob("*.*"))}


def test_lost_cases_of_a_sealed_set_come_back_with_its_key_alone_and_its_truth_stays_closed(
        tmp_path, generators, key_file):
    found = make(tmp_path / "a", key=lambda begun: KEY)
    before = contents(found.folder)
    shutil.rmtree(found.folder / "cases" / "002")
    shutil.rmtree(found.folder / "cases" / "004")
    heard = []
    remaking.restore(found.folder, InProcess(), key_file, lambda done, total: heard.append((done, total)))
    assert contents(found.folder) == before and heard[-1] == (5, 5)
    assert not found.has("truth.json") and not found.has(".remaking")
    key_file.write_bytes(sealing.Fernet.generate_key())
    with pytest.raises(ConfigError, match="what this key opens"):
        remaking.restore(found.folder, InProcess(), key_file)


def test_cases_that_come_out_otherwise_are_refused(tmp_path, generators, key_file):
    found = make(tmp_path / "a", key=lambda begun: KEY)
    shutil.rmtree(found.folder / "cases")
    generators(lambda draw, folder: write(draw, folder, "{changed: 1}"))
    with pytest.raises(ConfigError, match="found other files"):
        remaking.restore(found.folder, InProcess(), key_file)


def test_a_folder_that_somebody_filled_is_left_as_it_is(tmp_path, generators):
    found, theirs = make(tmp_path / "a", seed=3), small_set(tmp_path / "b")
    before = (theirs / "truth.json").read_text(), contents(theirs)
    with pytest.raises(ConfigError, match="a folder without a set, found a set of cases"):
        remaking.repeat(found.folder, theirs, InProcess())
    assert ((theirs / "truth.json").read_text(), contents(theirs)) == before


def test_a_published_set_is_repeated_as_an_open_one(tmp_path, generators):
    found = make(tmp_path / "a", seed=3)
    assert remaking.repeat(found.folder, tmp_path / "b", InProcess())
    again = TrialSet(tmp_path / "b")
    assert contents(again.folder) == contents(found.folder) and again.read("truth.json") == found.read("truth.json")
    assert again.about["kind"] == "open" and again.about["name"] == "b" and "commitment" not in again.about
    with pytest.raises(ConfigError, match="a folder without a set"):
        remaking.repeat(found.folder, tmp_path / "b", InProcess())
    generators(lambda draw, folder: write(draw, folder, "{changed: 1}"))
    assert not remaking.repeat(found.folder, tmp_path / "c", InProcess())


def test_a_sealed_truth_is_not_laid_open_and_sets_of_others_cannot_be_made_again(tmp_path, generators):
    make(tmp_path / "a", key=lambda begun: KEY)
    with pytest.raises(ConfigError, match="a published set, with its truth.json"):
        remaking.repeat(tmp_path / "a", tmp_path / "b", InProcess())
    assert not (tmp_path / "b").exists()
    with pytest.raises(ConfigError, match="3 cases without, such as 001"):
        remaking.repeat(small_set(tmp_path / "mine"), tmp_path / "b", InProcess())


def test_from_the_command_line(tmp_path, generators):
    make(tmp_path / "a", seed=3)
    done = CliRunner().invoke(cli, ["trial", "remake", str(tmp_path / "a"), str(tmp_path / "b"), "--workers", "1"])
    assert done.exit_code == 0 and "the files are identical to those of the set" in done.output, done.output
    shutil.rmtree(tmp_path / "b" / "cases")
    done = CliRunner().invoke(cli, ["trial", "remake", str(tmp_path / "b"), "--workers", "1"])
    assert done.exit_code == 0 and (tmp_path / "b" / "cases" / "005").exists(), done.output
    done = CliRunner().invoke(cli, ["trial", "remake", str(tmp_path / "b"), str(tmp_path / "c"), "--key", "k"])
    assert done.exit_code == 2 and "--key is not needed" in done.output


@pytest.mark.parametrize("number", ["foo/../../../victim", "{tmp}/planted", "..", "a\\b"])
def test_keys_of_a_foreign_truth_lead_nowhere(tmp_path, generators, number):
    """What is at the path is not deleted, and nothing is written outside of the set."""
    made, refusals = make(tmp_path / "a", seed=1), []
    (tmp_path / "victim").mkdir()
    (tmp_path / "victim" / "file").write_text("mine")
    (made.folder / ".remaking" / "foo").mkdir(parents=True)     # a set may bring folders that a key leads through
    made.write("truth.json", {number.format(tmp=tmp_path): made.read("truth.json")["001"]})
    before = set(tmp_path.rglob("*"))
    for again in (remaking.restore, lambda folder, work: remaking.repeat(folder, tmp_path / "new", work)):
        try:
            again(made.folder, InProcess())
        except Exception as error:      # what is refused too late may raise anything
            refusals.append(error)
    assert set(tmp_path.rglob("*")) == before
    assert [type(error) for error in refusals] == [ConfigError] * 2
    assert all("expected a name of letters, digits" in str(error) for error in refusals)


def test_links_in_a_foreign_set_lead_nowhere(tmp_path, generators):
    made, victim = make(tmp_path / "a", seed=1), tmp_path / "victim"
    (victim / "001").mkdir(parents=True)
    shutil.rmtree(made.folder / "cases")
    (made.folder / ".remaking").symlink_to(victim)
    with pytest.raises(ConfigError, match="expected a path inside"):
        remaking.restore(made.folder, InProcess())
    (made.folder / ".remaking").unlink()
    (made.folder / "cases").symlink_to(victim)
    with pytest.raises(ConfigError, match="expected a path inside"):
        remaking.restore(made.folder, InProcess())
    (made.folder / "answers").symlink_to(victim)
    with pytest.raises(ConfigError, match="expected a path inside"):
        made.write("answers/001.json", {})
    assert [path.name for path in victim.rglob("*")] == ["001"]


@pytest.mark.parametrize("content, told", [
    ("[]", "expected a mapping"), ('{"001": 7}', "001: expected a mapping"),
    ('{"001": {"draw": []}}', "1 cases without"),
    ('{"001": {"draw": {"system": "toy", "seed": "1"}}}', "1 cases without"), ("[" * 100_000, "a readable JSON file")])
def test_a_truth_of_no_form(tmp_path, generators, content, told):
    made = make(tmp_path / "a", seed=1)
    (made.folder / "truth.json").write_text(content)
    with pytest.raises(ConfigError, match=told):
        remaking.repeat(made.folder, tmp_path / "new", InProcess())

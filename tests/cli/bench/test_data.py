"""Commands 'data': a public set is fetched by its checksum, a user's own is registered."""

import hashlib
from pathlib import Path

import pytest
import yaml

from pipeline.recordings import registry
from tests.commands import brakechain
from tests.recordings.local_server import served

TABLE = b"t,x [mm]\n" + b"".join(b"%d,%d\n" % (k, k * k) for k in range(30))


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A registry of one public set of two files, whose repository is on this machine; nothing in the user's folders."""
    (tmp_path / "public").mkdir()
    for name in ("a.csv", "b.csv"):
        (tmp_path / "public" / name).write_bytes(TABLE)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "own"))
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.delenv("BRAKECHAIN_DATA", raising=False)
    monkeypatch.setattr(registry, "REGISTRY", tmp_path / "registry")
    (tmp_path / "registry").mkdir()
    with served(tmp_path / "public") as address:
        files = [{"name": f"recordings/swing/{name}", "address": f"{address}/{name}", "commit": "c0ffee",
                  "sha256": hashlib.sha256(TABLE).hexdigest(), "licence": "MIT", "content": "a swing", "lacks": "all"}
                 for name in ("a.csv", "b.csv")]
        (tmp_path / "registry" / "sets.yaml").write_text(yaml.safe_dump({"files": files}))
        yield tmp_path


def test_a_set_is_fetched_and_lies_where_it_says(repository):
    told = brakechain("data", "swing").stdout.splitlines()
    assert [Path(line).read_bytes() for line in told[:2]] == [TABLE, TABLE] and told[2] == "licence: MIT"
    (repository / "public" / "a.csv").unlink()
    assert brakechain("data", "swing").stdout.splitlines() == told, "fetched once"


def test_another_file_than_the_registered_one_is_refused(repository):
    (repository / "public" / "b.csv").write_bytes(TABLE + b"30,0\n")
    said = brakechain("data", "swing", code=2).stderr
    assert "measured:recordings/swing/b.csv" in said and "hash" in said.lower()


def test_a_name_that_is_no_set_gets_near_ones(repository):
    assert "did you mean 'swing'" in brakechain("data", "swimg", code=2).stderr
    assert "'brakechain data list' lists all" in brakechain("data", "qqqqqqq", code=2).stderr


def test_a_set_of_ones_own_is_found_by_cases_until_it_changes(repository):
    mine = repository / "mine.csv"
    mine.write_bytes(TABLE)
    asked = ("data", "add", mine, "--licence", "CC-BY-4.0", "--source", "our bench, 2026")
    assert f"SHA-256 {hashlib.sha256(TABLE).hexdigest()}" in brakechain(*asked, "--name", "ours").stdout
    assert brakechain("data", "ours").stdout.splitlines()[:2] == [str(mine), "licence: CC-BY-4.0"]
    assert registry.path("ours/mine.csv") == mine and "our bench, 2026" in brakechain("data", "list").stdout
    assert "a name that no set has" in brakechain(*asked, "--name", "ours", code=2).stderr
    assert "letters, digits" in brakechain(*asked, "--name", "a/b", code=2).stderr
    mine.write_bytes(TABLE + b"30,0\n")
    assert "the file was changed" in brakechain("data", "ours", code=2).stderr
    mine.unlink()
    assert "it was moved" in brakechain("data", "ours", code=2).stderr

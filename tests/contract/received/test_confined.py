"""A confined process reads the files of one folder alone."""

import pytest

from pipeline.contract import case
from pipeline.contract.errors import ConfigError
from pipeline.contract.received import confined
from tests.contract.toy import CHAINS, load


def test_files_of_the_folder_and_of_this_project(tmp_path, monkeypatch):
    inside, outside = tmp_path / "work", tmp_path / "other.yaml"
    inside.mkdir()
    outside.write_text("chain: toy\n")
    (inside / "link.yaml").symlink_to(outside)
    assert confined.allowed(outside) and not confined.confined()
    monkeypatch.setenv(confined.VARIABLE, str(inside))
    assert confined.allowed(inside / "a.yaml") and confined.allowed(confined.__file__) and confined.confined()
    assert not confined.allowed(outside) and not confined.allowed(inside / "link.yaml")
    assert not confined.allowed(inside / ".." / "other.yaml") and not confined.allowed("/etc/passwd")


def test_a_confined_case_is_based_on_nothing_else(tmp_path, monkeypatch):
    work = tmp_path / "work"
    work.mkdir()
    (tmp_path / "secret.yaml").write_text("chain: toy\ndescription: secret\n")
    (work / "nominal.yaml").write_text("based_on: ../secret.yaml\n")
    assert case.load(work / "nominal.yaml", CHAINS, load).document["description"] == "secret"
    monkeypatch.setenv(confined.VARIABLE, str(work))
    with pytest.raises(ConfigError, match="based_on: expected a file of the case, found '../secret.yaml' outside"):
        case.load(work / "nominal.yaml", CHAINS, load)

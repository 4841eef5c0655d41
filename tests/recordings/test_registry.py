"""The registry of public measurements: found, verified, refused."""

import pytest

from pipeline.contract import ConfigError
from pipeline.recordings import registry


def test_every_entry_says_where_from_and_under_which_licence():
    for name, entry in registry.entries().items():
        assert entry.address.startswith("https://") and entry.commit in entry.address
        assert len(entry.sha256) == 64 and entry.licence and entry.lacks and name == entry.name


def test_an_unregistered_name_is_refused():
    with pytest.raises(ConfigError, match="measured:surfaces/none: expected a set, .*surfaces.*did you mean"):
        registry.path("surfaces/none")


def test_a_mirror_without_the_file_or_with_another_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("BRAKECHAIN_DATA", str(tmp_path))
    with pytest.raises(ConfigError, match="expected a file at"):
        registry.path("surfaces/plu-1.plu")
    (tmp_path / "surfaces").mkdir()
    (tmp_path / "surfaces" / "plu-1.plu").write_bytes(b"other")
    with pytest.raises(ConfigError, match="expected SHA-256"):
        registry.path("surfaces/plu-1.plu")


@pytest.mark.measured
def test_the_mirror_holds_what_the_registry_says():
    for name in registry.entries():
        assert registry.path(name).is_file()

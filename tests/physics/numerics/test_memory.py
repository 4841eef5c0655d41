"""Memory that is available, and work that would need more."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.numerics import memory


def test_available_memory_is_that_of_linux(tmp_path, monkeypatch):
    stated = tmp_path / "meminfo"
    stated.write_text("MemTotal:  2000 kB\nMemAvailable:     1500 kB\n")
    monkeypatch.setattr(memory, "_MEMINFO", stated)
    assert memory.available_memory() == 1500 * 1024
    memory.refuse_beyond_memory(1500 * 1024, "a factor")
    with pytest.raises(ConfigError, match=r"memory: expected 0.0015 GB for a factor, found 0.0015 GB available"):
        memory.refuse_beyond_memory(1500 * 1024 + 1, "a factor")


def test_a_system_that_states_nothing_refuses_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(memory, "_MEMINFO", tmp_path / "none")
    assert memory.available_memory() is None
    memory.refuse_beyond_memory(1e30, "a factor")
    (tmp_path / "none").write_text("MemTotal:  2000 kB\n")
    assert memory.available_memory() is None


def test_the_refusal_names_the_setting(tmp_path, monkeypatch):
    (tmp_path / "meminfo").write_text("MemAvailable:     1500 kB\n")
    monkeypatch.setattr(memory, "_MEMINFO", tmp_path / "meminfo")
    with pytest.raises(ConfigError, match="^surface.nodes: expected 2 GB for maps, .*; lower it$"):
        memory.refuse_beyond_memory(2e9, "maps", "surface.nodes", "lower it")

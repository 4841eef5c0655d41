"""The catalogue on the terminal."""

from click.testing import CliRunner

from pipeline.cli.bench.catalogue import catalogue
from pipeline.contract.errors import ConfigError
from pipeline.effects import CATALOGUE


def told(*words):
    return CliRunner().invoke(catalogue, words)


def test_every_effect_is_listed_with_what_it_is():
    lines = told().output
    assert all(f"    {e.name} " in lines and e.summary in lines for e in CATALOGUE)
    assert "at: joint" in lines and "(weighed if asked for)" in lines


def test_one_effect_is_told_with_values_source_and_limits():
    lines = told("jenkins").output
    assert "force [N]" in lines or "limit [N]" in lines
    assert "has as limits: coulomb" in lines and "source: " in lines and "Valid while" in lines


def test_an_unknown_name_is_refused():
    assert isinstance(told("magic").exception, ConfigError | SystemExit)

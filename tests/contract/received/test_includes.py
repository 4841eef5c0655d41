"""Includes of decks: within their folder, to their end, and part of what decides whether a stage runs again."""

import pytest

from pipeline.contract import ConfigError, InputFile, Section, option
from pipeline.contract.fingerprint import settings_of
from pipeline.contract.received.includes import DEPTH, following, included, opened_in, read_lines


class Meshed(Section):
    """A section with a deck."""

    mesh: InputFile = option(..., "a deck")


def test_includes_of_both_programs_are_followed(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.inp").write_text('*NODE, NSET=N, INPUT=nodes.txt\n*INCLUDE, INPUT="sub/b c.inc"\n'
                                    "** *INCLUDE, INPUT=d\n")
    (tmp_path / "nodes.txt").write_text("1, 0, 0, 0\n")
    (tmp_path / "sub" / "b c.inc").write_text("*include,input = nodes.txt\n*INCLUDE, INPUT=a.inp\n*INCLUDE,INPUT=no\n")
    assert [f.name for f in following(tmp_path / "a.inp")] == ["nodes.txt", "b c.inc", "a.inp"]
    (tmp_path / "a.bdf").write_text("BEGIN BULK\nINCLUDE 'sub/\n  b c.inc'\ninclude nodes.txt $ all\nGRID,1,,0,0,0\n")
    assert [f.name for f in following(tmp_path / "a.bdf")] == ["b c.inc", "nodes.txt", "a.inp"]
    assert following(tmp_path / "a.vtu") == () == following(tmp_path / "none.inp")


def test_a_changed_include_changes_the_settings(tmp_path):
    (tmp_path / "a.inp").write_text("*INCLUDE, INPUT=nodes.txt\n")
    first = settings_of(Meshed(mesh=tmp_path / "a.inp"))
    (tmp_path / "nodes.txt").write_text("1, 0, 0, 0\n")
    second = settings_of(Meshed(mesh=tmp_path / "a.inp"))
    (tmp_path / "nodes.txt").write_text("1, 0, 0, 1\n")
    assert len({str(s) for s in (first, second, settings_of(Meshed(mesh=tmp_path / "a.inp")))}) == 3


def test_what_leads_out_is_refused(tmp_path):
    inside = tmp_path / "model"
    inside.mkdir()
    (tmp_path / "secret").write_text("x")
    (inside / "link").symlink_to(tmp_path / "secret")
    for name in ("../secret", tmp_path / "secret", "link"):
        with pytest.raises(ConfigError, match="here: expected an include within .*model, the folder of the deck"):
            included(name, inside, "here")
    with pytest.raises(ConfigError, match="here: expected a file to include, found none"):
        included("none", inside, "here")
    (inside / "deck").write_text("x")
    with pytest.raises(ConfigError, match="found deck within itself"):
        opened_in(inside / "deck", "deck", (inside.resolve() / "deck",), "here")
    with pytest.raises(ConfigError, match="at most 8 within each other, found more"):
        opened_in(inside / "deck", "deck", (tmp_path,) * (DEPTH + 1), "here")


def test_pipes_and_folders_are_no_decks(tmp_path):
    with pytest.raises(ConfigError, match="a text file that can be read, found"):
        read_lines(tmp_path)

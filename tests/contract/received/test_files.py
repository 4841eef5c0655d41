"""Only regular files are opened, and nothing is written through a link."""

import os

import pytest

from pipeline.contract.received import files


def test_pipes_devices_and_folders_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero", tmp_path):
        with pytest.raises(OSError, match="not a regular file"):
            files.open_regular(path)
        with pytest.raises(OSError, match="not a regular file|Is a directory"):
            files.open_lock(path)


def test_links_are_neither_written_to_nor_read_where_they_may_not(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("mine")
    link = tmp_path / "link"
    link.symlink_to(victim)
    with pytest.raises(OSError, match="a symbolic link"):
        files.open_lock(link)
    with pytest.raises(OSError, match="a symbolic link"):
        files.open_regular(link, links=False)
    assert files.read_regular(link, 4) == b"mine" and not files.is_plain(link) and files.is_plain(victim)
    files.write_new(link, b"new")
    assert victim.read_text() == "mine" and link.read_text() == "new" and not link.is_symlink()
    os.link(victim, tmp_path / "second")
    with pytest.raises(OSError, match="a second name"):
        files.open_lock(tmp_path / "second")


def test_a_file_that_is_too_large(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    with pytest.raises(OSError, match="more than 4 bytes"):
        files.read_regular(tmp_path / "a", 4)

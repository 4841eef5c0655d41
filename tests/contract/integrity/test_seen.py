"""What was found to be right is not hashed again before it changes."""

import os
import shutil

import pytest

from pipeline.contract.integrity import checksum, seen


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "a.h5").write_bytes(b"product")
    checksum.seal(tmp_path / "run" / "a.h5")
    (tmp_path / "run" / "a.csv").write_bytes(b"table")
    return tmp_path / "run"


def test_only_what_changed_is_hashed(folder, monkeypatch):
    digest = checksum.digest_of(b"table")
    assert seen.flaw(folder / "a.h5") == "" and not seen.differs(folder / "a.csv", digest)
    seen.note(folder, {"a.h5": "", "a.csv": digest})
    seen._flaw.cache_clear()
    seen._digest.cache_clear()
    hashed = []
    monkeypatch.setattr(checksum, "_digest", lambda stream, size, before=checksum._digest: hashed.append(size)
                        or before(stream, size))
    assert seen.flaw(folder / "a.h5") == "" and not seen.differs(folder / "a.csv", digest) and not hashed
    before = os.stat(folder / "a.csv")
    (folder / "a.csv").write_bytes(b"tabel")
    os.utime(folder / "a.csv", ns=(before.st_atime_ns, before.st_mtime_ns))     # size and time as before
    assert seen.differs(folder / "a.csv", digest) and hashed
    assert seen.differs(folder / "none.csv", digest) and seen.flaw(folder / "none.h5")


def test_a_list_of_another_folder_or_of_no_form_counts_for_nothing(folder, tmp_path):
    seen.note(folder, {"a.h5": ""})
    shutil.copytree(folder, tmp_path / "copy")
    (tmp_path / "copy" / "a.h5").write_bytes(b"other" + (folder / "a.h5").read_bytes())
    assert seen.flaw(tmp_path / "copy" / "a.h5") == checksum.WRONG
    for text in ("[" * 9999, "[]", '{"a.h5": 7}', "\0"):
        (folder / seen.LIST).write_text(text)
        assert seen.flaw(folder / "a.h5") == ""

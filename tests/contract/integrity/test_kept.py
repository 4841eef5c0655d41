"""Results of tasks that outlive a killed run: never computed again, never believed of somebody else."""

import os
import signal
from functools import partial

import numpy as np
import pytest

from pipeline.contract import Context
from pipeline.contract.integrity import kept


@pytest.fixture(autouse=True)
def _everything_is_worth_keeping(monkeypatch):
    monkeypatch.setattr(kept, "_SHORTEST", 0.0)


def task(folder, last, item):
    """The square of an item; its call is noted in ``folder``; after ``last`` calls this process dies at once."""
    if len(os.listdir(folder)) == last:
        os.kill(os.getpid(), signal.SIGKILL)
    (folder / f"{item}-{os.getpid()}").touch()
    return {"square": np.float64(item) ** 2, "items": np.arange(item)[::2]}


def rounds(tmp_path, last=None, fingerprint=b"one"):
    """Two rounds of 4 and 3 tasks, as a stage makes them in a run of one fingerprint."""
    (tmp_path / "calls").mkdir(exist_ok=True)
    context = Context(kept=kept.Kept(tmp_path / "kept", fingerprint, tmp_path / "home"))
    return [context.map(partial(task, tmp_path / "calls", last), items) for items in ((1, 2, 3, 4), (5, 6, 7))], context


def calls(tmp_path):
    return sorted(int(name.split("-")[0]) for name in os.listdir(tmp_path / "calls"))


def killed(tmp_path, last):
    """``rounds`` in a process that is killed after ``last`` calls."""
    child = os.fork()
    if not child:
        try:
            rounds(tmp_path, last)
        finally:
            os._exit(1)
    assert os.WTERMSIG(os.waitpid(child, 0)[1]) == signal.SIGKILL


def test_a_run_that_is_killed_at_any_task_computes_none_of_its_results_again(tmp_path):
    for last in (2, 3, 6):
        killed(tmp_path, last)
        assert len(calls(tmp_path)) == last
    results, context = rounds(tmp_path)
    assert calls(tmp_path) == [1, 2, 3, 4, 5, 6, 7]
    (tmp_path / "other").mkdir()
    undisturbed = rounds(tmp_path / "other")[0]
    for one, other in zip(sum(results, []), sum(undisturbed, []), strict=True):
        assert one["square"] == other["square"] and np.array_equal(one["items"], other["items"])
        assert one["items"].flags.c_contiguous and other["items"].flags.c_contiguous
    context.kept.forget()
    assert not (tmp_path / "kept").exists()


def test_what_another_fingerprint_or_another_user_kept_is_not_believed(tmp_path):
    rounds(tmp_path)
    for fingerprint, key in ((b"another", True), (b"another", False)):
        for name in os.listdir(tmp_path / "calls"):
            (tmp_path / "calls" / name).unlink()
        if not key:
            (tmp_path / "home" / "key_of_kept_results").unlink()
        rounds(tmp_path, fingerprint=fingerprint)
        assert len(calls(tmp_path)) == 7


def test_damaged_moved_and_linked_files_are_not_believed(tmp_path):
    rounds(tmp_path)
    folder = tmp_path / "kept"
    content = (folder / "1-0").read_bytes()
    (folder / "1-0").write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    (folder / "1-1").write_bytes((folder / "1-2").read_bytes())
    os.rename(folder / "1-3", tmp_path / "elsewhere")
    os.symlink(tmp_path / "elsewhere", folder / "1-3")
    for name in os.listdir(tmp_path / "calls"):
        (tmp_path / "calls" / name).unlink()
    assert [each["square"] for each in rounds(tmp_path)[0][0]] == [1, 4, 9, 16]
    assert calls(tmp_path) == [1, 2, 4]


def test_short_tasks_and_large_results_are_not_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_LARGEST", 100)
    context = Context(kept=kept.Kept(tmp_path / "kept", b"one", tmp_path / "home"))
    context.map(np.zeros, [1, 1000])
    assert os.listdir(tmp_path / "kept") == ["1-0"]
    monkeypatch.setattr(kept, "_SHORTEST", 10.0)
    context.map(np.zeros, [1])
    assert os.listdir(tmp_path / "kept") == ["1-0"]


def test_a_folder_that_is_a_link_is_removed_and_not_followed(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    os.symlink(tmp_path / "elsewhere", tmp_path / "kept")
    rounds(tmp_path)
    assert not os.listdir(tmp_path / "elsewhere") and len(os.listdir(tmp_path / "kept")) == 7

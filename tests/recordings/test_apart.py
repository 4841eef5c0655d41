"""Readers in a process of their own: the same contents, and one sentence for what stops them."""

import os
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from pipeline.contract import ConfigError
from pipeline.contract.received import process
from pipeline.recordings import apart
from tests.recordings import test_neutral, test_uff
from tests.recordings.files_of_others import SINE, mdf, sound, tdms

pytestmark = pytest.mark.apart

HOSTILE = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "hostile"


def test_the_contents_are_those_of_the_reader(tmp_path):
    savemat(tmp_path / "a.mat", {"x": SINE})
    for kind, path, name in (("matlab", tmp_path / "a.mat", "x"), ("audio", sound(tmp_path / "a.wav"), "1"),
                             ("tdms", tdms(tmp_path / "a.tdms"), "bench/pad"), ("mdf", mdf(tmp_path / "a.mf4"), "pad")):
        found = apart.waveforms(kind, path)
        np.testing.assert_allclose(found[name].values, SINE, atol=2**-22)
    assert found["line"].unit == "bar" and found["line"].stamp is not None
    np.testing.assert_allclose(found["disc speed"].times, (np.arange(10) / 10) ** 2)
    assert apart.waveforms("tdms", tmp_path / "a.tdms")["bench/note"].remark == "it holds no numbers"
    found = apart.runs("uff", test_uff.write(tmp_path / "a.uff", ordinate_axis_units_lab="NONE"), units={"acc_1": "g"})
    assert found["file"].channels["acc_1"].samples[1] == pytest.approx(9.80665)
    test_neutral.write(tmp_path / "c.h5")
    assert list(apart.runs("hdf5", tmp_path / "c.h5")) == ["first"]


def test_errors_of_readers_come_through(tmp_path):
    (tmp_path / "a.wav").write_text("hello")
    with pytest.raises(ConfigError, match="expected a sound file, found Error opening") as error:
        apart.waveforms("audio", tmp_path / "a.wav")
    assert error.value.where == str(tmp_path / "a.wav")


@pytest.mark.parametrize("code, told", [
    ("import os; os.kill(os.getpid(), 11)", r"one that stops its reader \(exit code -11\)"),
    ("while True: pass", "expected a file that is read within 1 s, found a reader that is not done"),
    ("bytearray(10**12)", "expected a file that is read within .* GB, found one that needs more"),
    ("raise KeyError('x')", "expected an undamaged file, found KeyError: 'x'")])
def test_what_a_reader_does_not_survive_is_one_sentence(tmp_path, monkeypatch, code, told):
    """A reader that crashes, never ends, asks for all memory or stumbles: put in place of that of sound files."""
    (tmp_path / "sitecustomize.py").write_text("import pipeline.recordings.audio as a\n"
                                               f"def read(path, folder):\n    {code}\n"
                                               "a.read_audio = read\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    if "while" in code:
        monkeypatch.setattr(process, "_SECONDS", 1)     # which libraries alone may take
    with pytest.raises(ConfigError, match=told):
        apart.waveforms("audio", sound(tmp_path / "a.wav"))


def test_a_file_in_the_folder_of_the_data_is_not_run(tmp_path, monkeypatch):
    """Nor one of the current folder: a received folder holds data, no code."""
    monkeypatch.chdir(tmp_path)
    for name in ("numpy.py", "json.py", "pickle.py"):
        (tmp_path / name).write_text("open('harm', 'w')\nraise SystemExit(7)\n")
    assert apart.waveforms("audio", sound(tmp_path / "a.wav"))["1"].rate == 48000.0
    assert not (tmp_path / "harm").exists()


def test_only_regular_files_are_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe.wav")
    for path in (tmp_path / "pipe.wav", tmp_path, tmp_path / "none.wav"):
        with pytest.raises(ConfigError, match="expected a regular file, found"):
            apart.waveforms("audio", path)


@pytest.mark.measured
@pytest.mark.parametrize("name", ["crash_v5_a.mat", "crash_v5_b.mat", "internal_v73.mat", "internal_21.h5",
                                  "internal_28.h5", "internal_30.h5", "internal_39.h5", "internal_4.h5",
                                  "byte_lost_58b.uff"])
def test_damaged_files_give_one_sentence(name):
    if not HOSTILE.is_dir():
        pytest.skip("set BRAKECHAIN_DATA to the folder of the public recordings")
    kind = {"mat": "matlab", "h5": "hdf5", "uff": "uff"}[name.rpartition(".")[2]]
    with pytest.raises(ConfigError) as error:
        (apart.waveforms if kind == "matlab" else apart.runs)(kind, HOSTILE / name)
    assert len(str(error.value)) < 600 and "expected" in str(error.value)


def test_data_of_another_file_are_refused(tmp_path):
    """External links, external storage and virtual data would read any file into samples."""
    (tmp_path / "secret").write_bytes(np.arange(8.0).tobytes())
    with h5py.File(tmp_path / "other.h5", "w") as h5:
        h5["x"] = np.arange(3.0)
    for name, make in (("link", lambda h5: h5.__setitem__("x", h5py.ExternalLink(str(tmp_path / "other.h5"), "x"))),
                       ("stored", lambda h5: h5.create_dataset("x", (8,), "f8", external=[
                           (str(tmp_path / "secret"), 0, 64)])),
                       ("virtual", lambda h5: h5.create_virtual_dataset("x", _layout(tmp_path / "other.h5")))):
        path = tmp_path / f"{name}.mat"
        with h5py.File(path, "w", userblock_size=512) as h5:
            make(h5)
        with open(path, "r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file, Platform: any")
        with pytest.raises(ConfigError, match="/x: expected data of this file, found data of another one"):
            apart.waveforms("matlab", path)


def _layout(other):
    layout = h5py.VirtualLayout((3,), "f8")
    layout[:] = h5py.VirtualSource(str(other), "x", (3,))
    return layout


def test_what_a_reader_says_does_not_fill_the_memory(tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text("import pipeline.recordings.audio as a\ndef read(path, folder):\n"
                                               "    import os\n    for _ in range(3000):\n"
                                               "        os.write(2, b'\\xff' * 10000)\n    os._exit(3)\n"
                                               "a.read_audio = read\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(ConfigError, match="one that stops its reader") as error:
        apart.waveforms("audio", sound(tmp_path / "a.wav"))
    assert len(str(error.value)) < 1000


def test_columns_of_any_kind_of_file(tmp_path):
    savemat(tmp_path / "a.mat", {"x": SINE})
    (tmp_path / "a.csv").write_text("x,y\n1,2\n3,4\n")
    np.testing.assert_array_equal(apart.waveforms("columns", tmp_path / "a.mat")["x"].values, SINE)
    assert apart.waveforms("columns", tmp_path / "a.csv")["y"].values.tolist() == [2.0, 4.0]

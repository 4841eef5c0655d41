"""Sound files of libsndfile and SciPy."""

import numpy as np
import pytest
from scipy.io import wavfile

from pipeline.contract import ConfigError
from pipeline.recordings.audio import read_audio, write_audio
from tests.recordings.files_of_others import SINE, sound


@pytest.mark.parametrize("name, subtype, error", [("a.wav", "PCM_16", 2**-15), ("a.wav", "PCM_24", 2**-23),
                                                  ("a.wav", "FLOAT", 1e-7), ("a.flac", "PCM_24", 2**-23)])
def test_channels_in_shares_of_full_scale(tmp_path, name, subtype, error):
    found = read_audio(sound(tmp_path / name, 0.9 * SINE, -0.4 * SINE, subtype=subtype))
    assert list(found) == ["1", "2"] and {(w.rate, w.unit, w.begin) for w in found.values()} == {(48000.0, "", 0.0)}
    np.testing.assert_allclose(found["1"].values, 0.9 * SINE, atol=error)
    np.testing.assert_allclose(found["2"].values, -0.4 * SINE, atol=error)


def test_files_of_scipy(tmp_path):
    wavfile.write(tmp_path / "a.wav", 44100, np.array([0, 2**14, -2**15], np.int16))
    assert read_audio(tmp_path / "a.wav")["1"].values.tolist() == [0, 0.5, -1]


def test_what_is_written_is_read(tmp_path):
    write_audio(tmp_path / "a.wav", {"mic": (3 * SINE, 48000.0), "pad": (SINE, 48000.0)}, 4.0)
    found = read_audio(tmp_path / "a.wav")
    np.testing.assert_allclose(4 * found["1"].values, 3 * SINE, atol=4 * 2**-23)
    assert wavfile.read(tmp_path / "a.wav")[0] == 48000


@pytest.mark.parametrize("channels, told", [({"a": (5 * SINE, 48000.0)}, "expected samples up to 4, found 4.9"),
                                            ({"a": (SINE, 48000.0), "b": (SINE, 100.0)}, "of one whole sampling rate")])
def test_what_a_wav_file_cannot_hold_is_refused(tmp_path, channels, told):
    with pytest.raises(ConfigError, match=told):
        write_audio(tmp_path / "a.wav", channels, 4.0)
    assert not (tmp_path / "a.wav").exists()


@pytest.mark.parametrize("name", ["a.wav", "a.flac"])
@pytest.mark.parametrize("share", [0.3, 0.6, 0.95, 0.999])
def test_a_file_that_is_cut_off_is_refused(tmp_path, name, share):
    path = sound(tmp_path / name)
    path.write_bytes(path.read_bytes()[:int(share * path.stat().st_size)])
    with pytest.raises(ConfigError, match="a sound file|bytes of samples|samples, found"):
        read_audio(path)


@pytest.mark.parametrize("content", [b"", b"hello", b"RIFF\x00"])
def test_what_is_no_sound_file_is_refused(tmp_path, content):
    (tmp_path / "a.wav").write_bytes(content)
    with pytest.raises(ConfigError, match="expected a sound file"):
        read_audio(tmp_path / "a.wav")


def broadcast(path, described):
    """A Broadcast Wave File: a chunk bext of so many bytes before the samples of a file of libsndfile."""
    content = sound(path).read_bytes()
    chunk = b"bext" + len(described).to_bytes(4, "little") + described
    riff = content[:4] + (len(content) - 8 + len(chunk)).to_bytes(4, "little") + content[8:12]
    path.write_bytes(riff + chunk + content[12:])
    return path


@pytest.mark.parametrize("samples, seconds, step", [(48000 * 3600 * 12 + 24000, 43200.5, 1 / 48000), (0, 43201.0, 1.0)])
def test_a_broadcast_wave_file_tells_when_it_began(tmp_path, samples, seconds, step):
    """By its samples since midnight, or to a second by its time of day (EBU Tech 3285)."""
    described = bytes(320) + b"2026-05-0412:00:01" + samples.to_bytes(8, "little") + bytes(256)
    found = read_audio(broadcast(tmp_path / "a.wav", described))["1"]
    midnight = np.datetime64("2026-05-04").astype("datetime64[s]").astype(int)
    assert found.stamp == (midnight + seconds, step) and len(found.values) == len(SINE)


@pytest.mark.parametrize("described", [b"", bytes(602), b"x" * 602])
def test_a_description_without_a_date_tells_none(tmp_path, described):
    assert read_audio(broadcast(tmp_path / "a.wav", described))["1"].stamp is None

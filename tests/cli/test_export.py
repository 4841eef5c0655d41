"""'brakechain data export': what is exported is read again."""

import numpy as np
import pytest
from click.testing import CliRunner

from pipeline.cli.export import KINDS, export
from pipeline.contract import store
from pipeline.contract.errors import BrakechainError
from pipeline.products import Recording, Run
from pipeline.recordings import apart
from pipeline.recordings.samples import channel
from pipeline.recordings.tables.text import read_table

VALUES = np.sin(0.1 * np.arange(400))


@pytest.fixture
def recording(tmp_path):
    channels = {"mic": channel(2 * VALUES, "Pa", "sound_pressure", 48000.0, 0.0, "mic"),
                "pad": channel(VALUES, "m/s^2", "acceleration", 48000.0, 0.0, "pad")}
    path = tmp_path / "recording.h5"
    store.write(Recording(source=[], runs={"stop": Run(description="", repeat_of="", channels=channels)}), path, {})
    return path


def exported(recording, name, *options):
    done = CliRunner().invoke(export, [str(recording), str(recording.with_name(name)), *options], standalone_mode=False)
    if done.exception:
        raise done.exception
    return recording.with_name(name)


@pytest.mark.parametrize("suffix", KINDS)
def test_every_kind_is_read_again(recording, suffix):
    path = exported(recording, f"out{suffix}", *(("--full-scale", "2") if suffix == ".wav" else ()))
    if suffix == ".wav":
        found = dict(zip(("mic", "pad"), (2 * w.values for w in apart.waveforms("audio", path).values()), strict=True))
    elif suffix == ".csv":
        found = read_table(path)
    else:
        kind = "hdf5" if suffix == ".h5" else "uff"
        found = {name: c.samples for name, c in next(iter(apart.runs(kind, path).values())).channels.items()}
    np.testing.assert_allclose(found["mic"], 2 * VALUES, atol=1e-6)
    np.testing.assert_allclose(found["pad"], VALUES, atol=1e-6)


def test_channels_and_full_scale_can_be_chosen(recording):
    path = exported(recording, "out.wav", "--channels", "pad", "--full-scale", "4", "--run", "stop")
    (found,) = apart.waveforms("audio", path).values()
    np.testing.assert_allclose(4 * found.values, VALUES, atol=1e-6)


@pytest.mark.parametrize("name, options, told", [
    ("out.xls", (), "a name that ends in .uff"), ("out.wav", ("--run", "no"), "--run: expected one of stop"),
    ("out.wav", ("--channels", "no"), "some of mic, pad, found no"),
    ("out.wav", ("--full-scale", "1"), "expected samples up to 1")])
def test_what_cannot_be_exported_is_refused(recording, name, options, told):
    with pytest.raises(BrakechainError, match=told):
        exported(recording, name, *options)


def test_sound_of_channels_that_begin_apart_is_refused(tmp_path):
    channels = {name: channel(VALUES, "Pa", "sound_pressure", 48000.0, begin, name)
                for name, begin in (("mic", 0.0), ("late", 1.5))}
    path = tmp_path / "recording.h5"
    store.write(Recording(source=[], runs={"stop": Run(description="", repeat_of="", channels=channels)}), path, {})
    with pytest.raises(BrakechainError, match="channels that begin at one instant, found 0 s to 1.5 s"):
        exported(path, "out.wav")
    assert exported(path, "out.wav", "--channels", "late").exists()

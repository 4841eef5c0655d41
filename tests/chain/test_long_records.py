"""Records of any length go through the chain in the memory of a few blocks."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.chain.resident_memory import peaks
from tests.commands import ROOT

RATE = 51200
#: channels of a file, and their amplitudes
CHANNELS = {"mic_1": ("Pa", 1.0), "mic_2": ("Pa", 0.5), "pad_1": ("m/s^2", 200.0), "pad_2": ("m/s^2", 100.0)}
#: length of the blocks that files are written in [s], each with a squeal in its middle
BLOCK = 20
#: MB that all processes together may take at one time
MOST = 500.0


def blocks(seconds):
    """Blocks (sample, channel) in float32 with 2 s of squeal in each."""
    random, time = np.random.default_rng(1), np.arange(BLOCK * RATE) / RATE
    squeal = np.sin(2 * np.pi * 3150 * time) * (abs(time - 10) < 1)
    for _ in range(0, seconds, BLOCK):
        noise = 0.02 * random.standard_normal((len(time), len(CHANNELS)))
        yield (noise + squeal[:, None] * [size for _, size in CHANNELS.values()]).astype(np.float32)


def audio(path, seconds):
    import soundfile

    with soundfile.SoundFile(str(path), "w", RATE, len(CHANNELS), "FLOAT", format="WAV") as file:
        for block in blocks(seconds):
            file.write(block / 1000)
    columns = [f"{name}: {{column: '{k + 1}', unit: {unit}, factor: 1000}}"
               for k, (name, (unit, _)) in enumerate(CHANNELS.items())]
    return f"{{kind: audio, file: {path.name}, columns: {{{', '.join(columns)}}}}}"


def mdf(path, seconds):
    import asammdf

    with asammdf.MDF(version="4.10") as file:
        for k, block in enumerate(blocks(seconds)):
            time, columns = k * BLOCK + np.arange(len(block)) / RATE, np.ascontiguousarray(block.T)
            if k == 0:
                file.append([asammdf.Signal(values, time, unit=unit, name=name)
                             for values, (name, (unit, _)) in zip(columns, CHANNELS.items(), strict=True)],
                            common_timebase=True)
            else:
                file.extend(0, [(values, None) for values in (time, *columns)])
        file.save(str(path), overwrite=True)
    return f"{{kind: mdf, file: {path.name}}}"


def tdms(path, seconds):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        for block in blocks(seconds):
            writer.write_segment([ChannelObject("bench", name, values, properties={
                "wf_increment": 1 / RATE, "wf_start_offset": 0.0, "unit_string": unit})
                for values, (name, (unit, _)) in zip(block.T, CHANNELS.items(), strict=True)])
    return f"{{kind: tdms, file: {path.name}}}"


SUFFIX = {audio: ".wav", mdf: ".mf4", tdms: ".tdms"}


def run(folder, write, seconds, *more):
    """``peaks`` of the chain on a record of so many seconds."""
    folder.mkdir()
    file = write(folder / f"long{SUFFIX[write]}", seconds)
    (folder / "case.yaml").write_text(f"chain: recording\ntitle: long\nrecording:\n  files: [{file}]\n")
    return peaks([sys.executable, "-m", "pipeline", "run", folder / "case.yaml", "--run", folder / "run", "--workers",
                  2, *more], cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)})


def events(folder):
    """(channel, kind, frequency, begin) of the events of a run."""
    lines = [line.split(",") for line in (folder / "run" / "noise_events.csv").read_text().splitlines()[1:]]
    return [(channel.removeprefix("bench_"), kind, round(float(frequency)), round(float(begin), 1))
            for _, channel, kind, frequency, _, _, _, begin, *_ in lines]


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from /proc")
@pytest.mark.parametrize("write", [audio, *(pytest.param(each, marks=pytest.mark.study) for each in (mdf, tdms))])
def test_memory_does_not_grow_with_the_record(tmp_path, write):
    """Six minutes of four channels (295 MB as WAV, 442 MB as MDF) beside one: import, events and page."""
    short, long = run(tmp_path / "short", write, 60), run(tmp_path / "long", write, 360)
    print(f"{write.__name__}: MB of the largest process and of all together: {short} of 1 minute, {long} of 6")
    assert long[1] < MOST
    assert long[0] - short[0] < 40 and long[1] - short[1] < 60
    expected = [(name, "squeal", 3150, BLOCK * k + 9.0) for name in CHANNELS for k in range(18)]
    assert events(tmp_path / "long") == expected

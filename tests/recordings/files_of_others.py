"""Files of measurement systems, written by the libraries of others."""

import numpy as np

RATE = 51200.0
SINE = np.sin(0.1 * np.arange(1000))


def sound(path, *columns, rate=48000, subtype="PCM_24"):
    import soundfile

    soundfile.write(str(path), np.column_stack(columns or (SINE, 0.5 * SINE)), rate, subtype=subtype)
    return path


def tdms(path, **more):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        told = {"wf_increment": 1 / RATE, "wf_start_offset": 0.5, "unit_string": "g"} | more
        writer.write_segment([ChannelObject("bench", "pad", SINE, properties=told),
                              ChannelObject("bench", "note", np.array(["a", "b"], dtype=object))])
    return path


def mdf(path):
    import asammdf

    fast, slow = np.arange(1000) / RATE, np.arange(10) / 10
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(SINE, fast, unit="m/s2", name="pad"),
                     asammdf.Signal(np.arange(1000, dtype="i2"), fast, unit="bar", name="line")])
        file.append([asammdf.Signal(np.linspace(20, 80, 10), slow, unit="degC", name="disc")])
        file.append([asammdf.Signal(np.linspace(10, 0, 10), slow**2, unit="rad/s", name="disc speed")])
        file.save(str(path), overwrite=True)
    return path

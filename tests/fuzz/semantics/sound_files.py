"""Planted facts in sound files by soundfile: full scale, calibrators, sign, rates, and two recorders of one stop."""

import io
import struct

import numpy as np

from tests.fuzz.mutation import draw
from tests.fuzz.semantics.channel_files import written
from tests.fuzz.semantics.planted import Meant, Planted, column, cut, signal
from tests.fuzz.trial import Trial

_RATES = (8000, 11025, 16000, 22050, 44100, 48000, 51200, 96000)
#: form -> steps of its numbers to full scale, None of floats
_FORMS = {("WAV", "PCM_16"): 2**15, ("WAV", "PCM_24"): 2**23, ("WAV", "PCM_32"): 2**31, ("WAV", "PCM_U8"): 2**7,
          ("WAV", "FLOAT"): None, ("WAV", "DOUBLE"): None, ("FLAC", "PCM_16"): 2**15, ("FLAC", "PCM_24"): 2**23,
          ("AIFF", "PCM_16"): 2**15, ("RF64", "PCM_24"): 2**23, ("CAF", "FLOAT"): None, ("W64", "PCM_24"): 2**23,
          ("AU", "PCM_32"): 2**31, ("WAVEX", "PCM_16"): 2**15}
#: channel of a sound file -> its unit at a factor of 1, and what it measures
_HEARD = (("Pa", "sound_pressure", 1.0, "Pa"), ("m/s^2", "acceleration", 1.0, "m/s^2"),
          ("G", "acceleration", 9.80665, "m/s^2"), ("mm/s", "velocity", 1e-3, "m/s"), ("V", "voltage", 1.0, "V"),
          ("bar", "pressure", 1e5, "Pa"), ("Pa", "pressure", 1.0, "Pa"), ("mV", "voltage", 1e-3, "V"))


def sound(values, rate, form, subtype):
    """Bytes of a sound file of values (sample, channel) in shares of full scale."""
    import soundfile

    stream = io.BytesIO()
    soundfile.write(stream, values, rate, format=form, subtype=subtype)
    return stream.getvalue()


def _shares(rng, count, steps):
    """Samples (sample,) below full scale, as the form holds them."""
    values = signal(rng, count)
    values = 0.9 * rng.random() * values / np.abs(values).max()
    return values if steps is None else np.rint(values * steps) / steps


def audio(rng):
    """Channels with factors, units and calibrators; one may be overloaded."""
    (form, subtype), steps = draw(rng, list(_FORMS.items()))
    rate, count = int(draw(rng, _RATES)), int(rng.integers(100, 800))
    columns, stated, meant, others = [], {}, {}, ()
    for k in range(int(rng.integers(1, 4))):
        shares = _shares(rng, count, steps)
        columns.append(shares)
        name, exact = f"mic_{k}", 2e-6 if subtype == "FLOAT" else 1e-6
        if rng.random() < 0.25:
            gain, level = float(10 ** rng.uniform(-1, 2)), float(draw(rng, (94.0, 114.0, 124.0)))
            others += ((f"cal{k}.wav", _calibrator(rng, gain, level, rate)),)
            stated[name] = {"column": str(k + 1), "calibrator": {"file": f"cal{k}.wav"} | (
                {} if level == 94.0 else {"level": level})}
            meant[name] = Planted(gain * shares, "Pa", rate, exact=2e-3)
            continue
        unit, measured, size, si = draw(rng, _HEARD)
        factor = float(f"{draw(rng, (1, 1, -1)) * 10 ** rng.uniform(-1, 2):.4g}")
        stated[name] = {"column": str(k + 1), "unit": unit, "factor": factor, "measures": measured}
        meant[name] = Planted(size * factor * shares, si, rate, exact=exact)
    content = sound(np.column_stack(columns), rate, form, subtype)
    file, meant = cut(rng, {"kind": "audio", "columns": stated, "runs": {"a": {}}}, meant)
    return Trial("a.wav", content, f"full scale, calibrators of {form} {subtype}", {"files": [file], "others": others},
                 Meant({"a": meant}), "read")


def overloaded(rng):
    """A tone whose recorder was driven beyond its range: its levels are lower bounds, as a remark tells."""
    (form, subtype), steps = draw(rng, list(_FORMS.items()))
    rate, count, factor = int(draw(rng, _RATES)), 6000, float(f"{10 ** rng.uniform(-1, 2):.4g}")
    tone = float(rng.uniform(0.5, 2.0)) * np.sin(2 * np.pi * float(rng.uniform(0.02, 0.1)) * np.arange(count))
    tone += 1e-3 * rng.normal(size=count)
    largest = 1.0 if steps is None else 1.0 - 1.0 / steps
    cut_off = 1e-2 if np.abs(tone).max() > largest else 0.0       # .1 dB of a peak need not show
    planted = Planted(factor * tone, "Pa", rate, exact=cut_off + 2.0 / (steps or 2**23) + 1e-6,
                      assumed=(("samples", "overloaded"),))
    stated = {"kind": "audio", "runs": {"a": {}}, "columns": {"mic": {"column": "1", "unit": "Pa", "factor": factor,
                                                                      "measures": "sound_pressure"}}}
    return Trial("a.wav", sound(np.clip(tone, -1.0, largest), rate, form, subtype), "a tone at the end of the range",
                 {"files": [stated]}, Meant({"a": {"mic": planted}}), "read")


def _calibrator(rng, gain, level, rate):
    """A record of a calibrator, with silence before and after it, at ``gain`` Pa of full scale."""
    count = 2 * rate
    wave = 20e-6 * 10 ** (level / 20) * np.sqrt(2) / gain * np.sin(2 * np.pi * 1000 * np.arange(count) / rate)
    lead, tail = (int(rng.uniform(0, 0.2) * rate) for _ in range(2))
    wave[:lead], wave[count - tail:] = 0.0, 0.0
    return sound(wave, rate, "WAV", "DOUBLE")


def pair(rng):
    """Sound in a WAV file and another recorder's TDMS file or table: one stop, by an offset, stamps or both clocks."""
    rate, count = int(draw(rng, _RATES)), int(rng.integers(3000, 9000))
    shares = _shares(rng, count, 2**23)
    how = draw(rng, ("stated", "stated", "stamps"))
    begin = 946_684_800 + int(rng.integers(8 * 10**8)) + 0.25       # seconds since 1970
    content = sound(shares, rate, "WAV", "PCM_24")
    content = _broadcast(content, begin, rate) if how == "stamps" else content
    one = column(rng, 60, True, (1.0,), 0.0)
    slow = float(draw(rng, (50.0, 100.0, 20.0)))
    offset = round(float(rng.uniform(-0.8 * len(one.numbers) / slow, 0.8 * count / rate)), 6)
    if rng.random() < 0.5 or how == "stamps":
        other, stated = _in_tdms(one, slow, begin + offset if how == "stamps" else None), {"kind": "tdms"}
        named, name = one.stated("g/line", False), "b.tdms"
    else:
        rows = [f"{k / slow!r},{float(v)!r}" for k, v in enumerate(one.numbers)]
        other, stated = "\n".join(["time [s],line", *rows, ""]).encode(), {"kind": "table", "time": "time [s]"}
        named, name = one.stated("line"), "b.csv"
    first = {"kind": "audio", "runs": {"a": {}}, "columns": {"mic": {"column": "1", "unit": "Pa", "factor": 2.0,
                                                                     "measures": "sound_pressure"}}}
    second = stated | {"file": name, "runs": {"a": {}}, "columns": {"line": named}}
    second |= {"offset": f"{offset!r} s"} if how == "stated" else {}
    meant = {"mic": Planted(2.0 * shares, "Pa", rate),
             "line": Planted(one.true, one.si, slow, offset, instant=1.0 / rate)}
    return Trial("a.wav", content, f"two recorders, offset {how}",
                 {"files": [first, second], "others": ((name, other),)}, Meant({"a": meant}), "read")


def _in_tdms(one, rate, start):
    from nptdms import ChannelObject, TdmsWriter

    properties = {"wf_increment": 1 / rate, "unit_string": one.label} | (
        {} if start is None else {"wf_start_time": np.datetime64(round(1e6 * start), "us")})

    def write(path):
        with TdmsWriter(str(path)) as writer:
            writer.write_segment([ChannelObject("g", "line", one.numbers, properties=properties)])

    return written(write)


def _broadcast(content, begin, rate):
    """A Broadcast Wave File that began at ``begin`` s since 1970 (EBU Tech 3285)."""
    stamp = np.datetime64(int(begin), "s")
    day = stamp.astype("datetime64[D]")
    of_day = round((begin - day.astype("datetime64[s]").astype(int)) * rate)
    described = bytes(320) + str(stamp).replace("T", "").encode() + struct.pack("<Q", of_day) + bytes(256)
    chunk = b"bext" + struct.pack("<I", len(described)) + described
    return content[:4] + struct.pack("<I", len(content) - 8 + len(chunk)) + content[8:12] + chunk + content[12:]

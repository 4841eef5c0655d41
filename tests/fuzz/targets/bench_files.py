"""Universal, sound, TDMS and MDF files."""

import io
import struct
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from pipeline.products import Run
from pipeline.recordings.samples import channel
from pipeline.recordings.uff_writer import write_uff
from stages import recording
from tests.fuzz.mutation import damaged, draw, garbled
from tests.fuzz.targets.tables import EXPECTED, FORCE, MOVED, RATE, TIME, difference, read, right
from tests.fuzz.trial import Target, Trial

_COLUMNS = {
    "force": {"column": "force", "unit": "N", "measures": "force"},
    "moved": {"column": "moved", "unit": "m", "measures": "displacement"},
}
_RUNS = {"a": {}}


def _written(write):
    """Bytes that ``write(path)`` leaves."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        write(path)
        return path.read_bytes()


def _uff(path, **given):
    return read(path, recording.Uff, run="a", **given)


def _ascii(number, name, values, code, label, unit, wide=True, mark="\n"):
    """A data set 58 of text, as the definition has it: 80 columns, four numbers of 20 or six of 13 a line."""
    heads = [
        name,
        "NONE",
        "27-Nov-26 08:00:00",
        "NONE",
        "NONE",
        f"{1:5d}{0:10d}{0:5d}{0:10d} {name[:10]:<10s}{number:10d}{1:4d} {'NONE':<10s}{0:10d}{0:4d}",
        f"{4 if wide else 2:10d}{len(values):10d}{1:10d}{0.0:13.5e}{1 / RATE:13.5e}{0.0:13.5e}",
        f"{17:10d}{0:5d}{0:5d}{0:5d} {'Time':<20s} {'s':<20s}",
        f"{code:10d}{0:5d}{0:5d}{0:5d} {label:<20s} {unit:<20s}",
        *[f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20s} {'NONE':<20s}"] * 2,
    ]
    each, form = (4, "{:20.11e}") if wide else (6, "{:13.5e}")
    rows = ["".join(form.format(v) for v in values[k : k + each]) for k in range(0, len(values), each)]
    return mark.join(["    -1", "    58", *heads, *rows, "    -1", ""]).encode()


def _record(rng):
    """The two channels of a record, in an order and in units drawn at random."""
    force, length = draw(rng, (("N", 1.0), ("kN", 1e3), ("mN", 1e-3))), draw(rng, (("m", 1.0), ("mm", 1e-3)))
    sets = [
        ("force", FORCE / force[1], 13, "Force", force[0]),
        ("moved", MOVED / length[1], 8, "Displacement", length[0]),
    ]
    return sets if rng.random() < 0.5 else sets[::-1]


@cache
def _binary(reverse=False):
    made = {
        "force": channel(FORCE, "N", "force", RATE, 0.0, ""),
        "moved": channel(MOVED, "m", "displacement", RATE, 0.0, ""),
    }
    made = dict(reversed(made.items())) if reverse else made
    return _written(lambda path: write_uff(path, Run(description="", repeat_of="", channels=made)))


def _system(factor):
    """Data set 164: units of the file, ``factor`` to a metre."""
    return (
        f"    -1\n   164\n{5 if factor != 1 else 1:10d}{'mm (milli-newton)':<20s}{2:10d}\n"
        f"{factor:25.17e}{1.0:25.17e}{1.0:25.17e}\n{273.15:25.17e}\n    -1\n"
    ).encode()


def _uff_damaged(rng):
    if rng.random() < 0.4:
        return Trial("a.uff", damaged(rng, _binary()))
    content = b"".join(_ascii(k, *one, wide=rng.random() < 0.7) for k, one in enumerate(_record(rng), 1))
    return Trial(
        "a.uff",
        garbled(rng, _system(1e3) * int(draw(rng, (0, 1))) + content),
        given=draw(rng, ({}, {}, {"units": {"force": "N"}})),
    )


def _uff_arranged(rng):
    form = draw(rng, ("ascii", "ascii", "ascii", "binary", "system"))
    if form == "binary":
        content = _binary(bool(rng.random() < 0.5))
        content = content.replace(b"    -1\n    58b", b"\n    -1\n    58b") if rng.random() < 0.5 else content
    elif form == "system":
        content = _system(1e3) + b"".join(
            _ascii(k, name, values, code, label, "NONE")
            for k, (name, values, code, label) in enumerate(
                (("force", FORCE, 13, "Force"), ("moved", MOVED * 1e3, 8, "Displacement")), 1
            )
        )
    else:
        mark, wide = draw(rng, ("\n", "\r\n")), bool(rng.random() < 0.7)
        content = b"".join(_ascii(k, *one, wide=wide, mark=mark) for k, one in enumerate(_record(rng), 1))
    return Trial("a.uff", content, f"universal file, {form}", {}, right(tolerance=1e-5), "read")


def _uff_byte(rng):
    """A byte lost or added between the points of a binary data set is noticed."""
    content = _binary()
    first = sum(len(line) + 1 for line in content.split(b"\n")[:13])  # the mark, 12 lines of the head
    at = first + int(rng.integers(8 * len(FORCE)))
    changed = content[:at] + content[at + 1 :] if rng.random() < 0.5 else content[:at] + rng.bytes(1) + content[at:]
    return Trial("a.uff", changed, "a byte lost or added", must="refuse")


def _audio(path, **given):
    return read(path, recording.Waveforms, kind="audio", **given)


_SOUND = np.round(np.stack((FORCE / 64, 0.5 * np.cos(np.arange(len(FORCE))))), 4)


def _sound(values, form, subtype, endian=None):
    import soundfile

    stream = io.BytesIO()
    soundfile.write(stream, values.T, int(RATE), format=form, subtype=subtype, endian=endian)
    return stream.getvalue()


_FORMS = (
    ("WAV", "PCM_16"),
    ("WAV", "PCM_24"),
    ("WAV", "FLOAT"),
    ("WAV", "DOUBLE"),
    ("FLAC", "PCM_24"),
    ("AIFF", "PCM_16"),
    ("RF64", "PCM_24"),
    ("CAF", "FLOAT"),
    ("W64", "PCM_24"),
    ("FLAC", "PCM_16"),
    ("AU", "PCM_32"),
)


def _tracks(first="1", second="2"):
    return {
        "runs": _RUNS,
        "columns": {
            "left": {"column": first, "unit": "Pa", "factor": 64.0, "measures": "pressure"},
            "right": {"column": second, "unit": "Pa", "measures": "pressure"},
        },
    }


def _audio_damaged(rng):
    return Trial("a.wav", damaged(rng, _sound(_SOUND, *draw(rng, _FORMS))), given=_tracks())


def _heard(value):
    wanted = {"left": 64 * _SOUND[0], "right": _SOUND[1]}
    found = value["a"]["channels"]
    return difference({k: found[k]["samples"] for k in found}, wanted, 2.0**-14) or difference(
        [c["rate"] for c in found.values()], [RATE, RATE]
    )


def _audio_arranged(rng):
    turned = bool(rng.random() < 0.5)
    content = _sound(_SOUND[::-1] if turned else _SOUND, *draw(rng, _FORMS))
    return Trial("a.wav", content, "another form of sound", _tracks("2", "1") if turned else _tracks(), _heard, "read")


def _audio_chunks(rng):
    """Chunks of other programs before the samples of a WAV file."""
    content = _sound(_SOUND, "WAV", "PCM_24")
    body = rng.bytes(int(rng.integers(1, 9)) * 2)
    chunk = draw(rng, (b"LIST", b"bext", b"JUNK", b"iXML")) + struct.pack("<I", len(body)) + body
    content = content[:12] + chunk + content[12:]
    return Trial(
        "a.wav",
        content[:4] + struct.pack("<I", len(content) - 8) + content[8:],
        "other chunks",
        _tracks(),
        _heard,
        "read",
    )


def _audio_cut(rng):
    content = _sound(_SOUND, "WAV", draw(rng, ("PCM_16", "PCM_24", "FLOAT")))
    return Trial("a.wav", content[: int(rng.integers(len(content)))], "cut off", _tracks(), must="refuse")


def _tdms(path, **given):
    return read(path, recording.Waveforms, kind="tdms", **given)


@cache
def _in_tdms(order, kind, segments, group):
    from nptdms import ChannelObject, TdmsWriter

    def write(path):
        with TdmsWriter(str(path)) as writer:
            for part in np.array_split(np.arange(len(FORCE)), segments):
                writer.write_segment(
                    [
                        ChannelObject(
                            group,
                            name,
                            values[part].astype(kind),
                            properties={"wf_increment": 1 / RATE, "unit_string": unit, "wf_start_offset": 0.0},
                        )
                        for name, values, unit in (("force", FORCE, "N"), ("moved", MOVED, "m"))[::order]
                    ]
                )

    return _written(write)


_IN_TDMS = {"runs": _RUNS, "columns": {name: {**c, "column": f"bench/{name}"} for name, c in _COLUMNS.items()}}


def _tdms_damaged(rng):
    return Trial(
        "a.tdms", damaged(rng, _in_tdms(1, draw(rng, ("f8", "f4")), int(draw(rng, (1, 2, 3))), "bench")), given=_IN_TDMS
    )


def _tdms_arranged(rng):
    content = _in_tdms(draw(rng, (1, -1)), draw(rng, ("f8", "f4")), int(draw(rng, (1, 2, 3, 5))), "bench")
    return Trial("a.tdms", content, "order, precision, segments", _IN_TDMS, right(tolerance=1e-6), "read")


def _mdf(path, **given):
    return read(path, recording.Waveforms, kind="mdf", **given)


@cache
def _in_mdf(version, order, kind, packed, force=("N", 1.0)):
    import asammdf

    def write(path):
        with asammdf.MDF(version=version) as file:
            file.append(
                [
                    asammdf.Signal((values / size).astype(kind), TIME, unit=unit, name=name)
                    for name, values, unit, size in (("force", FORCE, *force), ("moved", MOVED, "m", 1.0))[::order]
                ]
            )
            made = file.save(str(path.with_suffix(".mf4")), overwrite=True, compression=packed)
        Path(made).rename(path)

    return _written(write)


def _mdf_damaged(rng):
    content = _in_mdf(draw(rng, ("4.10", "4.10", "3.30")), 1, "f8", 0)
    return Trial("a.mf4", damaged(rng, content), given={"runs": _RUNS, "columns": _COLUMNS})


def _mdf_arranged(rng):
    version, kind = draw(rng, ("4.10", "4.20", "3.30")), draw(rng, ("f8", "f4"))
    force = draw(rng, (("N", 1.0), ("kN", 1e3)))
    content = _in_mdf(version, draw(rng, (1, -1)), kind, 0 if version[0] == "3" else int(draw(rng, (0, 2))), force)
    given = {"runs": _RUNS, "columns": {"force": {**_COLUMNS["force"], "unit": None}, "moved": _COLUMNS["moved"]}}
    return Trial("a.mf4", content, "version, order, packing, unit", given, right(EXPECTED, 1e-6), "read")


TARGETS = (
    Target("uff", _uff, _uff_damaged, (_uff_arranged, _uff_arranged, _uff_byte), True),
    Target("audio", _audio, _audio_damaged, (_audio_arranged, _audio_chunks, _audio_cut), True),
    Target("tdms", _tdms, _tdms_damaged, (_tdms_arranged,), True),
    Target("mdf", _mdf, _mdf_damaged, (_mdf_arranged,), True),
)

"""Sound files: WAV, RF64, FLAC, AIFF and what else libsndfile reads. The door of soundfile."""

import re
import struct
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.mapped import Growing
from pipeline.recordings.waveform import Waveform, library, stamped

#: begins of RIFF files, little and big endian; RF64 and BW64 state their sizes in a chunk of their own
_RIFF = {b"RIFF": "<", b"RIFX": ">"}
#: kinds of samples that float32 does not hold exactly
_WIDE = ("PCM_32", "DOUBLE")
#: samples of each channel that are read at once
_BLOCK = 1 << 17
#: size of a data chunk that a program left open: it is not known
_OPEN = (0, 0xFFFFFFFF)
#: bytes of the chunk bext up to its samples since midnight, and before its date
_DESCRIBED, _DATE = 346, 320


def read_audio(path, folder=None):
    """{'1': Waveform, '2': ...} of the channels of a sound file, in shares of full scale (float files: as they are).

    ``folder``: for long channels, see ``Growing``. Raises ConfigError for a file that is no sound file, holds fewer
    samples than it declares or none.
    """
    sound = library("soundfile", "soundfile", path)
    described = _checked(path)
    try:
        with sound.SoundFile(str(path)) as file:
            declared, rate = file.frames, float(file.samplerate)
            exact = "float64" if file.subtype in _WIDE else "float32"
            columns = [Growing(exact, folder) for _ in range(file.channels)]
            while len(block := file.read(_BLOCK, exact, always_2d=True)):
                for column, values in zip(columns, block.T, strict=True):
                    column.append(values)
    except (sound.SoundFileError, RuntimeError, OSError, TypeError, ValueError) as error:
        raise ConfigError(path, "a sound file", str(error)) from None
    found = [column.array() for column in columns]
    if len(found[0]) < max(declared, 1):
        raise ConfigError(path, f"{max(declared, 1)} samples", f"{len(found[0])}", "the file is cut off: copy it again")
    stamp = _stamp(described, rate)
    return {str(k + 1): Waveform(values, "", rate, stamp=stamp) for k, values in enumerate(found)}


def write_audio(path, channels, full_scale):
    """Write {name: (samples (n,), rate in Hz)} of one rate as a WAV file of 24 bits.

    ``full_scale``: value of the samples at full scale. Raises ConfigError where one lies beyond it, and for channels of
    unlike rates or lengths.
    """
    sound = library("soundfile", "soundfile", path)
    samples, rates = zip(*channels.values(), strict=True) if channels else ((), ())
    if not channels or np.isnan(np.concatenate(samples)).any():
        raise ConfigError(path, "channels without gaps", "none" if not channels else "missing samples",
                          "choose some of the channels")
    if np.ptp(rates) > 1e-6 * rates[0] or len({len(s) for s in samples}) > 1 or (
            abs(rates[0] - round(rates[0])) > 1e-6 * rates[0]):
        raise ConfigError(path, "channels of one whole sampling rate and length",
                          f"{', '.join(f'{len(s)} at {r:g} Hz' for s, r in zip(samples, rates, strict=True))}",
                          "choose some of the channels")
    table = np.column_stack(samples) / full_scale
    if np.abs(table).max() > 1.0:
        raise ConfigError(path, f"samples up to {full_scale:g}", f"{np.abs(table).max() * full_scale:g}",
                          "raise the full scale")
    sound.write(str(path), table, round(rates[0]), subtype="PCM_24", format="WAV")


def _checked(path):
    """What the chunk bext of a Broadcast Wave File holds, b'' without one (EBU Tech 3285).

    Refuses a RIFF file whose data chunk declares more bytes than there are: libsndfile reads what it finds.
    """
    path, described = Path(path), b""
    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            order = _RIFF.get(file.read(12)[:4])
            while order and len(head := file.read(8)) == 8:
                length = struct.unpack(f"{order}I", head[4:])[0]
                if head[:4] == b"bext":
                    described = file.read(_DESCRIBED)
                    file.seek(-len(described), 1)
                if head[:4] == b"data" and length in _OPEN:
                    break
                if head[:4] == b"data" and file.tell() + length > size:
                    raise ConfigError(path, f"{length} bytes of samples", f"{size - file.tell()}",
                                      "the file is cut off: copy it again")
                file.seek(length + length % 2, 1)
    except OSError as error:
        raise ConfigError(path, "a readable sound file", str(error)) from None
    return described


def _stamp(described, rate):
    """Stamp of a Waveform by the chunk bext: date, and samples since midnight or else time of day; None without."""
    text = described[_DATE:_DATE + 18].decode("latin-1")
    try:
        date = datetime.strptime(re.sub(r"\D", "-", text[:10]), "%Y-%m-%d").replace(tzinfo=UTC)
        clock = [int(number) for number in re.split(r"\D", text[10:])]
    except ValueError:
        return None
    samples = struct.unpack_from("<Q", described, _DATE + 18)[0] if len(described) == _DESCRIBED else 0
    hours, minutes, seconds = clock if len(clock) == 3 else (0, 0, 0)
    of_day = samples / rate if samples else 3600 * hours + 60 * minutes + seconds
    found = stamped(round(1e6 * (date.timestamp() + of_day)))
    return found and (found[0], 1.0 / rate if samples else 1.0)

"""Stage noise_events: squeal and other noise in the recordings of a bench."""

import csv
import io
from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.contract.mapped import Slices, blocks
from pipeline.physics.signals.frames import frames
from pipeline.physics.signals.noise_events import Broadband, Tonal, tonal
from pipeline.physics.signals.spectra import HEARING, level
from pipeline.physics.signals.squeal_detector import Detector, Loudest
from pipeline.products import NoiseEvents, Recording, Spectrogram
from pipeline.recordings.samples import with_gaps


class Settings(Section):
    """What counts as squeal of a microphone, and as loud vibration of an accelerometer."""

    channels: tuple[str, ...] = option((), "microphones and accelerometers to search; none = all that measure sound"
                                       " pressure or acceleration, and pressures of the size of sound")
    lowest_frequency: Quantity("Hz", gt=0) = option("2 kHz", "begin of the squeal band; SAE J2521: 2 kHz, and 1.25 kHz"
                                                    " on a full suspension corner or axle")
    highest_frequency: Quantity("Hz", gt=0) = option("16 kHz", "end of the squeal band (SAE J2521)")
    threshold: float = option(70.0, "level that is squeal, dB(A) re 20 uPa (SAE J2521)", gt=0)
    vibration_threshold: Quantity("m/s^2", gt=0) = option("10 m/s^2", "effective acceleration of a tone that is told")
    window: Quantity("s", gt=0) = option("40 ms", "length of a frame; its inverse is the distance of the lines")
    overlap: float = option(0.75, "share of a frame that the next one repeats", ge=0.5, le=0.8)
    prominence: float = option(10.0, "height of a tone above the valleys beside it, dB", gt=0)
    above: float = option(12.0, "height of a tone above the median of the lines about it, dB", ge=0)
    dynamic_range: float = option(40.0, "a tone this far below the strongest is a side lobe of the window, dB", gt=0)
    drift: Quantity("Hz", gt=0) = option("40 Hz", "largest change of the frequency of an event from frame to frame")
    wander: float = option(0.03, "share by which the frequency of squeal may vary over an event, of a short one .5 %"
                           " and 1.5 % a second; more is a sweep", gt=0, lt=1)
    gap: Quantity("s", ge=0) = option("50 ms", "longest interruption of an event")
    shortest: Quantity("s", ge=0) = option("100 ms", "shortest event")
    low_threshold: float = option(80.0, "level of a tone below the squeal band that is told, dB re 20 uPa, not"
                                  " weighted", gt=0)
    low_window: Quantity("s", gt=0) = option("200 ms", "length of a frame for tones below the squeal band")
    lowest_tone: Quantity("Hz", gt=0) = option("20 Hz", "tones from here on are told")


#: acceleration of 0 dB [m/s^2] (ISO 1683)
_STILL = 1e-6
#: largest pressure in Pa that a microphone hears (160 dB); a line pressure is more
_SOUND = 2e3
#: conditions of an event: name, and what channels measure it
_CONDITIONS = {"pressure": ("pressure",), "speed": ("angular_velocity", "speed"), "temperature": ("temperature",)}
#: units of the conditions
_UNITS = {"pressure": "Pa", "speed": "rad/s", "temperature": "K"}
#: samples of a condition that are averaged at once
_AT_ONCE = 1 << 20
#: most frames and lines of a spectrogram that is kept for the page
_KEPT = 600, 320
_FIELDS = ("kind", "frequency", "lowest", "highest", "level", "start", "duration", "fundamental", "order")


def companions(product, case=None):
    """The table of events."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(("run", "channel", "kind", "frequency / Hz", "lowest / Hz", "highest / Hz", "level / dB",
                     "start / s", "duration / s", "order", *(f"{name} / {_UNITS[name]}" for name in product.condition)))
    for k, record in enumerate(product.event_record):
        writer.writerow((product.record_run[record], product.record_channel[record], product.event_kind[k],
                         *(f"{getattr(product, f'event_{name}')[k]:.6g}" for name in _FIELDS[1:7]),
                         product.event_order[k], *(f"{value:.6g}" if known else "" for value, known in zip(
                             product.event_condition[k], product.event_condition_known[k], strict=True))))
    return {"noise_events.csv": stream.getvalue()}


@stage(companions=companions)
def noise_events(recording: Recording, settings: Settings, context: Context) -> NoiseEvents:
    """Find squeal and other noise events in the recordings.

    Method:
    Squeal is a steady tone of at least {threshold} dB(A) between {lowest_frequency} and {highest_frequency} (SAE J2521:
    70 dB(A), 2 or 1.25 to 16 kHz) that lasts {shortest}, in Hann frames of {window}. A tone stands {above} dB above the
    median of the lines about it; harmonics of another tone, series of equidistant tones and tones whose frequency
    wanders by more than {wander} are told apart from it. A tone begins and ends where it passes half its median
    amplitude. Levels are those of the tones, A-weighted by the formula of IEC 61672-1. Noise without a tone counts by
    the level of the band without its strongest lines. Tones below the band are told from {low_threshold} dB on, not
    weighted; accelerometers from {vibration_threshold} on. No standard fixes the last two, nor the shortest event.
    """
    if settings.lowest_frequency >= settings.highest_frequency:
        raise ConfigError("noise_events.lowest_frequency", f"less than highest_frequency,"
                          f" {settings.highest_frequency:g} Hz", f"{settings.lowest_frequency:g} Hz")
    tasks = [(name, key, channel, kind) for name, run in recording.runs.items()
             for key, channel in run.channels.items() for kind in [_kind(key, channel, settings)] if kind]
    strange = set(settings.channels) - {key for run in recording.runs.values() for key in run.channels}
    if strange:
        raise ConfigError("noise_events.channels", "channels of the recording", ", ".join(sorted(strange)))
    found = context.map(partial(_searched, settings=settings), tasks, "noise events")
    for (name, key, *_), result in zip(tasks, found, strict=True):
        if isinstance(result, str):
            context.log(f"{name}, {key}: not searched: {result}")
    kept = [(task, result) for task, result in zip(tasks, found, strict=True) if not isinstance(result, str)]
    return _product(kept, recording, settings)


def _kind(name, channel, settings):
    """'sound', 'vibration', or '' of a channel that is not searched."""
    unit, asked = str(channel.unit), name in settings.channels
    if settings.channels and not asked:
        return ""
    if asked and unit not in ("Pa", "m/s^2"):
        raise ConfigError("noise_events.channels", "channels of sound pressure or acceleration", f"{name} in {unit}")
    if str(channel.measures) == "sound_pressure" or (unit == "Pa" and (asked or _heard(channel))):
        return "sound"
    return "vibration" if unit == "m/s^2" else ""


def _heard(channel):
    """Whether a pressure is that of sound: about 0, and of its size but for one sample in a thousand."""
    if str(channel.measures) not in ("pressure", "value"):
        return False
    parts = np.array([(np.sum(x, dtype=float), np.sum(np.square(x, dtype=float)), np.sum(np.abs(x) >= _SOUND))
                      for x in blocks(channel.samples)])
    mean, square, large = parts.sum(axis=0) / len(channel.samples)
    return bool(large <= 1e-3 and mean**2 <= square - mean**2)


def _searched(task, settings):
    """(events, level and frequency of the loudest tone, background level, Spectrogram) of a channel, or why not."""
    _, _, channel, kind = task
    rate, samples, begin = float(channel.rate), Slices(channel.samples), float(channel.begin)
    top = min(settings.highest_frequency, 0.45 * rate)
    if top <= 1.1 * settings.lowest_frequency:
        return f"its rate of {rate:g} Hz does not reach the squeal band"
    if len(samples) < 3 * settings.window * rate:
        return f"it is shorter than three frames of {settings.window:g} s"
    detector = _detector(settings, kind, (settings.lowest_frequency, top))
    found = frames(samples, rate, detector, np.float32)
    tones, noise = Tonal(found, detector, settings.wander), Broadband(found, detector)
    loudest, picture = Loudest(found, detector), _Picture(found, detector, top)
    found.scan(tones, noise, loudest, picture)
    events = tones.result() + (noise.result() if kind == "sound" else [])
    if len(samples) >= 3 * settings.low_window * rate:
        slow = _low_detector(settings, kind, rate)
        events += tonal(frames(samples, rate, slow, np.float32), slow, settings.wander, low=True)
    return events, loudest.result(), noise.background(), picture.result(begin), begin


def _detector(settings, kind, band):
    sound = kind == "sound"
    reference = HEARING if sound else _STILL
    threshold = settings.threshold if sound else float(level(settings.vibration_threshold**2, _STILL))
    return Detector(band, threshold, reference, settings.window, settings.overlap, settings.prominence,
                    settings.dynamic_range, settings.drift, settings.gap, settings.shortest,
                    min(4.0 / settings.window, band[0]), 0.05, 0.1, 0.33, sound, settings.above, 4)


def _low_detector(settings, kind, rate):
    sound = kind == "sound"
    threshold = settings.low_threshold if sound else float(level(settings.vibration_threshold**2, _STILL))
    return Detector((settings.lowest_tone, min(settings.lowest_frequency, 0.45 * rate)), threshold,
                    HEARING if sound else _STILL, settings.low_window, settings.overlap, settings.prominence,
                    settings.dynamic_range, settings.drift, 2 * settings.low_window, 2 * settings.low_window,
                    settings.lowest_tone, 0.05, 0.1, 0.33, False, settings.above, 0)


class _Picture:
    """Watches Frames for the largest levels over blocks of frames and lines, from 0 to a little above the band."""

    def __init__(self, found, detector, top):
        lines = np.flatnonzero(found.frequency <= 1.1 * top)
        self._across, self._along = (max(-(-n // most), 1) for n, most in (
            (len(lines), _KEPT[1]), (len(found.time), _KEPT[0])))
        self._found, self._reference = found, detector.reference
        self._largest = np.zeros((len(found.time) // self._along, len(lines) // self._across), np.float32)

    def see(self, first, spectra):
        """The next block of spectra (frame, line), from the frame ``first`` on."""
        rows, columns = self._largest.shape
        spectra = spectra[:max(rows * self._along - first, 0), :columns * self._across]
        if not len(spectra):
            return
        row = np.arange(first, first + len(spectra)) // self._along
        begins = np.flatnonzero(np.diff(row, prepend=-1))
        largest = np.maximum.reduceat(spectra.reshape(len(row), columns, self._across).max(axis=2), begins)
        self._largest[row[begins]] = np.maximum(self._largest[row[begins]], largest)

    def result(self, begin):
        """The Spectrogram of a record that begins at ``begin`` [s]."""
        (rows, columns), found = self._largest.shape, self._found
        return Spectrogram(time=begin + found.time[:rows * self._along].reshape(rows, -1).mean(axis=1),
                           frequency=found.frequency[:columns * self._across].reshape(columns, -1).mean(axis=1),
                           level=level(np.square(self._largest, dtype=float), self._reference))


def _product(kept, recording, settings):
    rows = [(k, event) for k, (_, (events, *_)) in enumerate(kept) for event in events]
    begins = [result[4] for _, result in kept]
    values = np.zeros((len(rows), len(_CONDITIONS)))
    known = np.zeros(values.shape, int)
    measured = {name: _measured(recording.runs[name]) for (name, *_), _ in kept}
    for j, (k, event) in enumerate(rows):
        run = kept[k][0][0]
        for i, name in enumerate(_CONDITIONS):
            value = _condition(measured[run][name], recording.runs[run].conditions.get(name), name,
                               begins[k] + event.start, event.duration)
            if value is not None:
                values[j, i], known[j, i] = value, 1
    columns = {name: [getattr(event, name) for _, event in rows] for name in _FIELDS}
    columns["start"] = [begins[k] + event.start for k, event in rows]
    return NoiseEvents(
        threshold=settings.threshold, band=[settings.lowest_frequency, settings.highest_frequency],
        record_run=[name for (name, *_), _ in kept], record_channel=[key for (_, key, *_), _ in kept],
        record_kind=[kind for (*_, kind), _ in kept], condition=list(_CONDITIONS),
        record_duration=[len(channel.samples) / float(channel.rate) for (_, _, channel, _), _ in kept],
        record_peak=[result[1][0] for _, result in kept], record_peak_frequency=[result[1][1] for _, result in kept],
        record_background=[result[2] for _, result in kept],
        spectrogram={f"{name}.{key}": result[3] for (name, key, *_), result in kept},
        event_record=[k for k, _ in rows], event_condition=values, event_condition_known=known,
        **{f"event_{name}": column for name, column in columns.items()})


def _measured(run):
    """{condition: [Channel]} of the channels of a Run that measure it."""
    return {name: [c for c in run.channels.values() if str(c.measures) in wanted and str(c.unit) == _UNITS[name]
                   and not (name == "pressure" and _heard(c))] for name, wanted in _CONDITIONS.items()}


def _condition(measured, stated, name, start, duration):
    """Mean of a condition over an event, by what ``_measured`` it, else as the run has ``stated`` it, or None."""
    for channel in measured:
        first, last = (int((t - float(channel.begin)) * float(channel.rate)) for t in (start, start + duration))
        mean = _mean(channel, max(first, 0), max(last, first + 1))
        if mean is not None:
            return mean
    if stated is None or str(stated.unit) != _UNITS[name]:
        return None
    return float(np.interp(start + duration / 2, stated.time, stated.value))


def _mean(channel, first, last):
    """Mean of the samples of a Channel from ``first`` up to ``last`` that are not missing; None of none."""
    total, count = 0.0, 0
    for begin in range(first, min(last, len(channel.samples)), _AT_ONCE):
        inside = with_gaps(channel, slice(begin, min(begin + _AT_ONCE, last)))
        total, count = total + np.nansum(inside), count + np.isfinite(inside).sum()
    return float(total / count) if count else None

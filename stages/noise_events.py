"""Stage noise_events: squeal and other noise in the recordings of a bench."""

import csv
import io
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from pipeline.case_models.named_modes import named_modes
from pipeline.contract import ConfigError, Context, InputFile, Quantity, Section, option, stage
from pipeline.contract.mapped import Slices, blocks
from pipeline.physics.signals.frames import frames
from pipeline.physics.signals.listening import LONGEST, RATE, excerpt
from pipeline.physics.signals.noise_events import Broadband, Tonal, clipped, tonal
from pipeline.physics.signals.occurrence import Conditions, even_edges, occurrence
from pipeline.physics.signals.overload import overload
from pipeline.physics.signals.spectra import HEARING, level
from pipeline.physics.signals.squeal_detector import Detector, Loudest
from pipeline.products import Excerpt, NoiseEvents, OccurrenceMap, Recording, Spectrogram
from pipeline.products.recording import CONDITIONS
from pipeline.products.sound import OWN_TONES
from pipeline.recordings.samples import with_gaps
from pipeline.views.pages.sound_file import sound_files


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
    modes: dict[str, Quantity("Hz", gt=0)] = option({}, "natural frequencies by name, to compare the events with")
    modes_file: InputFile | None = option(None, "modes of another run to compare the events with: its complex_modes.h5,"
                                          " matrix_modes.h5 or modal_test.h5")
    bins: int = option(10, "most bins of a condition in the maps of squeal over two of them", ge=2, le=40)
    near: float = option(0.03, "largest distance of an event from a mode near it, as a share", gt=0, lt=0.3)


#: acceleration of 0 dB [m/s^2] (ISO 1683)
_STILL = 1e-6
#: what is heard before and after an event [s]
_BEFORE = 0.2
#: distance of the instants that are counted in the maps over conditions [s], and where their bins begin
_INSTANT, _ORIGIN = 0.05, {"temperature": 273.15}
#: samples of a condition are averaged to this rate [Hz], so many of them at once
_SLOW, _AT_ONCE = 200.0, 1 << 20
#: most frames and lines of a spectrogram that is kept for the page
_KEPT = 600, 320
_FIELDS = ("kind", "frequency", "lowest", "highest", "level", "start", "duration", "fundamental", "order")


def companions(product, case=None):
    """The table of events, and the loudest squeal to listen to."""
    return {"noise_events.csv": _table(product)} | sound_files(product)


def _table(product):
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(("run", "channel", "kind", "frequency / Hz", "lowest / Hz", "highest / Hz", "level / dB",
                     "start / s", "duration / s", "order",
                     *(f"{name} / {CONDITIONS[name][1]}" for name in product.condition),
                     *(("level is a lower bound",) if product.record_overload.any() else ()),
                     *(("mode", "mode / Hz") if len(product.mode_name) else ())))
    for k, record in enumerate(product.event_record):
        writer.writerow((product.record_run[record], product.record_channel[record], product.event_kind[k],
                         *(f"{getattr(product, f'event_{name}')[k]:.6g}" for name in _FIELDS[1:7]),
                         product.event_order[k], *(f"{value:.6g}" if known else "" for value, known in zip(
                             product.event_condition[k], product.event_condition_known[k], strict=True)),
                         *((("yes" if product.record_overload[record] else "no"),)
                           if product.record_overload.any() else ()),
                         *((product.mode_name[mode], f"{product.mode_frequency[mode]:.6g}")
                           if (mode := product.event_mode[k]) >= 0 else ())))
    return stream.getvalue()


def _check(sections):
    """Refuse a file without modes, and a band that ends before it begins."""
    settings = sections["noise_events"]
    named_modes(settings.modes, settings.modes_file, "noise_events.modes_file")
    if settings.lowest_frequency >= settings.highest_frequency:
        raise ConfigError("noise_events.lowest_frequency", f"less than highest_frequency,"
                          f" {settings.highest_frequency:g} Hz", f"{settings.lowest_frequency:g} Hz")


@stage(companions=companions, check=_check)
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
    Where modes are given, an event is near one if their frequencies differ by at most {near}. Maps tell the share of
    the recorded time with squeal in bins of two conditions, over all runs that know both. Levels of a record whose
    samples are held at the end of its range are lower bounds; multiples of its tones that this makes are told as
    clipping.
    """
    modes = named_modes(settings.modes, settings.modes_file, "noise_events.modes_file")
    tasks = [(name, key, channel, kind) for name, run in recording.runs.items()
             for key, channel in run.channels.items() for kind in [_kind(key, channel, settings)] if kind]
    strange = set(settings.channels) - {key for run in recording.runs.values() for key in run.channels}
    if strange:
        raise ConfigError("noise_events.channels", "channels of the recording", ", ".join(sorted(strange)))
    found = context.map(partial(_searched, settings=settings), tasks, "noise events")
    remarks = [f"{name}, {key}: not searched: {result}" for (name, key, *_), result in zip(tasks, found, strict=True)
               if isinstance(result, str)]
    for remark in remarks:
        context.remark(remark)
    kept = [(task, result) for task, result in zip(tasks, found, strict=True) if not isinstance(result, str)]
    return replace(_product(kept, recording, modes, settings), remarks=remarks)


def _kind(name, channel, settings):
    """'sound', 'vibration', or '' of a channel that is not searched."""
    unit, asked = str(channel.unit), name in settings.channels
    if settings.channels and not asked:
        return ""
    if asked and unit not in ("Pa", "m/s^2"):
        raise ConfigError("noise_events.channels", "channels of sound pressure or acceleration", f"{name} in {unit}")
    if str(channel.measures) == "sound_pressure" or (unit == "Pa" and (asked or channel.heard())):
        return "sound"
    return "vibration" if unit == "m/s^2" else ""


def _searched(task, settings):
    """(events, level and frequency of the loudest tone, background level, Spectrogram, begin, Overload or None) of a
    channel, or why not."""
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
    cut = overload(lambda: blocks(channel.samples))
    if len(samples) >= 3 * settings.low_window * rate:
        slow = _low_detector(settings, kind, rate)
        events += tonal(frames(samples, rate, slow, np.float32), slow, settings.wander, low=True)
    return (clipped(events, cut, rate, 1.0 / settings.window), loudest.result(), noise.background(),
            picture.result(begin), begin, cut)


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


def _product(kept, recording, modes, settings):
    rows = [(k, event) for k, (_, (events, *_)) in enumerate(kept) for event in events]
    begins = [result[4] for _, result in kept]
    conditions = {name: _conditions(recording.runs[name]) for (name, *_), _ in kept}
    told = [[conditions[kept[k][0][0]].mean(name, begins[k] + event.start, event.duration) for name in CONDITIONS]
            for k, event in rows]
    known = np.array([[int(value is not None) for value in row] for row in told], int).reshape(-1, len(CONDITIONS))
    values = np.array([[value or 0.0 for value in row] for row in told], float).reshape(known.shape)
    columns = {name: [getattr(event, name) for _, event in rows] for name in _FIELDS}
    columns["start"] = [begins[k] + event.start for k, event in rows]
    near = [modes.nearest([event.frequency], settings.near)[0] if event.kind in OWN_TONES else -1 for _, event in rows]
    octaves = [event.frequency * np.array([2.0**-0.5, 2.0**0.5]) for _, event in rows]
    chance = [[modes.covered(octave, settings.near, unstable) for unstable in (False, True)] for octave in octaves]
    return NoiseEvents(
        threshold=settings.threshold, band=[settings.lowest_frequency, settings.highest_frequency],
        record_run=[name for (name, *_), _ in kept], record_channel=[key for (_, key, *_), _ in kept],
        record_kind=[kind for (*_, kind), _ in kept], condition=list(CONDITIONS),
        record_duration=[len(channel.samples) / float(channel.rate) for (_, _, channel, _), _ in kept],
        record_peak=[result[1][0] for _, result in kept], record_peak_frequency=[result[1][1] for _, result in kept],
        record_background=[result[2] for _, result in kept],
        record_overload=[result[5].share if result[5] else 0.0 for _, result in kept],
        record_range=[result[5].limit if result[5] else 0.0 for _, result in kept],
        maps=_maps(kept, conditions, settings.bins), listen=_listen(kept),
        spectrogram={f"{name}.{key}": result[3] for (name, key, *_), result in kept},
        event_record=[k for k, _ in rows], event_condition=values, event_condition_known=known,
        event_mode=near, mode_name=list(modes.name), mode_frequency=modes.frequency, mode_unstable=modes.unstable,
        near=settings.near, event_chance=np.reshape(chance, (-1, 2)),
        **{f"event_{name}": column for name, column in columns.items()})


def _listen(kept):
    """{'squeal': Excerpt} of the loudest squeal, of a microphone if any heard one; {} without squeal."""
    squeal = [(kind == "sound", event.level, event, name, key, channel, begin)
              for (name, key, channel, kind), (events, _, _, _, begin, _) in kept
              for event in events if event.kind == "squeal"]
    if not squeal:
        return {}
    *_, event, name, key, channel, begin = max(squeal, key=lambda row: row[:2])
    rate = float(channel.rate)
    first, last = (max(int((t - _BEFORE * sign) * rate), 0) for t, sign in (
        (event.start, 1), (event.start + min(event.duration, LONGEST - 2 * _BEFORE), -1)))
    sound = excerpt(Slices(channel.samples)[first:last], rate)
    return {"squeal": Excerpt(samples=sound.samples, rate=RATE, full_scale=sound.full_scale, unit=str(channel.unit),
                              content=f"run {name}, {key}", begin=begin + first / rate)}


def _conditions(run):
    """Conditions of a Run: by its channels, else as it states them."""
    measured = {name: [(*_averaged(c), float(c.begin)) for c in run.telling(name).values()] for name in CONDITIONS}
    return Conditions(measured, {name: (run.conditions[name].time, run.conditions[name].value)
                                 for name, (_, unit) in CONDITIONS.items()
                                 if name in run.conditions and str(run.conditions[name].unit) == unit})


def _averaged(channel):
    """(means of a Channel over equal stretches, NaN where all is missing, their rate in Hz)."""
    each = max(int(float(channel.rate) / _SLOW), 1)
    step = max(_AT_ONCE // each, 1) * each
    means = [_means(with_gaps(channel, slice(first, first + step)), each)
             for first in range(0, len(channel.samples), step)]
    return np.concatenate(means), float(channel.rate) / each


def _means(samples, each):
    """Means over ``each`` samples, the last over what is left of them."""
    begins = np.arange(0, len(samples), each)
    known = np.add.reduceat(np.isfinite(samples).astype(float), begins)
    total = np.add.reduceat(np.nan_to_num(samples), begins)
    return np.where(known > 0, total / np.maximum(known, 1.0), np.nan)


def _maps(kept, conditions, bins):
    """{first.second: OccurrenceMap} of the pairs of conditions that are known together."""
    courses = {name: _course(name, kept, of) for name, of in conditions.items()}
    maps = {}
    for first, second in combinations(CONDITIONS, 2):
        both = [(course[first], course[second], course["level"]) for course in courses.values()
                if np.isfinite(course[first] + course[second]).any()]
        if not both:
            continue
        edges = [even_edges(np.concatenate([run[k][np.isfinite(run[k])] for run in both]), bins, _ORIGIN.get(name, 0.0))
                 for k, name in enumerate((first, second))]
        parts = [occurrence(*run, _INSTANT, edges) for run in both]
        whole = sum(parts[1:], parts[0])
        maps[f"{first}.{second}"] = OccurrenceMap(
            condition=[first, second], first_edge=edges[0], second_edge=edges[1], time=whole.time,
            squealing=whole.sounding, level=whole.level, runs=np.sum([part.time > 0 for part in parts], axis=0),
            squealing_runs=np.sum([part.sounding > 0 for part in parts], axis=0))
    return maps


def _course(run, kept, conditions):
    """Conditions and level of the squeal of a run, -inf where there is none, at instants over its records.

    Squeal is that of microphones, or of accelerometers where no run has a microphone.
    """
    sound = any(kind == "sound" for (*_, kind), _ in kept)
    records = [(channel, events, begin) for (name, _, channel, kind), (events, _, _, _, begin, _) in kept
               if name == run and (kind == "sound" or not sound)]
    ends = [begin + len(channel.samples) / float(channel.rate) for channel, _, begin in records]
    first = min((begin for *_, begin in records), default=0.0)
    time = first + _INSTANT * (np.arange(int((max(ends, default=0.0) - first) / _INSTANT)) + 0.5)
    course = {name: conditions.at(name, time) for name in CONDITIONS} | {"level": np.full(len(time), -np.inf)}
    for _, events, begin in records:
        for event in events:
            if event.kind == "squeal":
                inside = (time >= begin + event.start) & (time <= begin + event.start + event.duration)
                course["level"][inside] = np.maximum(course["level"][inside], event.level)
    return course

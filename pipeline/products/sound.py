"""Vibration at the sensors, and the squeal in it."""

import numpy as np

from pipeline.contract import Array, count, parts, product, quantity, text


@product(version=1)
class Response:
    """Vibration of the elastic brake at the sensors, excited by the contact forces."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    time: Array = quantity("s", "time", "time after the static start")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors", np.float32)
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    velocity_spectrum: Array = quantity("m^2/s^2/Hz", "operating sensor frequency", "one-sided power spectral density (Welch)")
    mode_operating: Array = count("mode", "operating point of the superposed mode")
    mode_frequency: Array = quantity("Hz", "mode", "its natural frequency")
    mode_damping: Array = quantity("1", "mode", "its damping ratio, 0 for a rigid motion")
    coupling: Array = text("", "how forces enter: disc, released (open contacts) or assembly (closed contacts)")


@product(version=1)
class Excerpt:
    """A sound to listen to, mono."""

    samples: Array = quantity("1", "sample", "16-bit samples, 32767 is full scale", np.int16)
    rate: Array = quantity("Hz", "", "sampling rate")
    full_scale: Array = quantity("1", "", "what a sample at full scale stands for, in the unit that `unit` names")
    unit: Array = text("", "coherent SI unit of the signal")
    content: Array = text("", "what it is")
    begin: Array = quantity("s", "", "begin in the time of the signal; 0 of held tones")


@product(version=4)
class Squeal:
    """Squeal events at the sensors, and levels per band."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    sensor_name: Array = text("sensor", "sensor names")
    coupling: Array = text("", "how forces entered the response: disc, released (open contacts) or assembly (closed contacts)")
    reference: Array = quantity("m/s", "", "reference velocity of the level")
    threshold: Array = quantity("1", "", "level above which a peak is a squeal event, dB")
    peak_level: Array = quantity("1", "operating sensor", "highest level in the squeal band, dB")
    peak_frequency: Array = quantity("Hz", "operating sensor", "its frequency")
    band: Array = quantity("Hz", "band", "centre of the third-octave bands")
    band_level: Array = quantity("1", "operating sensor band", "velocity level per band, dB")
    event_operating: Array = count("event", "operating point of the event")
    event_sensor: Array = count("event", "sensor of the event")
    event_frequency: Array = quantity("Hz", "event", "frequency")
    event_level: Array = quantity("1", "event", "largest level, dB")
    event_start: Array = quantity("s", "event", "start")
    event_duration: Array = quantity("s", "event", "duration")
    event_fundamental: Array = quantity("Hz", "event", "fundamental of which the event is an integer multiple; its own frequency if there is none")
    event_order: Array = count("event", "order: 1 = fundamental, 2 and more = harmonic")
    listen: dict[str, Excerpt] = parts("squeal: velocity where it is loudest, to listen to; nothing where it does not squeal", empty=True)


@product(version=1)
class Spectrogram:
    """Largest levels over time and frequency of one channel."""

    time: Array = quantity("s", "time", "middle of each block of frames")
    frequency: Array = quantity("Hz", "frequency", "middle of each block of lines")
    level: Array = quantity("1", "time frequency", "largest level in it, dB; of sound A-weighted", np.float32)


@product(version=1)
class OccurrenceMap:
    """Squeal over two conditions, in bins, over all runs in which both are known."""

    condition: Array = text("axis", "the two conditions")
    first_edge: Array = quantity("1", "first_edge", "ends of the bins of the first condition, SI")
    second_edge: Array = quantity("1", "second_edge", "ends of the bins of the second condition, SI")
    time: Array = quantity("s", "first second", "recorded time in the bin")
    squealing: Array = quantity("s", "first second", "part of it with squeal")
    runs: Array = count("first second", "runs that were in the bin")
    squealing_runs: Array = count("first second", "runs that squealed there")
    level: Array = quantity("1", "first second", "largest level of the events there, dB(A); dB re 1e-6 m/s^2 if no run has a microphone; 0 where none")


#: kinds of NoiseEvents that have a tone of their own, which may be that of a mode
OWN_TONES = ("squeal", "moan", "groan", "judder")


@product(version=6)
class NoiseEvents:
    """Squeal and other noise events in recordings. A record is a channel of a run."""

    threshold: Array = quantity("1", "", "level that is squeal, dB(A) re 20 uPa")
    band: Array = quantity("Hz", "end", "ends of the squeal band")
    record_run: Array = text("record", "run")
    record_channel: Array = text("record", "channel")
    record_kind: Array = text("record", "sound, or vibration")
    record_duration: Array = quantity("s", "record", "length")
    record_peak: Array = quantity("1", "record", "level of the loudest tone in the band, dB(A) re 20 uPa; of vibration dB re 1e-6 m/s^2")
    record_peak_frequency: Array = quantity("Hz", "record", "its frequency")
    record_background: Array = quantity("1", "record", "median level of the band, in the same way")
    record_overload: Array = quantity("1", "record", "share of the samples at the end of the range of the instrument, 0 of none; with any, levels are lower bounds")
    record_range: Array = quantity("1", "record", "that end, Pa or m/s^2; 0 where it is not reached")
    condition: Array = text("condition", "conditions of events: pressure (Pa), speed (rad/s), temperature (K)")
    event_record: Array = count("event", "record of the event")
    event_kind: Array = text("event", "squeal, harmonic, clipping (harmonic of an overloaded tone), sweep, series, broadband; below the band judder, groan, moan or series")
    event_frequency: Array = quantity("Hz", "event", "mean frequency by power")
    event_lowest: Array = quantity("Hz", "event", "lowest frequency of its course")
    event_highest: Array = quantity("Hz", "event", "highest frequency of its course")
    event_level: Array = quantity("1", "event", "largest level, dB as of the record; below the band not weighted")
    event_start: Array = quantity("s", "event", "begin, in the time of the record")
    event_duration: Array = quantity("s", "event", "duration")
    event_fundamental: Array = quantity("Hz", "event", "tone of which it is a multiple; its own frequency if of none")
    event_order: Array = count("event", "the multiple; 1: a tone of its own")
    event_condition: Array = quantity("1", "event condition", "mean of each condition over the event, SI; 0 where not known")
    event_condition_known: Array = count("event condition", "1 where it is known")
    event_mode: Array = count("event", "named mode nearest in frequency, -1 where none lies within `near`, or of a harmonic, sweep, series or broadband noise")
    mode_name: Array = text("mode", "modes that the events are compared with")
    mode_frequency: Array = quantity("Hz", "mode", "their natural frequencies, rising")
    mode_unstable: Array = count("mode", "1 where it is predicted to be unstable, 0 where it is predicted not to be, -1 where nothing is predicted")
    near: Array = quantity("1", "", "largest distance of an event from a mode near it, as a share of its frequency")
    event_chance: Array = quantity("1", "event chance", "share of the octave about the event, on a logarithmic axis, that lies as near to a mode, and to an unstable one")
    listen: dict[str, Excerpt] = parts("squeal: the loudest, to listen to; nothing where there is none", empty=True)
    maps: dict[str, OccurrenceMap] = parts("squeal over two conditions, named first.second", empty=True)
    spectrogram: dict[str, Spectrogram] = parts("of each record, named run.channel", empty=True)
    remarks: Array = text("remark", "channels that were not searched, and why", empty=True)


@product(version=2)
class OrderSpectra:
    """Vibration over the revolutions of a shaft: one channel of a run during which the speed varies."""

    run: Array = text("", "run")
    channel: Array = text("", "channel")
    shaft: Array = text("", "channel that tells the speed")
    remark: Array = text("", "what was assumed of the pulses of a tacho; empty for nothing")
    unit: Array = text("", "coherent SI unit of the amplitudes")
    time: Array = quantity("s", "time", "middle of each block of revolutions, in the time of the record")
    speed: Array = quantity("rad/s", "time", "mean speed in it")
    order: Array = quantity("1", "order", "order axis: 1 is once per revolution")
    amplitude: Array = quantity("1", "time order", "amplitude of a sine of that order", np.float32)
    edge: Array = quantity("rad/s", "edge", "ends of the bins of speed")
    outstanding: Array = quantity("1", "outstanding", "orders that stand out and follow the speed, strongest first")
    sure: Array = count("outstanding", "0 where the speed varies too little to tell it from a tone of constant frequency")
    level: Array = quantity("1", "outstanding bin", "their amplitude over speed, root mean square over blocks; 0 where there are none")
    blocks: Array = count("bin", "blocks in each bin of speed")
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the Campbell diagram")
    campbell: Array = quantity("1", "bin frequency", "amplitude over speed and frequency, root mean square over frames; 0 where there are none", np.float32)
    frames: Array = count("bin", "frames in each bin of speed")


@product(version=3)
class Orders:
    """Orders of the recordings of a bench. Empty where no channel tells a speed that varies."""

    spectra: dict[str, OrderSpectra] = parts("of each channel, named run.channel", empty=True)
    remarks: Array = text("remark", "what has no orders, and why; what is overloaded", empty=True)

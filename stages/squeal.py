"""Stage squeal: squeal events and band levels of the response."""

from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.physics.signals.frames import frames
from pipeline.physics.signals.listening import LONGEST, RATE, audible, excerpt, held
from pipeline.physics.signals.spectra import band_power, level, third_octave_bands
from pipeline.physics.signals.squeal_detector import Detector, detect, loudest
from pipeline.products import Excerpt, Response, Squeal, Transient
from pipeline.views.pages.sound_file import sound_files


class Settings(Section):
    """What counts as squeal."""

    lowest_frequency: Quantity("Hz", gt=0) = option("1.25 kHz", "begin of the squeal band (SAE J2521)")
    highest_frequency: Quantity("Hz", gt=0) = option(
        "20 kHz", "end of the squeal band (SAE J2521: 16 kHz; the paper squeals at 16.6 and 17.8 kHz)")
    reference: Quantity("m/s", gt=0) = option("1 nm/s", "reference velocity of all levels (ISO 1683)")
    threshold: Quantity("m/s", gt=0) = option(
        "0.7 mm/s", "root mean square velocity of a tone that is squeal; about 70 dB sound pressure half a metre away")
    window: Quantity("s", gt=0) = option("10 ms", "length of a frame; its inverse is the distance of the lines")
    overlap: float = option(0.75, "share of a frame that the next one repeats", ge=0.5, le=0.8)
    prominence: float = option(10.0, "height of a tone above the spectrum beside it, dB", gt=0)
    dynamic_range: float = option(30.0, "a tone this far below the strongest is a side lobe of the window, dB", gt=0)
    drift: Quantity("Hz", gt=0) = option("100 Hz", "largest change of the frequency of an event from frame to frame")
    gap: Quantity("s", ge=0) = option("10 ms", "longest interruption of an event")
    shortest: Quantity("s", ge=0) = option("30 ms", "shortest event")
    settling: Quantity("s", ge=0) = option("50 ms", "begin of the signals that is not searched")
    lowest_fundamental: Quantity("Hz", gt=0) = option(
        "400 Hz", "tones from here to the squeal band are no events, but events may be harmonics of them")
    line_accuracy: float = option(
        0.05, "largest error of a frequency, as a share of the distance of the lines; a harmonic must be met to it",
        gt=0, le=0.5)
    largest_chance: float = option(
        0.1, "largest share of unrelated tones that may pass as harmonics of one fundamental", gt=0, lt=1)
    told_share: float = option(
        0.33, "share of the frames of an event that must be told as the same harmonic", ge=0.1, lt=1)


#: shortest motion that is listened to as it is [s]; of shorter ones the tones are held
_HEARD = 1.0


@stage(companions=sound_files)
def squeal(response: Response | Transient, settings: Settings, context: Context) -> Squeal:
    """Detect squeal events and compute band levels of the sensor velocities.

    The level is a velocity level: no radiation, no A-weighting.

    Method:
    A squeal event is a tone between {lowest_frequency} and {highest_frequency} of at least {threshold} root mean square
    (levels re {reference}) for at least {shortest}, in Hann frames of {window} with an overlap of {overlap}; tones that
    drift by less than {drift} between frames form one event. An event is a harmonic if in more than {told_share} of its
    frames it is an integer multiple of a lower tone, itself at or above {lowest_fundamental} and {threshold}, with
    frequencies accurate to {line_accuracy} of the line spacing, and if at most {largest_chance} of unrelated tones
    would satisfy this by chance. Third-octave levels are sums of the velocity spectra. What there is to listen to is
    the velocity of the sensor that squeals loudest, or its tones held at their levels where the motion is short.
    """
    if settings.lowest_frequency >= settings.highest_frequency:
        raise ConfigError("squeal.lowest_frequency", f"less than highest_frequency, {settings.highest_frequency:g} Hz",
                          f"{settings.lowest_frequency:g} Hz")
    if settings.lowest_fundamental > settings.lowest_frequency:
        raise ConfigError("squeal.lowest_fundamental", f"at most lowest_frequency, {settings.lowest_frequency:g} Hz",
                          f"{settings.lowest_fundamental:g} Hz")
    detector = _detector(settings)
    searched = response.time >= settings.settling
    if not searched.any():
        raise ConfigError("squeal.settling", f"less than the simulated {response.time[-1]:.3g} s",
                          f"{settings.settling:.3g} s")
    rate = (len(response.time) - 1) / (response.time[-1] - response.time[0])
    search = partial(_search, rate=rate, detector=detector)
    results = context.map(search, [velocity[:, searched] for velocity in response.velocity], "squeal detection")
    middle = third_octave_bands(settings.lowest_frequency, settings.highest_frequency)
    power = band_power(response.frequency, response.velocity_spectrum, middle)
    events = _events(results, response.time[searched][0])
    peaks = np.array([[peak for peak, _ in sensors] for sensors in results])
    return Squeal(
        pressure=response.pressure, speed=response.speed, sensor_name=response.sensor_name,
        coupling=getattr(response, "coupling", "transient"),
        reference=settings.reference, threshold=detector.threshold,
        peak_level=peaks[..., 0], peak_frequency=peaks[..., 1],
        band=middle, band_level=level(power, settings.reference), **events,
        listen=_listen(response, events, rate, settings))


def _listen(response, events, rate, settings):
    """{'squeal': Excerpt} of the sensor with the loudest event; {} without any that can be heard."""
    heard = np.flatnonzero(audible(events["event_frequency"]))
    if not len(heard):
        return {}
    loudest = heard[events["event_level"][heard].argmax()]
    operating, sensor = (int(events[f"event_{name}"][loudest]) for name in ("operating", "sensor"))
    name = str(response.sensor_name[sensor])
    begin = max(float(events["event_start"][loudest]), float(response.time[0]))
    rest = response.time >= begin
    if response.time[-1] - begin >= _HEARD:
        sound = excerpt(response.velocity[operating, sensor, rest], rate)
        content = f"velocity at sensor {name} from {begin:.3g} s on, for up to {LONGEST:g} s"
    else:
        there = heard[(events["event_operating"][heard] == operating) & (events["event_sensor"][heard] == sensor)]
        sound = held(events["event_frequency"][there],
                     settings.reference * 10.0 ** (events["event_level"][there] / 20.0))
        content, begin = f"tones of the velocity at sensor {name}, held for 2 s", 0.0
    return {"squeal": Excerpt(samples=sound.samples, rate=RATE, full_scale=sound.full_scale, unit="m/s",
                              content=content, begin=begin)}


def _detector(settings):
    return Detector((settings.lowest_frequency, settings.highest_frequency),
                    float(level(settings.threshold**2, settings.reference)), settings.reference, settings.window,
                    settings.overlap, settings.prominence, settings.dynamic_range, settings.drift, settings.gap,
                    settings.shortest, settings.lowest_fundamental, settings.line_accuracy, settings.largest_chance,
                    settings.told_share)


def _search(velocity, rate, detector):
    """For each sensor of one operating point: (level, frequency) of the loudest tone, and the events."""
    every = [frames(signal.astype(float), rate, detector) for signal in velocity]
    return [(loudest(spectrum, detector), detect(spectrum, detector)) for spectrum in every]


def _events(results, begin):
    """The event table; times count from the static start."""
    rows = [(operating, sensor, event.frequency, event.level, begin + event.start, event.duration, event.fundamental,
             event.order)
            for operating, sensors in enumerate(results) for sensor, (_, events) in enumerate(sensors)
            for event in events]
    names = ("operating", "sensor", "frequency", "level", "start", "duration", "fundamental", "order")
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return {f"event_{name}": np.array(column) for name, column in zip(names, columns, strict=True)}
